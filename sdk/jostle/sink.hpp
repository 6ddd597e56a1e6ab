#pragma once

// Realizations run in parallel into a Sink of your own, without a results file.

#include "ensemble/fold.hpp"
#include "ensemble/run.hpp"
#include "ensemble/sink.hpp"
