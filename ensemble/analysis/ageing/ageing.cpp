#include "ensemble/analysis/ageing/ageing.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "engine/numbers.hpp"
#include "ensemble/moments.hpp"
#include "ensemble/statistics/jackknife.hpp"

namespace jostle::inline ensemble {

namespace {

// The realizations that reached both taps: X(t_W) and X(t_W + t), as differences from the first's
// X(t_W), which keep the digits of small fluctuations.
struct Pairs {
  std::vector<double> early, late;
};

Pairs pairs(std::span<const double> early, std::span<const double> late) {
  Pairs found;
  double origin = not_a_number;
  for (std::size_t r = 0; r < std::min(early.size(), late.size()); ++r) {
    if (std::isnan(early[r]) || std::isnan(late[r])) continue;
    if (std::isnan(origin)) origin = early[r];
    found.early.push_back(early[r] - origin);
    found.late.push_back(late[r] - origin);
  }
  return found;
}

LogEstimate mean_square(const Pairs& xy) {
  const std::size_t n = xy.early.size();
  if (n == 0) return no_estimate();
  std::vector<double> squares;
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) {
    squares.push_back(std::pow(xy.late[i] - xy.early[i], 2));
    sum += squares.back();
  }
  const ErrorOf error = {jackknife_error(ln_means_without_one(squares)),
                         static_cast<double>(n - 1)};
  return log_estimate(sum / static_cast<double>(n), error);
}

void add_change(const Pairs& xy, AgeingCurves& curves) {
  Moments changes;
  std::vector<double> values;
  for (std::size_t i = 0; i < xy.early.size(); ++i) {
    values.push_back(xy.late[i] - xy.early[i]);
    changes.add(values.back());
  }
  curves.change.push_back(changes.mean());
  curves.change_error.push_back(changes.standard_error());
  curves.v.push_back(log_estimate(
      variance(values),
      {jackknife_error(ln_variances_without_one(values)), static_cast<double>(values.size()) - 1}));
}

struct CovarianceRatio {
  double value = not_a_number, error = not_a_number;
};

// Leaving realization i out of n lowers a sum of products of deviations from the mean, S, to
// S - n/(n - 1) dx_i dy_i.
CovarianceRatio covariance_ratio(const Pairs& xy) {
  const std::size_t n = xy.early.size();
  if (n < 2) return {};
  Moments early, late;
  for (const double x : xy.early) early.add(x);
  for (const double y : xy.late) late.add(y);
  const double x_mean = early.mean(), y_mean = late.mean();
  double products = 0, squares = 0;
  for (std::size_t i = 0; i < n; ++i) {
    products += (xy.early[i] - x_mean) * (xy.late[i] - y_mean);
    squares += (xy.early[i] - x_mean) * (xy.early[i] - x_mean);
  }
  if (squares == 0) return {};
  const double factor = static_cast<double>(n) / static_cast<double>(n - 1);
  std::vector<double> left_out;
  for (std::size_t i = 0; i < n; ++i) {
    const double dx = xy.early[i] - x_mean, dy = xy.late[i] - y_mean;
    const double rest = squares - factor * dx * dx;
    // The one that alone differed is gone, but for rounding.
    const bool defined = n > 2 && rest > 1e-13 * squares;
    left_out.push_back(defined ? (products - factor * dx * dy) / rest : not_a_number);
  }
  return {products / squares, jackknife_error(left_out)};
}

}  // namespace

AgeingGrid ageing_grid(std::uint64_t n_taps) {
  assert(n_taps >= 3);
  const std::uint64_t last = n_taps - 1;
  AgeingGrid grid{.waiting_times = {0}, .lags = logarithmic_taps(1, last, 10)};
  const std::uint64_t longest_wait = std::max<std::uint64_t>(1, last / 10);
  for (const std::uint64_t wait : logarithmic_taps(1, longest_wait, 2)) {
    grid.waiting_times.push_back(wait);
  }
  return grid;
}

std::vector<std::uint64_t> taps_of(const AgeingGrid& grid) {
  std::vector<std::uint64_t> taps = grid.waiting_times;
  for (const std::uint64_t wait : grid.waiting_times) {
    for (const std::uint64_t lag : grid.lags) taps.push_back(wait + lag);
  }
  std::ranges::sort(taps);
  taps.erase(std::unique(taps.begin(), taps.end()), taps.end());
  return taps;
}

AgeingCurves ageing_curves(const TapRows& rows, const AgeingGrid& grid) {
  AgeingCurves curves;
  curves.grid = grid;
  for (const std::uint64_t wait : grid.waiting_times) {
    for (const std::uint64_t lag : grid.lags) {
      const Pairs xy = pairs(rows.row(wait), rows.row(wait + lag));
      curves.a.push_back(mean_square(xy));
      add_change(xy, curves);
      const CovarianceRatio c = covariance_ratio(xy);
      curves.c.push_back(c.value);
      curves.c_error.push_back(c.error);
      curves.count.push_back(xy.early.size());
    }
  }
  return curves;
}

}  // namespace jostle::inline ensemble
