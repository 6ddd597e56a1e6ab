#pragma once

#include <string>
#include <vector>

#include "ensemble/ageing.hpp"

// Eq. 6 of Philippe & Bideau 2001, A(t) = A_inf (1 - 1/(1 + B ln(1 + t/tau))), fitted to ageing
// curves. It is empirical: it starts like t, and in a steady state A is 2 sigma^2 (1 - C(t)).
namespace jostle {

/// The law at one waiting time. Errors are jackknife errors over realizations: NaN where a refit
/// did not settle, or where the data set the parameter no limit on a side. A value without a fit is
/// NaN.
struct AgeingLaw {
  double a_inf, a_inf_error;
  double b, b_error;
  double tau, tau_error;  // taps
  double reduced_chi2;    // takes lags for independent, which they are not
  double misfit;          // root mean square of A / law - 1 over lags
  std::string verdict;    // what the curve says of each parameter, or why there is no fit
};

/// Of realizations that reached every tap asked for, the same for all waiting times.
struct AgeingFits {
  std::vector<AgeingLaw> own;  // [n_waiting_times], each with a B of its own
  /// [n_waiting_times], all with the same B; NaN, with the reason as the verdict, where the data do
  /// not limit the waiting time's own parameters or B: nothing is to be scaled by a runaway. Where
  /// B may be 0 it is held at 0.001, which makes a logarithm of eq. 6, and the verdict says so.
  std::vector<AgeingLaw> shared;
  std::uint64_t realizations = 0;
};

/// Fits A(t, t_W) at every waiting time, then all together with one B. Lags weigh by their relative
/// deviations: the error of a mean of squares goes with the mean, so errors of the points
/// themselves would draw the fit down; they are taken from the law, fitted repeatedly. The result
/// does not depend on the number of threads.
AgeingFits fit_ageing(const TapRows& rows, const AgeingGrid& grid, int threads = 1);

}  // namespace jostle
