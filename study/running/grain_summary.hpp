#pragma once

#include <string>
#include <vector>

#include "ensemble/plan.hpp"

namespace jostle::inline study {

/// Derived numbers of the settings of discrete elements, one line each: contact time, time step,
/// the steps per tap takes at least, and of every tap that moves the floor Gamma = a (2 pi f)^2 / g
/// and the overlap of two spheres that meet at the floor's greatest speed. Empty for other engines.
std::vector<std::string> grain_summary(const Plan& plan);

/// A warning for each tap whose floor is so fast that spheres overlap by as much as lets a
/// realization fail. Empty for other engines.
std::vector<std::string> overlap_warnings(const Plan& plan);

}  // namespace jostle::inline study
