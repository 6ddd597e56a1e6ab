#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fitting/fit.hpp"

// Honest errors of a fit to an ensemble's mean. The taps of a realization are not independent, but
// realizations are: what they scatter by, the fit scatters by.
namespace jostle::inline ensemble {

enum class Resampling {
  jackknife,  // each realization left out in turn
  bootstrap   // an equal number of realizations drawn with replacement, `count` times
};

struct ResamplingOptions {
  Resampling kind = Resampling::jackknife;
  std::uint32_t count = 1000;  // count of bootstrap resamples
  std::uint64_t seed = 1;
  int threads = 1;
};

/// One value a parameter each, [n_parameters].
struct ResampledErrors {
  std::vector<double> errors;     // standard errors
  std::vector<Interval> middle;   // 68 % limits of a bootstrap, by Student's t; else empty
  std::vector<Interval> central;  // 95 % limits
  std::uint32_t resamples = 0;    // refitted
  std::uint32_t failed = 0;       // resamples without a settled fit: not counted in the errors
};

/// The realizations behind a mean curve.
struct RealizationCurves {
  std::vector<double> t;           // [n_t]
  std::vector<double> sigma;       // [n_t], weights of the mean, kept for all refits; or empty
  std::vector<double> values;      // [n_t, n_realizations], finite
  std::uint32_t realizations = 0;  // at least 2
};

/// The mean over realizations, in order.
Curve mean_curve(const RealizationCurves& curves);

/// Refits the mean of resampled realizations, each from the parameters of `fit`, parameters fixed
/// there kept. The result does not depend on the number of threads.
ResampledErrors resample(const Model& model, const RealizationCurves& curves, const Fit& fit,
                         const ResamplingOptions& options);

}  // namespace jostle::inline ensemble
