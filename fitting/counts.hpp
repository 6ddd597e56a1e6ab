#pragma once

#include <span>
#include <string>
#include <vector>

#include "fitting/models/model.hpp"

// Laws of distributions, fitted to counts in bins by maximum likelihood. Least squares weighted by
// the counts observed trust bins that came out low by chance and are biased: Baker & Cousins 1984,
// doi:10.1016/0167-5087(84)90016-4.
namespace jostle::inline fitting {

/// Place of a bin along the law's variable. low == high: a whole number, whose expected count is
/// the law's value there; else the integral over the bin.
struct Bin {
  double low, high;
};

struct CountsFit {
  ParameterValues values;        // [n_parameters]
  std::vector<double> expected;  // [n_bins]
  std::string fault;             // why there is none: the fit did not settle, or diverged
};

/// The most likely parameters of Poisson counts (or their mean over realizations) whose expectation
/// in a bin is the law's: sum of 2 (mu - n + n ln(n / mu)) is least. counts: [n_bins], empty bins
/// included. Starts come from the data unless given.
CountsFit fit_counts(const Model& law, const std::vector<Bin>& bins,
                     const std::vector<double>& counts, const ParameterValues& start = {});

}  // namespace jostle::inline fitting
