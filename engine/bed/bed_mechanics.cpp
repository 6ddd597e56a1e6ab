#include "engine/bed/bed_mechanics.hpp"

#include "engine/bed/boundary.hpp"

namespace jostle::inline engine {

std::vector<std::string> wall_names(const Container& container) {
  const Boundary boundary(container);
  std::vector<std::string> names;
  if (boundary.floor) names.emplace_back("floor");
  if (boundary.sides == Sides::walls)
    for (const char* plane : {"x_min", "x_max", "y_min", "y_max"}) names.emplace_back(plane);
  if (boundary.sides == Sides::cylinder) names.emplace_back("tube");
  return names;
}

}  // namespace jostle::inline engine
