#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace jostle {

/// Which effects of a resolved scene are on, a line each, and the names of those that are off.
std::string effects_text(const nlohmann::ordered_json& resolved);

}  // namespace jostle
