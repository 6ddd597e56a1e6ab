#include "structure/order/height_pairs.hpp"

#include <algorithm>
#include <cmath>

namespace jostle::inline structure {

namespace {

constexpr double height_step = 0.04;
constexpr long kernel_steps = 25;  // steps per half-width of the kernel
static_assert(kernel_steps * height_step == HeightPairs::reach_beyond);

std::vector<double> triangular() {
  std::vector<double> kernel;
  for (long k = -kernel_steps; k <= kernel_steps; ++k) {
    kernel.push_back(static_cast<double>(kernel_steps - std::abs(k)) /
                     static_cast<double>(kernel_steps * kernel_steps));
  }
  return kernel;
}

/// Spreads every bin over the kernel, reflected at the ends.
std::vector<double> spread_over_kernel(const std::vector<double>& bins,
                                       const std::vector<double>& kernel) {
  const auto n = static_cast<long>(bins.size());
  std::vector<double> expected(bins.size(), 0.0);
  for (long i = 0; i < n; ++i) {
    const double value = bins[static_cast<std::size_t>(i)];
    if (value == 0) continue;
    for (long k = -kernel_steps; k <= kernel_steps; ++k) {
      long partner_bin = i + k;
      if (partner_bin < 0) partner_bin = -1 - partner_bin;
      if (partner_bin >= n) partner_bin = 2 * n - 1 - partner_bin;
      expected[static_cast<std::size_t>(partner_bin)] +=
          value * kernel[static_cast<std::size_t>(k + kernel_steps)];
    }
  }
  return expected;
}

std::vector<double> twiced(const std::vector<double>& bins, const std::vector<double>& kernel) {
  std::vector<double> once = spread_over_kernel(bins, kernel);
  const std::vector<double> twice = spread_over_kernel(once, kernel);
  for (std::size_t i = 0; i < once.size(); ++i) once[i] = 2 * once[i] - twice[i];
  return once;
}

std::vector<double> spread_of_one(long bin, long n_bins) {
  std::vector<double> density(static_cast<std::size_t>(n_bins), 0.0);
  density[static_cast<std::size_t>(bin)] = 1;
  return twiced(density, triangular());
}

}  // namespace

HeightPairs::HeightPairs(const std::vector<double>& centres, const std::vector<double>& partners,
                         HeightWindow accessible, double reach)
    : reach_(std::ceil(reach / height_step) * height_step + height_step) {
  const double low = accessible.low - reach_beyond;
  const auto n_bins =
      static_cast<long>(std::ceil((accessible.high + reach_beyond - low) / height_step)) + 1;
  const auto bin = [&](double z) {
    return std::clamp(std::lround((z - low) / height_step), 0L, n_bins - 1);
  };
  const auto counted = [&](const std::vector<double>& heights) {
    std::vector<double> bins(static_cast<std::size_t>(n_bins), 0.0);
    for (const double z : heights) bins[static_cast<std::size_t>(bin(z))] += 1;
    return bins;
  };
  const std::vector<double> central = counted(centres);
  const std::vector<double> partner = twiced(counted(partners), triangular());
  const long n_up = std::lround(reach_ / height_step);
  density_.assign(static_cast<std::size_t>(2 * n_up + 1), 0.0);
  share_ = density_;
  const std::vector<double> inner = spread_of_one(2 * kernel_steps, 4 * kernel_steps + 1);
  for (long i = 0; i < n_bins; ++i) {
    const double n = central[static_cast<std::size_t>(i)];
    if (n == 0) continue;
    // A sphere of this bin does not count what it spreads itself.
    const long first = std::max(0L, i - 2 * kernel_steps);
    const long last = std::min(n_bins - 1, i + 2 * kernel_steps);
    std::vector<double> near_end;
    if (last - first < 4 * kernel_steps) near_end = spread_of_one(i - first, last - first + 1);
    const std::vector<double>& self = near_end.empty() ? inner : near_end;
    for (long shift = std::max(-n_up, -i); shift <= std::min(n_up, n_bins - 1 - i); ++shift) {
      const long partner_bin = i + shift;
      double n_partners = partner[static_cast<std::size_t>(partner_bin)];
      if (partner_bin >= first && partner_bin <= last)
        n_partners -= self[static_cast<std::size_t>(partner_bin - first)];
      const auto index = static_cast<std::size_t>(shift + n_up);
      density_[index] += n * n_partners / height_step;
      share_[index] += n / static_cast<double>(centres.size());
    }
  }
}

double HeightPairs::interpolated(const std::vector<double>& values, double difference) const {
  const double place = std::clamp((difference + reach_) / height_step, 0.0,
                                  static_cast<double>(values.size()) - 1.001);
  const auto k = static_cast<std::size_t>(place);
  const double part = place - static_cast<double>(k);
  return (1 - part) * values[k] + part * values[k + 1];
}

}  // namespace jostle::inline structure
