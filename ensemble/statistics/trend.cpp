#include "ensemble/statistics/trend.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>

#include "ensemble/moments.hpp"
#include "ensemble/statistics/finite_text.hpp"
#include "fitting/intervals/distributions.hpp"

namespace jostle::inline ensemble {

namespace {

constexpr double times_of_a_block = 5;  // autocorrelation times
constexpr double rounding = 1e-12;      // the rest of a change is no memory
constexpr std::size_t fewest_blocks_of_series = 4;
constexpr double enough_freedom = 20;  // degrees of freedom sufficient for an error within series
constexpr double doubted = 0.25;       // p of realizations that differ by more than they change

// Sum of (i - center)^2.
double leverage(double n) {
  return n * (n * n - 1) / 12;
}

// For block means about their line, [n_blocks] in `means`.
double squares_about_line(const std::vector<double>& means) {
  const Line line = fit_line(means);
  double squares = 0;
  for (std::size_t b = 0; b < means.size(); ++b) {
    const double residual =
        means[b] - line.middle - line.slope * (static_cast<double>(b) - line.center);
    squares += residual * residual;
  }
  return squares;
}

std::vector<double> block_means(std::span<const double> series, std::size_t length) {
  std::vector<double> means(series.size() / length);
  for (std::size_t b = 0; b < means.size(); ++b) {
    Moments block;
    for (const double value : series.subspan(b * length, length)) block.add(value);
    means[b] = block.mean();
  }
  return means;
}

/// A change against 0, by an error of one kind.
struct ChangeTest {
  const Change& change;
  const ErrorOf& error;
  const char* name;
  bool is_within;  // series, not over realizations

  /// NaN without a test: realizations that all change by the same are no measure of chance. A
  /// series that its line meets at every tap leaves nothing to chance.
  double p() const {
    const bool is_exact = is_within && error.known() && error.error == 0 && change.value != 0;
    return is_exact ? 0 : p_value(change.value, error);
  }
};

}  // namespace

void TrendTest::add(std::span<const double> series) {
  assert((n_ == 0 || series.size() == n_) && series.size() >= 32);
  if (n_ == 0) {
    n_ = series.size();
    // 1, 2, 3, 4, 6, 8, 12, ... taps
    for (std::size_t length = 1; fewest_blocks_of_series * length <= n_; length *= 2) {
      levels_.push_back({length, n_ / length, 0});
      const std::size_t n_between = length / 2 * 3;
      if (length >= 2 && fewest_blocks_of_series * n_between <= n_)
        levels_.push_back({n_between, n_ / n_between, 0});
    }
  }
  ++n_series_;
  Moments all, first, second;
  for (const double value : series) all.add(value);
  for (const double value : series.first(n_ / 2)) first.add(value);
  for (const double value : series.last(n_ / 2)) second.add(value);
  slopes_.add(fit_line(series).slope);
  halves_.add(second.mean() - first.mean());
  variance_ += all.sigma() * all.sigma();
  about_lines_.add(series);
  for (Level& level : levels_)
    level.squares += squares_about_line(block_means(series, level.length));
}

// For the mean slope, by the longest blocks that leave freedom enough: a slower part of the memory,
// which the autocorrelation time does not show, is seen by no shorter ones. Block means are
// independent but for about T / length of their variance, T the autocorrelation time, which their
// neighbours have. The last taps may fill no block: the variance of a slope falls as the cube of
// the taps.
ErrorOf TrendTest::slope_within(const AutocorrelationTime& memory) const {
  const auto n_series = static_cast<double>(n_series_);
  const double of_line = rounding * slopes_.mean() * static_cast<double>(n_);
  if (memory.variance <= of_line * of_line) {
    return {0, n_series * static_cast<double>(n_ - 2)};
  }
  if (!memory.found()) return {};
  ErrorOf found;
  for (const Level& level : levels_) {
    const auto length = static_cast<double>(level.length);
    if (length < times_of_a_block * (memory.time + memory.error) &&
        !(level.length == 1 && memory.time <= 0.5))
      continue;
    const auto n_blocks = static_cast<double>(level.n_blocks);
    const double dof = n_series * (n_blocks - 2);
    if (found.known() && dof < enough_freedom) break;
    const double shared = 1 - std::max(0.0, memory.time - 0.5) / length;
    const double variance = level.squares / dof / shared;
    const double in_blocks = n_blocks * length / static_cast<double>(n_);
    found = {std::sqrt(variance * std::pow(in_blocks, 3) / leverage(n_blocks) / n_series) / length,
             dof};
  }
  return found;
}

// Realizations whose slopes differ by more than each should change have a memory beyond the blocks.
bool is_doubted(const ErrorOf& series_error, const ErrorOf& scatter_error) {
  if (!series_error.known() || !scatter_error.known() || series_error.error == 0) return false;
  return fisher_tail(std::pow(scatter_error.error / series_error.error, 2), scatter_error.dof,
                     series_error.dof) < doubted;
}

Trend TrendTest::result() const {
  const auto n = static_cast<double>(n_), n_series = static_cast<double>(n_series_);
  Trend trend;
  trend.line.value = slopes_.mean() * n;
  trend.halves.value = halves_.mean();
  if (n_series_ > 1) {
    trend.line.scatter_error = {slopes_.standard_error() * n, n_series - 1};
    trend.halves.scatter_error = {halves_.standard_error(), n_series - 1};
  }
  trend.memory = about_lines_.result();
  trend.sigma = std::sqrt(trend.memory.variance);
  trend.line.series_error = slope_within(trend.memory);
  trend.line.series_error.error *= n;
  if (is_doubted(trend.line.series_error, trend.line.scatter_error)) trend.line.series_error = {};
  // With a spectrum that is flat at low frequencies, variances of 12 and 4 times that of the mean.
  trend.halves.series_error = {trend.line.series_error.error / std::sqrt(3.0),
                               trend.line.series_error.dof};
  const double variance = variance_ / n_series;
  if (variance > 0) {
    trend.share =
        std::min(1.0, trend.line.value * trend.line.value * (n * n - 1) / (12 * n * n) / variance);
  }
  const ChangeTest tests[] = {
      {trend.line, trend.line.scatter_error, "slope over realizations", false},
      {trend.line, trend.line.series_error, "slope within series", true},
      {trend.halves, trend.halves.scatter_error, "halves over realizations", false},
      {trend.halves, trend.halves.series_error, "halves within series", true}};
  double smallest = 2;
  for (const ChangeTest& test : tests) {
    const double p = test.p();
    if (std::isnan(p)) continue;
    ++trend.tests;
    if (p >= smallest) continue;
    smallest = p;
    trend.decisive = test.name;
    trend.decisive_dof = test.error.dof;
  }
  if (trend.tests > 0) trend.p = std::min(1.0, smallest * static_cast<double>(trend.tests));
  trend.detectable = std::numeric_limits<double>::infinity();
  for (const ChangeTest& test : std::span(tests).first(2)) {
    if (std::isnan(test.p())) continue;
    const double level = Trend::level / static_cast<double>(trend.tests);
    trend.detectable =
        std::min(trend.detectable, test.error.error * smallest_effect_found(level, test.error.dof));
  }
  return trend;
}

std::string Trend::statement() const {
  if (is_constant()) return "no drift: the series is constant";
  if (tests == 0) return "no test of a drift is possible";
  const std::string test =
      finite_text("{}, {} test{}, least by the {}, {:.3g} degree{} of freedom", p_text(p), tests,
                  tests == 1 ? "" : "s", decisive, decisive_dof, decisive_dof == 1 ? "" : "s");
  if (!drifts()) return fmt::format("no drift found ({})", test);
  return finite_text(
      "it drifts{}: {:+.2g}{} over the taps by its line, halves differ by {:+.2g}{} ({})",
      line.scatter_error.known() ? "" : ", or remembers for longer than these taps", line.value,
      unit_behind(units), halves.value, unit_behind(units), test);
}

std::string Trend::power(const std::string& only) const {
  const double relative = detectable_in_sigma();
  const std::string found = finite_text(
      "the test finds {}drifts of {:.2g}{} or more over the taps (80 % power{})", only, detectable,
      unit_behind(units), line.scatter_error.known() ? "" : ", unless memory is underestimated");
  if (!std::isfinite(relative)) return found;
  return found + finite_text(", {:.2g} times the scatter of taps about their line", relative);
}

}  // namespace jostle::inline ensemble
