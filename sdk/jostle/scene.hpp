#pragma once

// Scenes as JSON describes them: the scene of a file with a plan for every sweep point, and its
// warnings.

#include "config/ladder.hpp"
#include "study/running/scene_file.hpp"
#include "study/running/scene_warnings.hpp"
