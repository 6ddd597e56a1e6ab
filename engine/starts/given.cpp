#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "engine/bed/boundary.hpp"
#include "engine/starts/parts.hpp"

namespace jostle::inline engine {

namespace {

std::string in_diameters(double depth) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g", depth);
  return std::string(text) + " diameters";
}

[[noreturn]] void refuse(const std::string& reason) {
  throw StartError("given packing: " + reason);
}

void check_overlaps(const Packing& packing, double most_overlap) {
  const Overlap worst = deepest_overlap(packing);
  if (worst.depth <= std::max(overlap_bound(packing), most_overlap)) return;
  const std::string partner = worst.second < 0 ? "the floor or a side of the container"
                                               : "sphere " + std::to_string(worst.second);
  const std::string hint =
      most_overlap > 0 ? "; \"overlap\" allows " + in_diameters(most_overlap)
                       : "; packings of discrete elements overlap: set \"overlap\" to the depth";
  refuse("sphere " + std::to_string(worst.first) + " overlaps " + partner + " by " +
         in_diameters(worst.depth) +
         ", the deepest overlap of the packing; check that its lengths are in diameters and that "
         "it was made in this container, and that no digits were dropped when it was written" +
         hint);
}

}  // namespace

std::optional<std::string> GivenPacking::container_fault(const Container&) const {
  return std::nullopt;
}

std::vector<Vec3> GivenPacking::place(const Placing& placing) const {
  const StartSpheres& spheres = placing.spheres;
  if (centres == nullptr) refuse("it holds no centres; read them from a file first");
  if (centres->size() != spheres.n) {
    refuse("it holds " + std::to_string(centres->size()) + " spheres where " +
           std::to_string(spheres.n) + " are asked for; ask for as many as it holds");
  }
  const bool same_sizes =
      sizes == spheres.sizes || (sizes && spheres.sizes && *sizes == *spheres.sizes);
  if (!same_sizes) refuse("it holds spheres of other sizes than those asked for");
  // Far outside the container a coordinate is no rounding: refused here, before any neighbours are
  // sought.
  constexpr double far_outside = 1;
  const Boundary boundary(placing.container);
  Packing packing{placing.container, {}, spheres.sizes};
  packing.centres.reserve(spheres.n);
  for (const Vec3& centre : *centres) {
    const std::string name = "sphere " + std::to_string(packing.centres.size());
    if (!std::isfinite(centre.x) || !std::isfinite(centre.y) || !std::isfinite(centre.z)) {
      refuse(name + " has a coordinate that is not a finite number; correct the file");
    }
    const Vec3 r = into_periods(boundary, centre);
    if (r.z < -far_outside || r.x < -far_outside || r.y < -far_outside ||
        r.x > boundary.width_x + far_outside || r.y > boundary.width_y + far_outside) {
      refuse(name + " lies outside the container; check that its lengths are in diameters and " +
             "that it was made in this container");
    }
    packing.centres.push_back(r);
  }
  check_overlaps(packing, most_overlap);
  return packing.centres;
}

}  // namespace jostle::inline engine
