#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fitting/counts.hpp"

// Laws of distributions, fitted to the histograms of realizations by maximum likelihood.
namespace jostle::inline ensemble {

/// Counts of several realizations in common bins, including empty ones.
struct Histogram {
  std::vector<Bin> bins;           // [n_bins], ascending
  std::vector<double> counts;      // [n_bins, n_realizations]
  std::uint32_t realizations = 0;  // each counted by itself
};

/// NaN stands for what does not exist.
struct HistogramFit {
  std::vector<double> values;  // [n_parameters], of the mean over realizations
  /// Standard errors by the jackknife over realizations; NaN with one realization.
  std::vector<double> errors;
  /// The chance that the law's own counts lie so far from it: Pearson's chi2, neighbouring bins
  /// joined until 5 are expected, over what the counts of realizations scatter by (F test). With
  /// one realization counts are taken for Poisson's, as if all that is counted were independent.
  double p;
  /// True if the law holds, with p; or why there is no fit.
  std::string status;
};

/// The law of the mean over realizations (fitting/counts.hpp). Serial and deterministic.
HistogramFit fit_histogram(const Model& law, const Histogram& histogram);

}  // namespace jostle::inline ensemble
