#pragma once

#include <cstdint>
#include <vector>

#include "ensemble/analysis/ageing/tap_rows.hpp"
#include "ensemble/statistics/log_estimate.hpp"

// How an observable forgets: two-time functions of the lag t and the waiting time (age) t_W, both
// in taps. Where they depend on t_W, the packing ages; in a steady state they depend on t alone.
namespace jostle::inline ensemble {

struct AgeingGrid {
  std::vector<std::uint64_t> waiting_times;  // t_W, ascending; tap 0 is the start
  std::vector<std::uint64_t> lags;           // t, ascending, all at least 1
};

/// For a series of `n_taps` rows (at least 3): ten lags per decade up to its end, waiting times 0
/// and two per decade up to a tenth of it.
AgeingGrid ageing_grid(std::uint64_t n_taps);

/// Every tap that enters the two-time functions, ascending.
std::vector<std::uint64_t> taps_of(const AgeingGrid& grid);

/// Both functions over realizations: [n_waiting_times, n_lags] each. A pair of taps counts the
/// realizations that reached both; NaN where none did (errors: fewer than two).
struct AgeingCurves {
  AgeingGrid grid;

  /// A(t, t_W) = <(X(t_W + t) - X(t_W))^2>. Philippe & Bideau 2001, eq. 5, whose figure and eq. 6
  /// have t for the lag, as here. Errors and intervals from the jackknife of ln A over
  /// realizations: squares are skewed, and A +- t error would hold the truth too seldom.
  std::vector<LogEstimate> a;

  /// <X(t_W + t) - X(t_W)>, what all realizations share, with its standard error.
  std::vector<double> change, change_error;

  /// V(t, t_W), the variance of X(t_W + t) - X(t_W) over realizations (of M - 1): fluctuations
  /// beside the change that they share. A = change^2 + V (M - 1)/M. Errors and intervals from the
  /// jackknife of ln V, from four realizations on.
  std::vector<LogEstimate> v;

  /// C(t, t_W) = <dX(t_W + t) dX(t_W)> / <dX(t_W)^2>, dX = X - <X> over realizations at the same
  /// tap: a covariance over the variance at t_W alone, 1 at t = 0 and not bounded by 1 (no
  /// correlation coefficient). NaN where the realizations do not differ at t_W (a shared start).
  /// After Nicodemi & Coniglio 1999, doi:10.1103/PhysRevLett.82.916.
  std::vector<double> c;
  std::vector<double> c_error;  // jackknife over realizations

  std::vector<std::uint64_t> count;  // realizations of each pair

  std::size_t index_of(std::size_t waiting_time, std::size_t lag) const {
    return waiting_time * grid.lags.size() + lag;
  }
};

/// `rows` holds taps_of(grid), as far as the series goes.
AgeingCurves ageing_curves(const TapRows& rows, const AgeingGrid& grid);

}  // namespace jostle::inline ensemble
