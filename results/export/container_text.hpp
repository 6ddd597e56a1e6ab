#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "engine/bed/container.hpp"

// A container as a word and three widths, as results files and extended XYZ name it.
namespace jostle::inline results {

struct ContainerText {
  std::string kind;                // "periodic", "walls", "cylinder" or "fully_periodic"
  std::array<double, 3> widths{};  // along x, y, z; z is 0 where the top is open
};

ContainerText container_text(const Container& container);
/// Nothing if there is no such kind.
std::optional<Container> container_from(std::string_view kind, const std::array<double, 3>& widths);

}  // namespace jostle::inline results
