#include "ensemble/analysis/ageing/trends.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace jostle::inline ensemble {

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double significant = 0.05;
constexpr double decisive = 10;   // a factor that a test should find
constexpr double farthest = 1e6;  // a factor beyond which nothing is stored

// Of a logarithm that the weights times `values` estimate, over the sum of their squares.
AgeTrend trend(const LogCurves& curves, const Eigen::VectorXd& weights,
               const Eigen::VectorXd& values) {
  const double squares = weights.squaredNorm();
  const double logarithm = weights.dot(values) / squares;
  const ErrorOf error = error_of_sum(curves, weights / squares);
  AgeTrend found{log_estimate(std::exp(logarithm), error), p_value(logarithm, error),
                 std::exp(smallest_effect_found(significant, error.dof) * error.error), ""};
  if (!(found.factor.low_95 > 1 / farthest && found.factor.high_95 < farthest)) {
    found.factor = no_estimate();
  }
  if (!(found.detectable < farthest)) found.detectable = not_a_number;
  return found;
}

// "p = 0.3; a factor of 4 would be found with power 0.8".
std::string power_of(const AgeTrend& found, const std::string& of) {
  const std::string power =
      std::isnan(found.detectable)
          ? "none would be found"
          : fmt::format("a factor of {:.3g} would be found with power 0.8", found.detectable);
  return fmt::format("change of {} from the first waiting time to the last: p = {:.2g}, {}", of,
                     found.p, power);
}

void judge(AgeTrend& found, const std::string& of, const std::string& changes,
           const std::string& does_not, std::size_t realizations) {
  const std::string power = power_of(found, of);
  // An error beyond all factors leaves a small p without a meaning.
  if (found.p < significant && !std::isnan(found.detectable)) {
    found.verdict = fmt::format("{} ({})", changes, power);
  } else if (found.detectable <= decisive) {
    found.verdict = fmt::format("{} ({})", does_not, power);
  } else {
    found.verdict = fmt::format("cannot decide with {} realizations ({})", realizations, power);
  }
}

// From -1/2 to 1/2.
double place_of(std::size_t curve, const LogCurves& curves) {
  return static_cast<double>(curve) / static_cast<double>(curves.size() - 1) - 0.5;
}

}  // namespace

AgeTrend cannot_decide(const std::string& why) {
  return {no_estimate(), not_a_number, not_a_number, "cannot decide: " + why};
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
  AgeTrend found = trend(curves, weights, curves.ln_a);
  judge(found, name, name + " changes with age", "no change of " + name + " with age found",
        static_cast<std::size_t>(curves.influences.cols()));
  return found;
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
  if (!(weights.squaredNorm() > 0)) return cannot_decide("the curves say nothing of b");
  AgeTrend found = trend(curves, weights, fit.residuals(fit.best()));
  judge(found, "b", "collapse refuted", "collapse not refuted",
        static_cast<std::size_t>(curves.influences.cols()));
  return found;
}

}  // namespace jostle::inline ensemble
