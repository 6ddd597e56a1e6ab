#pragma once

#include <limits>

namespace jostle::inline engine {

/// A value that is missing or not defined.
inline constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
inline constexpr double infinite = std::numeric_limits<double>::infinity();

}  // namespace jostle::inline engine
