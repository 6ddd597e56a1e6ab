#include "ensemble/analysis/ageing/log_curves.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

namespace jostle::inline ensemble {

namespace {

struct Logarithms {
  double logarithm;
  std::vector<double> without_one;
};

Logarithms logarithms(const std::vector<double>& changes, Changes kind) {
  if (kind == Changes::variance) {
    return {std::log(variance(changes)), ln_variances_without_one(changes)};
  }
  std::vector<double> squares;
  double sum = 0;
  for (const double change : changes) {
    squares.push_back(change * change);
    sum += squares.back();
  }
  return {std::log(sum / static_cast<double>(squares.size())), ln_means_without_one(squares)};
}

// Nothing where the series does not have both taps, or too few realizations change.
std::optional<Logarithms> change_over(const TapRows& rows, std::uint64_t waiting_time,
                                      std::uint64_t lag,
                                      const std::vector<std::uint32_t>& realizations,
                                      Changes kind) {
  const std::span<const double> early = rows.row(waiting_time), late = rows.row(waiting_time + lag);
  if (early.empty() || late.empty()) return std::nullopt;
  std::vector<double> changes;
  for (const std::uint32_t r : realizations) changes.push_back(late[r] - early[r]);
  Logarithms found = logarithms(changes, kind);
  if (found.without_one.empty() ||
      !std::ranges::all_of(found.without_one, [](double x) { return std::isfinite(x); }))
    return std::nullopt;
  return found;
}

}  // namespace

std::size_t lags_of_curve(const TapRows& rows, const AgeingGrid& grid,
                          const std::vector<std::uint32_t>& realizations, std::size_t waiting_time,
                          Changes kind) {
  return static_cast<std::size_t>(std::ranges::count_if(grid.lags, [&](std::uint64_t lag) {
    return change_over(rows, grid.waiting_times[waiting_time], lag, realizations, kind).has_value();
  }));
}

LogCurves LogCurves::single(std::size_t curve) const {
  const auto begin = static_cast<std::ptrdiff_t>(first[curve]);
  const auto end = static_cast<std::ptrdiff_t>(first[curve + 1]);
  return {{waiting_times[curve]},
          {0, first[curve + 1] - first[curve]},
          {lag_indices.begin() + begin, lag_indices.begin() + end},
          {lags.begin() + begin, lags.begin() + end},
          ln_a.segment(begin, end - begin),
          influences.middleRows(begin, end - begin)};
}

ErrorOf error_of_sum(const LogCurves& curves, const Eigen::VectorXd& weights) {
  const auto m = static_cast<double>(curves.influences.cols());
  const Eigen::RowVectorXd sums = weights.transpose() * curves.influences;
  return {std::sqrt(sums.squaredNorm() / (m * (m - 1))), m - 1};
}

LogCurves log_curves(const TapRows& rows, const AgeingGrid& grid,
                     const std::vector<std::uint32_t>& realizations, Changes kind) {
  LogCurves curves;
  curves.first = {0};
  const std::size_t m = realizations.size();
  std::vector<double> ln_a, influences;
  for (std::size_t k = 0; k < grid.waiting_times.size(); ++k) {
    for (std::size_t j = 0; j < grid.lags.size(); ++j) {
      const auto found = change_over(rows, grid.waiting_times[k], grid.lags[j], realizations, kind);
      if (!found) continue;
      const auto& [logarithm, left_out] = *found;
      curves.lag_indices.push_back(j);
      curves.lags.push_back(static_cast<double>(grid.lags[j]));
      ln_a.push_back(logarithm);
      double mean = 0;
      for (const double x : left_out) mean += x / static_cast<double>(m);
      for (const double x : left_out) influences.push_back(static_cast<double>(m - 1) * (mean - x));
    }
    const std::size_t first = curves.first.back();
    if (curves.lags.size() - first >= fewest_lags) {
      curves.waiting_times.push_back(k);
      curves.first.push_back(curves.lags.size());
    } else {
      curves.lags.resize(first);
      curves.lag_indices.resize(first);
      ln_a.resize(first);
      influences.resize(first * m);
    }
  }
  const auto n = static_cast<Eigen::Index>(ln_a.size());
  curves.ln_a = Eigen::Map<const Eigen::VectorXd>(ln_a.data(), n);
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  curves.influences = Eigen::Map<const Rows>(influences.data(), n, static_cast<Eigen::Index>(m));
  return curves;
}

}  // namespace jostle::inline ensemble
