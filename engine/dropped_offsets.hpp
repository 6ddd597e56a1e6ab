#pragma once

#include "engine/column.hpp"

namespace jostle::inline engine {

/// Column of every engine for a shake: the lateral offsets per sphere that found no room.
inline Column dropped_offsets_column() {
  return {.name = "dropped_offsets",
          .units = "1",
          .long_name = "lateral offsets of the tap that found no room / number of spheres",
          .source = "jostle",
          .shown = Shown::share,
          .if_any = "shakes dropped {} of their lateral offsets for want of room"};
}

}  // namespace jostle::inline engine
