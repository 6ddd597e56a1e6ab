#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "engine/bed/vec3.hpp"
#include "engine/fields.hpp"

// What holds the spheres. Lengths in diameters. Every container but the fully periodic one has a
// floor at z = 0 and an open top; every container's footprint lies in [0, width_x] x [0, width_y].
namespace jostle::inline engine {

inline constexpr double sphere_radius = 0.5;
inline constexpr double sphere_volume = 0.52359877559829887307710723054658;  // pi / 6

/// Least widths for which minimum images and walls are right: periodic sides must be wider than
/// 2 diameters (exclusive), walls and tubes at least 1 diameter.
inline constexpr double least_periodic_width = 2;
inline constexpr double least_walled_width = 1;
/// Widths, heights and diameters of a container, at most: diameters.
inline constexpr double widest_container = 10'000;
/// Spheres of a packing, at most.
inline constexpr std::uint32_t most_spheres = 10'000'000;

/// The widths of a box in scenes: one number, or two.
inline constexpr Range periodic_width_range = above(least_periodic_width, widest_container);
inline constexpr Range walled_width_range = between(least_walled_width, widest_container);
template <class Box>
constexpr NumberPair<Box> widths(double Box::*x, double Box::*y, Range range) {
  return {"width",
          x,
          y,
          Number{range},
          "Diameters: of both sides, or of x and y",
          "a number, or a list of two, diameters"};
}

/// Periodic sides (P.B.C. of Philippe & Bideau 2001). Coordinates in [0, width).
struct PeriodicBox {
  double width_x = 16, width_y = 16;
  bool operator==(const PeriodicBox&) const = default;

  static constexpr About about{.name = "periodic", .title = "Periodic sides"};
  static constexpr auto fields() {
    return std::tuple{widths(&PeriodicBox::width_x, &PeriodicBox::width_y, periodic_width_range)};
  }
};

/// Four impassable vertical planes (F.B.C. of Philippe & Bideau 2001). Centres in [1/2, width -
/// 1/2].
struct WalledBox {
  double width_x = 16, width_y = 16;
  bool operator==(const WalledBox&) const = default;

  static constexpr About about{.name = "walls", .title = "Four walls"};
  static constexpr auto fields() {
    return std::tuple{widths(&WalledBox::width_x, &WalledBox::width_y, walled_width_range)};
  }
};

/// A vertical tube whose axis stands at (diameter / 2, diameter / 2).
struct Cylinder {
  double diameter = 19;
  bool operator==(const Cylinder&) const = default;

  static constexpr About about{.name = "cylinder", .title = "A cylinder"};
  static constexpr auto fields() {
    return std::tuple{field("diameter", &Cylinder::diameter, Number{walled_width_range},
                            "Of a cylinder, in diameters of a sphere",
                            {.required = "a number, diameters of a sphere"})};
  }
};

/// Periodic in all three directions and without gravity: the hard-sphere fluid, for checking.
struct FullyPeriodicBox {
  double width_x = 10, width_y = 10, height = 10;
  bool operator==(const FullyPeriodicBox&) const = default;

  static constexpr About about{.name = "fully_periodic",
                               .title = "Periodic in all directions, without gravity"};
  static constexpr auto fields() {
    return std::tuple{
        widths(&FullyPeriodicBox::width_x, &FullyPeriodicBox::width_y, periodic_width_range),
        field("height", &FullyPeriodicBox::height, Number{periodic_width_range},
              "Diameters; fully_periodic only", {.required = "a number, diameters"})};
  }
};

using Container = std::variant<PeriodicBox, WalledBox, Cylinder, FullyPeriodicBox>;

/// What is wrong with the container's widths, naming the least width; nothing if they are right.
std::optional<std::string> width_fault(const Container& container);

/// Area of the floor, diameters squared.
double footprint_area(const Container& container);

/// Widths of the box around the footprint, diameters.
double width_x(const Container& container);
double width_y(const Container& container);

/// Whether there is a floor to fall on: in every container but the fully periodic one.
bool has_gravity(const Container& container);

}  // namespace jostle::inline engine
