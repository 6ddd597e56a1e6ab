#pragma once

#include <limits>

namespace jostle::inline fitting {

/// Sources of this folder alone include this header: other folders have engine/numbers.hpp.
inline constexpr double infinite = std::numeric_limits<double>::infinity();

}  // namespace jostle::inline fitting
