#include "ensemble/analysis/ageing/trends.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/numbers.hpp"
#include "ensemble/statistics/finite_text.hpp"

namespace jostle::inline ensemble {

namespace {

constexpr double significant = significance_level;
constexpr double decisive = 10;         // a factor that a test should find
constexpr double largest_factor = 1e6;  // a factor beyond which nothing is stored

// For a logarithm that the weights times `values` estimate, over the sum of their squares.
AgeTrend trend(const LogCurves& curves, const Eigen::VectorXd& weights,
               const Eigen::VectorXd& values) {
  const double squares = weights.squaredNorm();
  const double logarithm = weights.dot(values) / squares;
  const ErrorOf error = error_of_sum(curves, weights / squares);
  AgeTrend found{log_estimate(std::exp(logarithm), error), p_value(logarithm, error),
                 std::exp(smallest_effect_found(significant, error.dof) * error.error), ""};
  if (!(found.factor.low_95 > 1 / largest_factor && found.factor.high_95 < largest_factor)) {
    found.factor = no_estimate();
  }
  if (std::isnan(found.p) || !(found.detectable < largest_factor)) found.detectable = not_a_number;
  return found;
}

// "p = 0.3; a factor of 4 would be found with power 0.8".
std::string power_of(const AgeTrend& found, const TestedChange& words) {
  const std::string change =
      fmt::format("change of {} from {} to the last", words.quantity, words.first);
  if (std::isnan(found.p)) return change + ": no test, its error is not known";
  if (std::isnan(found.detectable)) {
    return fmt::format("{}: {}, {}the uncertainty is too large to detect any change", change,
                       p_text(found.p),
                       found.p < significant ? "which does not count because " : "");
  }
  return finite_text("{}: {}, a factor of {:.3g} would be found with power 0.8", change,
                     p_text(found.p), found.detectable);
}

// An error beyond all factors leaves a small p without a meaning.
bool finds(const AgeTrend& found) {
  return found.p < significant && !std::isnan(found.detectable);
}

std::string verdict(const AgeTrend& found, bool is_excluded, std::size_t realizations,
                    const TestedChange& words) {
  const std::string power = power_of(found, words);
  if (finds(found)) return fmt::format("{} ({})", words.changes, power);
  if (is_excluded) return fmt::format("{} ({})", words.does_not, power);
  return fmt::format("cannot decide with {} realizations ({})", realizations, power);
}

}  // namespace

AgeTrend tested_change(const LogCurves& curves, const Eigen::VectorXd& weights,
                       const Eigen::VectorXd& values, const TestedChange& words) {
  AgeTrend found = trend(curves, weights, values);
  found.verdict = verdict(found, found.detectable <= decisive,
                          static_cast<std::size_t>(curves.influences.cols()), words);
  return found;
}

AgeTrend agreed(const AgeTrend& first, const AgeTrend& second, std::size_t realizations,
                const TestedChange& words) {
  if (std::isnan(first.p) || std::isnan(second.p)) return std::isnan(first.p) ? first : second;
  AgeTrend found{no_estimate(), std::max(first.p, second.p), not_a_number, ""};
  if (!std::isnan(first.detectable) && !std::isnan(second.detectable)) {
    found.detectable = std::max(first.detectable, second.detectable);
  }
  found.verdict = verdict(found, found.detectable <= decisive && !finds(first) && !finds(second),
                          realizations, words);
  if (finds(first) != finds(second)) {
    found.verdict +=
        fmt::format("; only one of the two tests rejects the null hypothesis of no change, {}",
                    plain_p_text(std::min(first.p, second.p)));
  }
  return found;
}

double place_of(std::size_t curve, const LogCurves& curves) {
  return static_cast<double>(curve) / static_cast<double>(curves.size() - 1) - 0.5;
}

AgeTrend cannot_decide(const std::string& reason) {
  return {no_estimate(), not_a_number, not_a_number, "cannot decide: " + reason};
}

AgeTrend trend_with_age(const LogCurves& curves, const std::string& name) {
  if (curves.size() < 2) return cannot_decide("fewer than two waiting times have curves");
  const std::size_t n_lags = 1 + std::ranges::max(curves.lag_indices);
  std::vector<double> sums(n_lags, 0.0), counts(n_lags, 0.0);
  Eigen::VectorXd weights(curves.ln_a.size());
  for (const bool centre : {false, true}) {
    for (std::size_t k = 0; k < curves.size(); ++k) {
      for (std::size_t i = curves.first[k]; i < curves.first[k + 1]; ++i) {
        const std::size_t j = curves.lag_indices[i];
        if (centre) {
          weights[static_cast<Eigen::Index>(i)] = place_of(k, curves) - sums[j] / counts[j];
        } else {
          sums[j] += place_of(k, curves);
          counts[j] += 1;
        }
      }
    }
  }
  if (!(weights.squaredNorm() > 0)) return cannot_decide("waiting times have no lag in common");
  return tested_change(
      curves, weights, curves.ln_a,
      {name, name + " changes with age", "no change of " + name + " with age found"});
}

AgeTrend trend_of_b(const AgeingLeastSquares& fit) {
  const LogCurves& curves = fit.curves();
  if (curves.size() < 2) return cannot_decide("fewer than two waiting times have curves");
  if (!fit.describes()) return cannot_decide("eq. 6 does not describe these curves");
  const Eigen::MatrixXd slopes = fit.slopes(fit.best());
  Eigen::VectorXd column = slopes.col(static_cast<Eigen::Index>(fit.b()));
  for (std::size_t k = 0; k < curves.size(); ++k) {
    for (std::size_t i = curves.first[k]; i < curves.first[k + 1]; ++i) {
      column[static_cast<Eigen::Index>(i)] *= place_of(k, curves);
    }
  }
  const Eigen::VectorXd weights = beyond_others(column, slopes);
  if (!(weights.squaredNorm() > 0)) return cannot_decide("the curves do not constrain B");
  return tested_change(curves, weights, fit.residuals(fit.best()),
                       {"B", "collapse rejected", "collapse not rejected"});
}

}  // namespace jostle::inline ensemble
