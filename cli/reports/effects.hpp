#pragma once

#include <string>

#include "config/json/json.hpp"

namespace jostle::inline cli {

/// Lists which effects of a resolved scene are on, a line each, and the names of those that are
/// off. A value that the sweep replaces is "swept".
std::string effects_text(const Json& scene);

}  // namespace jostle::inline cli
