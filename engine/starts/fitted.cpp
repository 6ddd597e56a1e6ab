#include <string>

#include "engine/bed/geometry.hpp"
#include "engine/starts/parts.hpp"
#include "engine/starts/pour_bed.hpp"

namespace jostle::inline engine {

// Spheres of the bulk may lose a support that straddled a wall; they stay where they were poured.
std::vector<Vec3> fit_pour(const Container& container, std::vector<Vec3> poured,
                           RandomStream& random, const StopAsked& stop) {
  const auto n_spheres = static_cast<std::uint32_t>(poured.size());
  const Boundary boundary(container);
  PourBed bed(container, n_spheres);
  std::vector<std::uint32_t> misfits;
  for (std::uint32_t sphere = 0; sphere < n_spheres; ++sphere) {
    if (clear_of_boundaries(boundary, poured[sphere])) {
      bed.add(poured[sphere]);
    } else {
      misfits.push_back(sphere);
    }
  }
  for (const std::uint32_t sphere : misfits) {
    throw_if_stopped(stop);
    poured[sphere] = pour_one(bed, sphere, random);
    bed.add(poured[sphere]);
  }
  return poured;
}

}  // namespace jostle::inline engine
