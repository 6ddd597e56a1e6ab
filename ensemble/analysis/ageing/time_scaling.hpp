#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ensemble/analysis/ageing/trends.hpp"

// Tests if curves of all ages are one function of one variable made of lag and age. The function is
// not given: cubic splines of ln A, a knot per decade of the variable, by least squares over all
// lags with equal weights. Errors come from realizations alone.
namespace jostle::inline ensemble {

/// A(t, t_W) = F(t / t_W^mu). mu = 0: no ageing; 0 < mu < 1: subageing; 1: full ageing, t_W is the
/// only time scale. After Struik 1978 (Physical Aging in Amorphous Polymers and Other Materials)
/// and Bouchaud, Cugliandolo, Kurchan & Mezard 1998, arXiv:cond-mat/9702070.
struct AgeingExponent {
  double mu, error;        // least squares, jackknife error; NaN without 68 % limits
  double low_68, high_68;  // values that the slope of the squares does not refute, Student's t
  double low_95, high_95;
  std::string verdict;
  /// Change with age of A at equal t / t_W^mu: if there is one, no mu brings the curves onto one
  /// another.
  AgeTrend collapse;
};

/// NaN, and words, below four realizations, where fewer than two waiting times above 0 have curves,
/// and where a test of the collapse finds that it does not hold. Ends that the data do not give are
/// infinite; the search goes from -1 to 2: beyond, curves a decade of age apart no longer overlap,
/// and any function fits. waiting_times: [n_curves], taps; name: of A in words.
AgeingExponent ageing_exponent(const LogCurves& curves,
                               const std::vector<std::uint64_t>& waiting_times,
                               const std::string& name);

/// A(t, t_W) = F(ln(t_W + t) / ln t_W), after Nicodemi & Coniglio 1999,
/// doi:10.1103/PhysRevLett.82.916: the change with age of ln(1 + t/t_W) / ln t_W at equal A. Of
/// waiting times above 1.
AgeTrend logarithmic_collapse(const LogCurves& curves,
                              const std::vector<std::uint64_t>& waiting_times,
                              const std::string& name);

/// Both, of one quantity.
struct TimeScaling {
  AgeingExponent power;
  AgeTrend logarithmic;
};

/// No numbers, and both verdicts "cannot decide: WHY".
TimeScaling cannot_scale(const std::string& reason);
/// Both, of the curves of the grid's waiting times; `name`: of A in words.
TimeScaling time_scaling(const LogCurves& curves, const AgeingGrid& grid, const std::string& name);

}  // namespace jostle::inline ensemble
