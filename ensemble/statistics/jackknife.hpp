#pragma once

#include <cstddef>
#include <span>

#include "fitting/fit.hpp"

namespace jostle::inline ensemble {

/// Standard error of an estimate, from the estimates with each of n realizations left out in turn:
/// sqrt((n - 1)/n sum (x_i - mean)^2). NaN below two, or where one of them is NaN. Tukey 1958,
/// Ann. Math. Statist. 29, 614.
double jackknife_error(std::span<const double> left_out);

/// Half the width of the interval that holds the truth with probability `level`: the error times
/// Student's t of n - 1 degrees of freedom. NaN below two realizations.
double student_half_width(double error, std::size_t realizations,
                          double level = interval_levels[0]);

}  // namespace jostle::inline ensemble
