#include "structure/order/structure_factor.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

#include "engine/bed/boundary.hpp"
#include "engine/numbers.hpp"

namespace jostle::inline structure {

namespace {

using Complex = std::complex<double>;
constexpr double turn = 2 * std::numbers::pi;

/// A wave vector, in units of the least one along each side.
struct Mode {
  int x, y, z;
  double k;
};

/// The region cut out of the packing.
struct Cut {
  double widths[3];
  double low;
  bool tapered;

  /// The least k that the taper resolves.
  double least_k() const { return tapered ? turn / widths[2] * (1 - 1e-12) : 0; }
};

Cut cut_of(const Packing& packing, const Region& region) {
  const Boundary boundary(packing.container);
  if (boundary.has_walls()) {
    throw std::invalid_argument(
        "structure_factor: wave vectors fit periodic sides alone, and this container has walls");
  }
  if (boundary.periodic_z) return {{boundary.width_x, boundary.width_y, boundary.height}, 0, false};
  return {{boundary.width_x, boundary.width_y, region.high - region.low}, region.low, true};
}

/// One of every pair k, -k, bin by bin, at most `modes` of each, evenly spread.
std::vector<std::vector<Mode>> chosen_modes(const Cut& cut, const StructureFactorSettings& settings,
                                            std::size_t n_bins) {
  int most[3];
  double all = 1;
  for (int axis = 0; axis < 3; ++axis) {
    most[axis] = static_cast<int>(settings.k_max * cut.widths[axis] / turn);
    all *= 2 * most[axis] + 1;
  }
  constexpr double too_many = 1e8;
  if (all > too_many) {
    throw std::invalid_argument(
        "structure_factor: more than a hundred million wave vectors: take a smaller k_max");
  }
  std::vector<std::vector<Mode>> bins(n_bins);
  for (int x = 0; x <= most[0]; ++x) {
    for (int y = x > 0 ? -most[1] : 0; y <= most[1]; ++y) {
      const bool upright = x == 0 && y == 0;
      if (upright && cut.tapered) continue;
      for (int z = upright ? 1 : -most[2]; z <= most[2]; ++z) {
        const double k = turn * std::hypot(x / cut.widths[0], y / cut.widths[1], z / cut.widths[2]);
        const auto bin = static_cast<std::size_t>(k / settings.bin_width);
        if (bin < n_bins && k >= cut.least_k()) bins[bin].push_back({x, y, z, k});
      }
    }
  }
  for (std::vector<Mode>& bin : bins) {
    if (bin.size() <= settings.modes) continue;
    for (std::size_t i = 0; i < settings.modes; ++i) bin[i] = bin[i * bin.size() / settings.modes];
    bin.resize(settings.modes);
  }
  return bins;
}

/// exp(-i n phase), n = 0 .. most.
std::vector<Complex> powers(double phase, int most) {
  const Complex step = std::polar(1.0, -phase);
  std::vector<Complex> all{1};
  for (int n = 1; n <= most; ++n) all.push_back(all.back() * step);
  return all;
}

Complex power_at(const std::vector<Complex>& powers, int n) {
  return n >= 0 ? powers[static_cast<std::size_t>(n)]
                : std::conj(powers[static_cast<std::size_t>(-n)]);
}

/// Amplitudes of all modes, and the sum of squared weights.
double add_amplitudes(const Packing& packing, const Cut& cut, const std::vector<Mode>& modes,
                      std::vector<Complex>& amplitudes) {
  int most[3] = {0, 0, 0};
  for (const Mode& mode : modes) {
    most[0] = std::max(most[0], std::abs(mode.x));
    most[1] = std::max(most[1], std::abs(mode.y));
    most[2] = std::max(most[2], std::abs(mode.z));
  }
  double squares = 0;
  for (const Vec3& r : packing.centres) {
    const double height = (r.z - cut.low) / cut.widths[2];
    if (cut.tapered && (height <= 0 || height >= 1)) continue;
    const double sine = std::sin(std::numbers::pi * height);
    const double weight = cut.tapered ? sine * sine : 1;
    squares += weight * weight;
    const std::vector<Complex> x = powers(turn * r.x / cut.widths[0], most[0]);
    const std::vector<Complex> y = powers(turn * r.y / cut.widths[1], most[1]);
    const std::vector<Complex> z = powers(turn * height, most[2]);
    for (std::size_t m = 0; m < modes.size(); ++m) {
      const Mode& mode = modes[m];
      amplitudes[m] +=
          weight * x[static_cast<std::size_t>(mode.x)] * power_at(y, mode.y) * power_at(z, mode.z);
    }
  }
  return squares;
}

/// y at x = 0 of the straight line through points added one by one.
class LineToZero {
 public:
  void add(double x, double y) {
    n_ += 1;
    const double dx = x - x_, dy = y - y_;
    x_ += dx / n_;
    y_ += dy / n_;
    xx_ += dx * (x - x_);
    xy_ += dx * (y - y_);
    if (n_ == 1 || x > last_ + 1e-9) ++different_;
    last_ = n_ == 1 ? x : std::max(last_, x);
  }
  double value() const { return different_ < 3 ? not_a_number : y_ - xy_ / xx_ * x_; }

 private:
  double n_ = 0, x_ = 0, y_ = 0, xx_ = 0, xy_ = 0, last_ = 0;
  int different_ = 0;
};

}  // namespace

StructureFactor structure_factor(const Packing& packing, const StructureFactorSettings& settings,
                                 const Region& region) {
  const Cut cut = cut_of(packing, region);
  const auto n_bins = static_cast<std::size_t>(settings.k_max / settings.bin_width + 1e-9);
  const std::vector<std::vector<Mode>> bins = chosen_modes(cut, settings, n_bins);
  std::vector<Mode> modes;
  for (const auto& bin : bins) modes.insert(modes.end(), bin.begin(), bin.end());
  std::vector<Complex> amplitudes(modes.size());
  const double squares = add_amplitudes(packing, cut, modes, amplitudes);
  if (!(squares > 0)) throw std::invalid_argument("structure_factor: no sphere in the region");
  StructureFactor result;
  std::vector<std::pair<double, double>> small;
  std::size_t next = 0;
  for (std::size_t b = 0; b < n_bins; ++b) {
    double sum = 0;
    for (const Mode& mode : bins[b]) {
      const double s = std::norm(amplitudes[next++]) / squares;
      sum += s;
      if (mode.k <= settings.fit_to) small.emplace_back(mode.k, s);
    }
    result.k.push_back((static_cast<double>(b) + 0.5) * settings.bin_width);
    result.modes.push_back(bins[b].size());
    result.s.push_back(bins[b].empty() ? not_a_number : sum / static_cast<double>(bins[b].size()));
  }
  std::ranges::sort(small);
  LineToZero of_squares, of_line;
  for (const auto& [k, s] : small) {
    of_squares.add(k * k, s);
    of_line.add(k, s);
  }
  result.s_0_of_squares = of_squares.value();
  result.s_0_of_line = of_line.value();
  result.fitted_from = small.empty() ? not_a_number : small.front().first;
  result.fitted_modes = small.size();
  return result;
}

}  // namespace jostle::inline structure
