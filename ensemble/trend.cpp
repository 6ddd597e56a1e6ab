#include "ensemble/trend.hpp"

#include <cassert>
#include <cmath>

#include "ensemble/moments.hpp"
#include "fitting/distributions.hpp"

namespace jostle {

namespace {

// Sum of (i - center)^2.
double leverage(double n) {
  return n * (n * n - 1) / 12;
}

// Residuals of the block means about their line, taken for independent.
double error_from_blocks(std::span<const double> series, std::size_t n_blocks) {
  const std::size_t length = series.size() / n_blocks;
  std::vector<double> means;
  for (std::size_t b = 0; b < n_blocks; ++b) {
    Moments block;
    for (const double value : series.subspan(b * length, length)) block.add(value);
    means.push_back(block.mean());
  }
  const Line line = fit_line(means);
  double squares = 0;
  for (std::size_t b = 0; b < n_blocks; ++b) {
    const double fitted = line.slope * (static_cast<double>(b) - line.center);
    const double residual = means[b] - line.middle - fitted;
    squares += residual * residual;
  }
  const auto n = static_cast<double>(n_blocks);
  return std::sqrt(squares / (n - 2) / leverage(n)) / static_cast<double>(length);
}

}  // namespace

Line fit_line(std::span<const double> series) {
  const auto n = static_cast<double>(series.size());
  Moments moments;
  for (const double value : series) moments.add(value);
  Line line{.center = 0.5 * (n - 1), .middle = moments.mean()};
  for (std::size_t i = 0; i < series.size(); ++i) {
    line.slope += (static_cast<double>(i) - line.center) * (series[i] - line.middle);
  }
  line.slope = series.size() < 2 ? 0 : line.slope / leverage(n);
  return line;
}

void TrendTest::add(std::span<const double> series) {
  assert((n_ == 0 || series.size() == n_) && series.size() >= 2 * single_blocks);
  n_ = series.size();
  if (slopes_.empty()) block_error_ = error_from_blocks(series, single_blocks);
  slopes_.push_back(fit_line(series).slope);
  Moments moments;
  for (const double value : series) moments.add(value);
  variance_ += moments.sigma() * moments.sigma();
}

Trend TrendTest::result() const {
  const auto n = static_cast<double>(n_), realizations = static_cast<double>(slopes_.size());
  Moments slopes;
  for (const double slope : slopes_) slopes.add(slope);
  Trend trend;
  trend.slope = slopes.mean();
  const bool single = slopes_.size() == 1;
  trend.slope_error = single ? block_error_ : slopes.standard_error();
  trend.dof = single ? static_cast<double>(single_blocks) - 2 : realizations - 1;
  trend.change = trend.slope * n;
  const double variance = variance_ / realizations;
  if (trend.slope == 0 || variance == 0) return trend;
  trend.share = std::min(1.0, trend.slope * trend.slope * (n * n - 1) / 12 / variance);
  trend.tails =
      trend.slope_error > 0 ? student_tails(trend.slope / trend.slope_error, trend.dof) : 0;
  return trend;
}

}  // namespace jostle
