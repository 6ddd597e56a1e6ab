#pragma once

#include <cstddef>
#include <vector>

#include "fitting/curve.hpp"

// The mean over realizations of which some have no value at some t, as experiments end early or
// lose a picture.
namespace jostle::inline fitting {

/// Realizations in groups that no t links: two that both have a value at one t are in one group.
/// values: [n, n_realizations], NaN where missing.
std::vector<std::vector<std::size_t>> linked_groups(const std::vector<double>& values,
                                                    std::size_t n_realizations);

/// The mean curve in the additive model X_r(t) = mean(t) + offset_r + noise, by least squares, the
/// offsets summing to 0 (two-way layout with unequal numbers: Yates 1934, J. Am. Stat.
/// Assoc. 29, 51). A realization that leaves moves a plain mean by its offset, and does not move
/// this mean. Where no value is missing it is the plain mean.
///
/// The curve's `values` are then pseudo-values: the mean plus n_realizations times the influence of
/// each realization on it (infinitesimal jackknife: Efron 1982, The Jackknife, the Bootstrap and
/// Other Resampling Plans, ch. 6), residuals enlarged by what the mean at their t took of them.
/// They scatter as whole curves by what the mean is uncertain by. values: [n, n_realizations], NaN
/// where missing, two present at every t, realizations in one linked group.
Curve mean_of_present(std::vector<double> t, std::vector<double> values,
                      std::size_t n_realizations);

}  // namespace jostle::inline fitting
