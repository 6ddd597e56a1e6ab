#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ensemble/analysis/ageing/ageing.hpp"
#include "ensemble/analysis/ageing/time_scaling.hpp"

// Eq. 6 of Philippe & Bideau 2001, A(t) = A_inf (1 - 1/(1 + B ln(1 + t/tau))), fitted to ageing
// curves. It is empirical: it starts like t, and in a steady state A is 2 sigma^2 (1 - C(t)).
namespace jostle::inline ensemble {

/// The law at one waiting time. An end of an interval without a limit is infinite, or 0.
struct AgeingLaw {
  LogEstimate a_inf, b, tau;  // tau: taps
  double misfit;              // root mean square of A / law - 1 over lags
  std::string
      verdict;  // constraints of the curve on the parameters, or the reason of a missing fit
  /// B has no limit and is held at its best value: A_inf and tau, whose intervals are for that B,
  /// are scales of which only ratios between waiting times mean something.
  bool b_is_held = false;

  /// True if all parameters have limits on both sides (or B is held).
  bool is_determined() const;
};

/// For realizations that reached every tap asked for, the same for all waiting times.
struct AgeingFits {
  std::vector<AgeingLaw> own;  // [n_waiting_times], each with a B of its own
  /// [n_waiting_times], all with the same B. Nothing is to be scaled by a law that the data do not
  /// determine.
  std::vector<AgeingLaw> shared;
  /// Relative standard errors of A / A_inf at equal t / tau of the shared laws, those of A_inf and
  /// tau included: [n_waiting_times, n_lags].
  std::vector<double> scaled_error;
  AgeTrend ageing;        // change of A at equal lag
  AgeTrend fluctuations;  // change of V at equal lag, from four realizations on
  AgeTrend
      collapse;  // change of B: where there is one, no scales bring the curves onto one another
  TimeScaling a_scaling, v_scaling;  // scaling of A and V, each as one function of a variable
  std::uint64_t realizations = 0;
};

/// The law of one curve by itself.
AgeingLaw own_law(const LogCurves& curve);

/// Fits ln A(t, t_W) at every waiting time, then at all together with one B, all lags alike: the
/// error of a mean of squares goes with the mean. Needs three realizations; the verdict reports it.
/// The result does not depend on the number of threads.
AgeingFits fit_ageing(const TapRows& rows, const AgeingGrid& grid, int threads = 1);

}  // namespace jostle::inline ensemble
