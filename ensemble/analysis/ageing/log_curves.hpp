#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "ensemble/analysis/ageing/ageing.hpp"
#include "ensemble/statistics/student_tests.hpp"

namespace jostle::inline ensemble {

/// ln A of some waiting times at their lags, one curve after another.
struct LogCurves {
  std::vector<std::size_t> waiting_times;  // [n_curves], indices into a grid's
  std::vector<std::size_t> first;          // [n_curves + 1], of the points of each curve
  std::vector<std::size_t> lag_indices;    // [n_points], into a grid's
  std::vector<double> lags;                // [n_points], taps, ascending in each curve
  Eigen::VectorXd ln_a;                    // [n_points]
  /// [n_points, n_realizations]: jackknife pseudo-values of ln A less their mean.
  Eigen::MatrixXd influences;

  std::size_t size() const { return waiting_times.size(); }
  LogCurves single(std::size_t curve) const;
};

/// Quantity of a curve at equal lag: mean squares of changes, A, or their variance, V
/// (ensemble/analysis/ageing/ageing.hpp).
enum class Changes { mean_square, variance };

/// Number of lags that a law needs: one more than it has parameters.
inline constexpr std::size_t fewest_lags = 4;

/// Number of lags over which two realizations or more change from a waiting time on, by its index.
std::size_t lags_of_curve(const TapRows& rows, const AgeingGrid& grid,
                          const std::vector<std::uint32_t>& realizations, std::size_t waiting_time,
                          Changes kind = Changes::mean_square);

/// For some realizations without a gap: the waiting times with enough lags for a law, without the
/// lags over which fewer than two realizations change.
LogCurves log_curves(const TapRows& rows, const AgeingGrid& grid,
                     const std::vector<std::uint32_t>& realizations,
                     Changes kind = Changes::mean_square);

/// Standard error of the sum over points of weights times ln A, by the jackknife over realizations.
ErrorOf error_of_sum(const LogCurves& curves, const Eigen::VectorXd& weights);

}  // namespace jostle::inline ensemble
