#pragma once

// The structure of packings and of the packings that a results file keeps: the tables of `jostle
// structure`.

#include "structure/forces.hpp"
#include "structure/measure.hpp"
#include "structure/observables.hpp"
#include "structure/voids/clusters.hpp"
#include "structure/voids/voronoi.hpp"
#include "study/tables/structure.hpp"
