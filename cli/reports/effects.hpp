#pragma once

#include <string>

#include "config/json/json.hpp"

namespace jostle::inline cli {

/// Which effects of a resolved scene are on, a line each, and the names of those that are off.
std::string effects_text(const Json& resolved);

}  // namespace jostle::inline cli
