#pragma once

#include <string>

#include "fitting/fit.hpp"

namespace jostle::inline ensemble {

/// True if the least squares have moved a free parameter away from all that the data could
/// constrain of it: overflown, or with a standard error over 100 times a positive parameter, or a
/// level over 100 times the largest value of the curve. Such a number is neither stored nor
/// printed.
bool has_diverged(const Fit& fit, std::size_t parameter);

/// "the data do not limit b, tau: ...", or nothing.
std::string diverged_parameters(const Fit& fit);

}  // namespace jostle::inline ensemble
