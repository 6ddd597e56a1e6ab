#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "engine/bed/vec3.hpp"
#include "engine/fields.hpp"

// A container holds the spheres: it has periods, walls, a floor and an extent. A container is
// one of the structs below, and nothing else asks which: whatever is done at its sides follows from
// its shape (engine/bed/boundary.hpp). Lengths in diameters.
namespace jostle::inline engine {

inline constexpr double sphere_radius = 0.5;
inline constexpr double sphere_volume = 0.52359877559829887307710723054658;  // pi / 6

/// How a container ends along x, y and z. Its footprint is [0, x] x [0, y] of its extent.
struct ContainerShape {
  bool periodic_x = false, periodic_y = false;  // else a vertical plane at either end, or the tube
  bool periodic_z = false;  // else a floor at z = 0 under an open top; then there is gravity
  bool tube = false;        // the side is the inside of a vertical tube

  constexpr bool has_floor() const { return !periodic_z; }
  constexpr bool planes_x() const { return !periodic_x && !tube; }
  constexpr bool planes_y() const { return !periodic_y && !tube; }
  constexpr bool has_walls() const { return !(periodic_x && periodic_y); }
};

/// Least widths for which minimum images and walls are right: periodic sides must be wider than
/// 2 diameters (exclusive), walls and tubes at least 1 diameter.
inline constexpr double least_periodic_width = 2;
inline constexpr double least_walled_width = 1;
/// Widths, heights and diameters of a container, at most: diameters.
inline constexpr double widest_container = 10'000;
/// Faces of a container, at most: the floor and the sides.
inline constexpr std::size_t most_faces = 5;
/// Spheres of a packing, at most.
inline constexpr std::uint32_t most_spheres = 10'000'000;

/// The widths of a box in scenes: one number, or two.
inline constexpr Range periodic_width_range =
    left_open_range(least_periodic_width, widest_container);
inline constexpr Range walled_width_range = closed_range(least_walled_width, widest_container);
template <class Box>
constexpr NumberPair<Box> widths(double Box::*x, double Box::*y, Range range) {
  return {"width",
          x,
          y,
          Number{range},
          "Diameters: of both sides, or of x and y",
          "a number, or a list of two, diameters"};
}

// Each container gives what scenes and captions call it and its fields there, its shape, its extent
// along x, y and z (0 under an open top), and itself from an extent.

/// Periodic sides (P.B.C. of Philippe & Bideau 2001). Coordinates in [0, width).
struct PeriodicBox {
  double width_x = 16, width_y = 16;

  static constexpr ContainerShape shape() { return {.periodic_x = true, .periodic_y = true}; }
  Vec3 extent() const { return {width_x, width_y, 0}; }
  static PeriodicBox with_extent(Vec3 extent) { return {extent.x, extent.y}; }
  bool operator==(const PeriodicBox&) const = default;

  static constexpr Description description{.name = "periodic", .title = "Periodic sides"};
  template <class Self = PeriodicBox>
  static constexpr auto fields() {
    return std::tuple{widths(&Self::width_x, &Self::width_y, periodic_width_range)};
  }
};

/// Four impassable vertical planes (F.B.C. of Philippe & Bideau 2001). Centres in [1/2, width -
/// 1/2].
struct WalledBox {
  double width_x = 16, width_y = 16;

  static constexpr ContainerShape shape() { return {}; }
  Vec3 extent() const { return {width_x, width_y, 0}; }
  static WalledBox with_extent(Vec3 extent) { return {extent.x, extent.y}; }
  bool operator==(const WalledBox&) const = default;

  static constexpr Description description{
      .name = "walls", .text = "four vertical planes", .title = "Four walls"};
  template <class Self = WalledBox>
  static constexpr auto fields() {
    return std::tuple{widths(&Self::width_x, &Self::width_y, walled_width_range)};
  }
};

/// A vertical tube whose axis is at (diameter / 2, diameter / 2).
struct Cylinder {
  double diameter = 19;

  static constexpr ContainerShape shape() { return {.tube = true}; }
  Vec3 extent() const { return {diameter, diameter, 0}; }
  static Cylinder with_extent(Vec3 extent) { return {extent.x}; }
  bool operator==(const Cylinder&) const = default;

  static constexpr Description description{
      .name = "cylinder", .text = "a tube", .title = "A cylinder"};
  template <class Self = Cylinder>
  static constexpr auto fields() {
    return std::tuple{field("diameter", &Self::diameter, Number{walled_width_range},
                            "Diameter of a cylinder, in diameters of a sphere",
                            {.required = "a number, diameters of a sphere"})};
  }
};

/// Periodic in all three directions and without gravity: the hard-sphere fluid, for checking.
struct FullyPeriodicBox {
  double width_x = 10, width_y = 10, height = 10;

  static constexpr ContainerShape shape() {
    return {.periodic_x = true, .periodic_y = true, .periodic_z = true};
  }
  Vec3 extent() const { return {width_x, width_y, height}; }
  static FullyPeriodicBox with_extent(Vec3 extent) { return {extent.x, extent.y, extent.z}; }
  bool operator==(const FullyPeriodicBox&) const = default;

  static constexpr Description description{
      .name = "fully_periodic",
      .text = "periodic in z too and without gravity (the hard-sphere fluid)",
      .title = "A fully periodic box"};
  template <class Self = FullyPeriodicBox>
  static constexpr auto fields() {
    return std::tuple{widths(&Self::width_x, &Self::width_y, periodic_width_range),
                      field("height", &Self::height, Number{periodic_width_range},
                            "Diameters; fully_periodic only", {.required = "a number, diameters"})};
  }
};

/// A Hele-Shaw cell: periodic along x, between two vertical plates across y. Centres in [0, width)
/// and [1/2, gap - 1/2].
struct Plates {
  double width = 16, gap = 4;

  static constexpr ContainerShape shape() { return {.periodic_x = true}; }
  Vec3 extent() const { return {width, gap, 0}; }
  static Plates with_extent(Vec3 extent) { return {extent.x, extent.y}; }
  bool operator==(const Plates&) const = default;

  static constexpr Description description{
      .name = "plates", .text = "periodic along x, two plates across y", .title = "Two plates"};
  template <class Self = Plates>
  static constexpr auto fields() {
    return std::tuple{
        field("width", &Self::width, Number{periodic_width_range}, "Diameters: the period along x",
              {.required = "a number, diameters"}),
        field("gap", &Self::gap, Number{walled_width_range},
              "Diameters between the plates; plates only", {.required = "a number, diameters"})};
  }
};

using Container = std::variant<PeriodicBox, WalledBox, Cylinder, FullyPeriodicBox, Plates>;

/// "walls": what scenes and files call it.
std::string name_of(const Container& container);
/// Those of all containers, in the order of the variant.
std::vector<std::string> container_names();
/// The container of that name with these widths along x, y, z; nothing if there is none.
std::optional<Container> container_of(std::string_view name, Vec3 extent);

/// Describes a fault of the container's widths, with the least width; nothing if they are valid.
std::optional<std::string> width_fault(const Container& container);

/// Area of the footprint, diameters squared.
double footprint_area(const Container& container);

/// Widths of the box around the footprint, and its height: 0 under an open top. Diameters.
Vec3 extent(const Container& container);
double width_x(const Container& container);
double width_y(const Container& container);

/// True if one width gives both sides of the footprint: of a tube.
bool has_one_width(const Container& container);

/// True if there is a floor to fall on: in every container but the fully periodic one.
bool has_gravity(const Container& container);

}  // namespace jostle::inline engine
