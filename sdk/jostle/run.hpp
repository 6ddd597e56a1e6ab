#pragma once

// A scene run into a results file, resumed, extended to a target precision, and merged from shards.

#include "study/available_cpus.hpp"
#include "study/running/merge.hpp"
#include "study/running/run.hpp"
#include "study/running/scene_tables.hpp"
#include "study/running/self_checks.hpp"
