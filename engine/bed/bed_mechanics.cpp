#include "engine/bed/bed_mechanics.hpp"

#include "engine/bed/boundary.hpp"

namespace jostle::inline engine {

std::vector<std::string> wall_names(const Container& container) {
  std::vector<std::string> names;
  for (const Face& face : Faces(Boundary(container))) names.emplace_back(face.name);
  return names;
}

}  // namespace jostle::inline engine
