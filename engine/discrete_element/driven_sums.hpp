#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/bed/bed_mechanics.hpp"
#include "engine/discrete_element/grain_loop.hpp"

namespace jostle::inline engine {

/// Sums over samples of a bed while its floor moves, by height above the floor.
struct DrivenSums {
  struct Bin {
    double spheres = 0;                // in all samples together
    double freedom = 0;                // less one per sample that had any
    double lateral = 0, vertical = 0;  // squares of velocities about the mean of the sample
  };
  double bin_width = 0;  // diameters; 0: nothing is sampled
  std::uint64_t samples = 0;
  std::vector<Bin> bins;
};

/// Adds one sample. Spheres below the floor count as in the lowest bin.
void add_sample(DrivenSums& sums, std::span<const GrainState> grains, double floor_height);

/// `seconds`: of the unit of time of the velocities. Empty without a sample.
DrivenBed driven_bed(const DrivenSums& sums, double seconds);

}  // namespace jostle::inline engine
