#pragma once

#include <string>
#include <vector>

#include "study/running/scene_file.hpp"

namespace jostle::inline study {

/// Warnings of values that are probably not intended, though they can be run: angles in degrees,
/// dilations in percent, results of terabytes. One sentence each.
std::vector<std::string> scene_warnings(const LoadedScene& loaded);

}  // namespace jostle::inline study
