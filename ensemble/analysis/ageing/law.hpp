#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "ensemble/analysis/ageing/log_curves.hpp"
#include "ensemble/statistics/log_estimate.hpp"

// Eq. 6 of Philippe & Bideau 2001, A(t) = A_inf (1 - 1/(1 + B ln(1 + t/tau))), by least squares of
// ln A, all lags alike, for one or several curves with one B. Lags of a path are not independent:
// errors come from realizations alone.
namespace jostle::inline ensemble {

/// ln(1 - 1/(1 + B ln(1 + t/tau))).
double ln_eq_6(double lag, double ln_b, double ln_tau);

/// The least squares over B from 0.001 to 1000 and tau from a hundredth of the first lag to ten
/// thousand times the last, found on a grid and then between its places: no start is needed and
/// nothing diverges. A point is [n_parameters]: ln A_inf and ln tau of every curve, then ln B.
class AgeingLeastSquares {
 public:
  /// Each curve has more than three points, of at least two realizations.
  explicit AgeingLeastSquares(LogCurves curves, std::optional<double> held_ln_b = {});

  static std::size_t a_inf(std::size_t curve) { return 2 * curve; }
  static std::size_t tau(std::size_t curve) { return 2 * curve + 1; }
  std::size_t b() const { return 2 * curves_.size(); }

  const LogCurves& curves() const { return curves_; }
  const Eigen::VectorXd& best() const { return best_; }
  bool b_is_held() const { return ln_b_.size() == 1; }
  /// True if the law can be that of the curves. Not where the squares still fall at the best point,
  /// along a tau or B, by more than chance (Student's t, 5 %): curves that rise faster than the
  /// lag, or steepen, require a B or a 1/tau below 0. The best point is then on the edge of the
  /// search, or on a ridge that leads there, so flat that rounding stops it.
  bool describes() const { return describes_; }

  /// The interval of a parameter that is not held reaches to the values that are refuted: with the
  /// parameter there and all others fitted anew, the slope of the squares along it is compared with
  /// its jackknife error by Student's t. Nothing is refuted where the law does not describe the
  /// curves. Ends beyond the search are infinite, or 0.
  LogEstimate estimate(std::size_t parameter) const;

  /// d ln A / d parameter: [n_points, n_parameters], 0 for a B that is held.
  Eigen::MatrixXd slopes(const Eigen::VectorXd& parameters) const;
  /// ln A less the law's.
  Eigen::VectorXd residuals(const Eigen::VectorXd& parameters) const;

 private:
  /// The shape of eq. 6 at one place of the grid against one curve.
  struct Cell {
    double mean, squares;  // sum of squares about the mean of ln A less the shape
  };
  const Cell& cell(std::size_t curve, std::size_t b, std::size_t tau) const;
  void fill_cells();
  struct Place {
    double ln_tau, cost;
  };
  double ln_tau_at(double place) const;
  bool is_scale(std::size_t parameter) const { return parameter != b() && parameter % 2 == 0; }
  /// For the curve whose parameter is held, with B at a place of the grid.
  Place place_with(std::size_t held, double value, std::size_t b) const;
  /// The best point with B at a place of the grid, with one parameter held (or none).
  Eigen::VectorXd at_b(std::size_t place, std::optional<std::size_t> held, double value) const;
  /// The best of those of all B.
  Eigen::VectorXd on_grid(std::optional<std::size_t> held, double value) const;
  /// The least squares: the lowest of the descents from every valley of the grid.
  Eigen::VectorXd lowest_point() const;
  /// True at an edge of the search from where the squares, with this slope, fall outwards.
  bool is_on_edge(std::size_t parameter, const Eigen::VectorXd& parameters, double slope) const;
  /// All that are neither held nor at such an edge.
  std::vector<Eigen::Index> free_parameters(const Eigen::VectorXd& parameters,
                                            const Eigen::MatrixXd& slopes,
                                            const Eigen::VectorXd& residual,
                                            std::optional<std::size_t> held) const;
  /// Moves the free parameters, within the search, and fits every A_inf that is not held.
  Eigen::VectorXd stepped(Eigen::VectorXd parameters, const std::vector<Eigen::Index>& free,
                          const Eigen::VectorXd& change, std::optional<std::size_t> held) const;
  Eigen::VectorXd fitted(const Eigen::VectorXd& start, std::optional<std::size_t> held) const;
  Eigen::VectorXd refined(Eigen::VectorXd parameters, std::optional<std::size_t> held) const;
  bool describes_curves() const;
  /// For the points in the slope of the squares along a parameter, the others fitted but those at
  /// an edge that the squares push outwards.
  Eigen::VectorXd weights_of(std::size_t parameter, const Eigen::VectorXd& parameters) const;
  /// Student's t of a value of a parameter.
  double t_of(std::size_t parameter, double value) const;

  LogCurves curves_;
  std::vector<double> ln_b_, ln_tau_;                  // the grid
  std::vector<Cell> cells_;                            // [n_curves, n_b, n_tau]
  std::vector<std::vector<double>> best_tau_, least_;  // [n_curves][n_b]: ln tau, squares there
  Eigen::VectorXd best_;
  bool describes_ = true;
};

/// For the values that a column takes beyond what the other columns make up for: residuals of its
/// least squares on them.
Eigen::VectorXd beyond_others(const Eigen::VectorXd& column, const Eigen::MatrixXd& other_columns);

}  // namespace jostle::inline ensemble
