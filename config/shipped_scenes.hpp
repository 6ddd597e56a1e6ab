#pragma once

#include <span>
#include <string_view>

namespace jostle::inline config {

/// A scene of config/scenes, which the program carries.
struct ShippedScene {
  std::string_view name;  // "quickstart", "philippe-bideau-2001/fig2"
  std::string_view text;
};

/// All of them, by name.
std::span<const ShippedScene> shipped_scenes();

}  // namespace jostle::inline config
