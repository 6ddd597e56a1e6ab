#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/bed/boundary.hpp"
#include "engine/bed/cells/sphere_cells.hpp"
#include "engine/bed/sizes.hpp"
#include "engine/discrete_element/kernel/grain_rows.hpp"

namespace jostle::inline engine {

inline Vec3 centre_of(const SphereRow& sphere) {
  return {sphere.x, sphere.y, sphere.z};
}
inline Vec3 velocity_of(const SphereRow& sphere) {
  return {sphere.velocity_x, sphere.velocity_y, sphere.velocity_z};
}

/// History of a contact for a law.
using ContactHistory = std::array<double, most_history>;

/// Two spheres that touch, by their numbers, the lower first; `turns`: periods in x and y from the
/// first to the second as it is met.
struct KeptPair {
  std::uint32_t first = 0, second = 0;
  std::array<std::int32_t, 2> turns{};
  ContactHistory history{};
};

/// A sphere that touches a side: 0 the floor, 1 to 4 the planes x = 0, x = width, y = 0, y = width,
/// 1 the tube.
struct KeptSide {
  std::uint32_t sphere = 0, side = 0;
  ContactHistory history{};
};

/// Pairs of spheres that may touch, with their histories. Far pairs, of all that come within
/// `far_skin`, are found now and then; near ones, of them, whenever spheres have moved by half of
/// `near_skin` against each other. Skins are in diameters of the smallest sphere. A sphere sums its
/// contacts in the order of their numbers, so that no result depends on when lists are made or on
/// how spheres are sorted.
class ContactLists {
 public:
  static constexpr double far_skin = 0.25, near_skin = 0.03, side_skin = 0.1;

  ContactLists(const Container& container, int n_history,
               std::shared_ptr<const Sizes> sizes = nullptr);

  /// The diameter of the smallest sphere.
  double skin_unit() const { return skin_unit_; }

  /// Everything anew, of the spheres at `rows` with these numbers. Histories stay.
  void find_far(std::span<const SphereRow> rows, std::span<const std::uint32_t> numbers);
  /// Near pairs and sides, of the spheres at `rows`; the floor at `floor_height`.
  void find_near(std::span<const SphereRow> rows, double floor_height);

  /// Replaces all that is remembered, before anything is found.
  void keep(std::vector<KeptPair> pairs, std::vector<KeptSide> sides);
  /// Histories, in the order of the spheres.
  std::vector<KeptPair> kept_pairs() const;
  std::vector<KeptSide> kept_sides() const;
  /// All that are near, remembered or not.
  std::vector<KeptPair> near_pairs() const;
  std::vector<KeptSide> near_sides() const;
  const Faces& faces() const { return faces_; }

  ContactArrays pairs();
  /// Those with the floor, and with the sides.
  ContactArrays floor();
  ContactArrays sides();
  /// KeptSide::side of each entry of sides().
  std::span<const std::uint32_t> side_numbers() const { return sides_.source; }
  /// Writes normals and distances of the sides.
  void measure_sides(std::span<const SphereRow> rows, double floor_height);

  std::span<const std::uint32_t> begin() const { return begin_; }
  std::span<const std::uint32_t> slots() const { return slots_; }
  const ActionRow* action() const { return action_.data(); }
  /// Upward forces of the contacts with the floor, summed in the order of the spheres.
  double floor_force() const;
  /// Contains 0 for every sphere on which nothing acts in this step; null unless nearly all pairs
  /// are idle.
  const std::uint8_t* acted_upon();
  std::size_t n_near() const { return near_.n; }
  std::size_t bytes() const;
  /// The greatest overlap since it was last set.
  double deepest() const { return deepest_; }
  void set_deepest(double overlap) { deepest_ = overlap; }

 private:
  /// Spheres within a factor of two in size, in cells of their own.
  struct SizeClass {
    double largest_radius = 0;
    std::vector<std::uint32_t> places;
    SphereCells cells;
  };
  struct FarPair {
    std::uint32_t first, second;  // places; the one with the lower number first
    std::array<std::int32_t, 2> turns;
  };
  struct FarSlot {
    std::uint32_t pair, second;  // second: 1 where the sphere is the pair's second
  };
  /// Contacts that may be, in whole blocks.
  struct Near {
    std::size_t n = 0;  // without those that fill the last block
    std::vector<std::uint32_t> first, second,
        source;  // source: of pairs the far pair, else the side
    std::array<CacheLines<double>, 2> shift;
    std::array<CacheLines<double>, 4> side;
    std::array<CacheLines<double>, n_contact_sizes> size;  // empty of equal spheres
    std::array<CacheLines<double>, most_history> history;
  };

  void find_far_pairs(std::span<const SphereRow> rows);
  std::vector<SizeClass> size_classes(double top) const;
  void make_far_slots();
  void find_pairs(std::span<const SphereRow> rows);
  void carry_pairs(const Near& old, std::span<const std::uint32_t> old_near_of);
  ContactHistory history_of(const Near& near, std::size_t index) const;
  void find_sides(std::span<const SphereRow> rows, double floor_height);
  void carry_sides(Near& sides, const std::vector<KeptSide>& kept) const;
  void make_slots();
  bool mostly_idle() const;
  void add_sides(const Near& near, std::vector<KeptSide>& kept) const;
  ContactArrays arrays(Near& near, std::size_t action_at);
  void fill(Near& near, std::size_t n) const;
  double radius_at(std::uint32_t place) const {
    return radii_.empty() ? sphere_radius : radii_[place];
  }
  double touching(const FarPair& pair) const {
    return radii_.empty() ? 1 : radii_[pair.first] + radii_[pair.second];
  }
  void measure_sizes(Near& pairs) const;
  void measure_side_sizes(Near& sides) const;

  Boundary boundary_;
  Faces faces_;  // faces, one of which a contact with a side names
  Container container_;
  int n_history_;
  std::shared_ptr<const Sizes> sizes_;  // null: equal spheres
  double skin_unit_ = 1;
  std::uint32_t n_spheres_ = 0;
  std::vector<double> radii_;  // radii of the spheres at each place; empty for equal spheres
  std::vector<std::uint32_t> numbers_;  // numbers of the spheres at each place
  std::vector<FarPair> far_;
  std::vector<std::uint32_t> far_begin_;  // [n_spheres + 1], of far_slots_
  std::vector<FarSlot> far_slots_;        // far slots of a sphere, in the order of their numbers
  std::vector<std::uint32_t> near_of_;    // [far pairs], or none
  Near near_, floor_, sides_;
  std::vector<KeptPair> waiting_pairs_;  // to be found among the next far pairs
  std::vector<KeptSide> waiting_sides_;
  std::vector<std::uint32_t> begin_, slots_;
  std::vector<ActionRow> action_;
  std::vector<std::uint8_t> idle_;  // idle flag of each action, in the form of ContactArrays
  std::size_t first_idle_ = 0;      // near pairs from here on neither touch nor did a step ago
  std::vector<std::uint8_t> acted_upon_;  // [n_spheres + 2]
  double deepest_ = 0;
};

}  // namespace jostle::inline engine
