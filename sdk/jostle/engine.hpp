#pragma once

// Spheres in a container: starts, taps, and the two engines that let a bed settle after a tap.
// jostle::engine suffices to link.

#include "engine/bed/bed_mechanics.hpp"
#include "engine/bed/boundary.hpp"
#include "engine/bed/mixture.hpp"
#include "engine/engines.hpp"
#include "engine/monte_carlo/relaxation.hpp"
#include "engine/starts/starts.hpp"
#include "engine/taps.hpp"
