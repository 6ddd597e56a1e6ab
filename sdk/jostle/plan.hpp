#pragma once

// The cost of a study before it is run: pilots, error bars against time, shards and batch jobs.

#include "study/planning/cost_run.hpp"
#include "study/planning/job_plan.hpp"
#include "study/planning/scene_pilot.hpp"
#include "study/planning/shards.hpp"
