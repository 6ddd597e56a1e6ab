#include "engine/monte_carlo/kernel/shields.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/engine/sample_packings.hpp"

using namespace jostle;

namespace {

std::vector<Container> containers() {
  return {PeriodicBox{4.2, 3.1}, WalledBox{4, 3.5}, Cylinder{4.4}, FullyPeriodicBox{4, 3.4, 4.6}};
}

// Every lane shows where its sphere stands, the rest nothing.
template <class Box>
void check_lanes(const PackedBox<Box>& box, const PackedCentres& centres,
                 const NeighbourLists& lists, const Shields<Box>& shields) {
  for (std::uint32_t i = 0; i < centres.size(); ++i) {
    const Shield& shield = shields.data()[i];
    const auto* row = lists.row(i);
    for (std::uint32_t lane = 0; lane < Shield::size; ++lane) {
      if (lane >= row[0]) {
        REQUIRE(shield.x[lane] == Shield::far);
        continue;
      }
      const PackedCentre& other = centres[row[1 + lane]];
      const Pair away = box.lateral(other.xy - centres[i].xy);
      REQUIRE(shield.x[lane] == static_cast<float>(away[0]));
      REQUIRE(shield.y[lane] == static_cast<float>(away[1]));
      REQUIRE(shield.z[lane] == static_cast<float>(box.vertical(other.z - centres[i].z)));
    }
  }
}

// Whether a step is refused, by all spheres and in double precision.
template <class Box>
bool refused(const Box& box, const PackedCentres& centres, std::uint32_t i, Vec3 step) {
  const Vec3 target = wrapped(box, unpacked(centres[i]) + step);
  if (!clear_of_boundaries(box, target)) return true;
  for (std::uint32_t j = 0; j < centres.size(); ++j) {
    if (j != i && overlaps(box, target, unpacked(centres[j]))) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("shields follow their spheres, and refuse nothing that is free") {
  for (const Container& container : containers()) {
    CAPTURE(container.index());
    const Packing packing = random_packing(container, 24, 5, 31);
    std::visit(
        [&](const auto& box) {
          using Box = std::decay_t<decltype(box)>;
          constexpr double skin = 0.5, longest = 0.4;
          constexpr Vec3 drift{0, 0, -0.1};
          const PackedBox<Box> packed_box(box);
          PackedCentres centres;
          for (const Vec3& r : packing.centres) centres.push_back(packed(r));
          NeighbourLists lists;
          lists.build(box, centres, skin, drift);
          Shields<Box> shields;
          shields.build(packed_box, centres, lists);
          RandomStream random(stream_key(32, 0, 0, Purpose::trials));
          int moved = 0, renewed = 0, shut = 0, promoted = 0;
          for (int trial = 0; trial < 40'000; ++trial) {
            const auto i = static_cast<std::uint32_t>(random.below(centres.size()));
            const auto part = [&] { return longest * (2 * random.uniform() - 1); };
            const Vec3 step{part(), part(), part()};
            const bool is_refused = refused(box, centres, i, step);
            if (shuts<Box>(shields.data()[i], static_cast<float>(step.x),
                           static_cast<float>(step.y), static_cast<float>(step.z))) {
              REQUIRE(is_refused);
              ++shut;
            }
            if (is_refused) {
              const auto length = lists.row(i)[0];
              if (length > Shield::size && trial % 3 == 0) {
                const auto place = Shield::size + random.below(length - Shield::size);
                shields.promote(packed_box, centres, lists, i, static_cast<std::uint32_t>(place));
                ++promoted;
              }
            } else {
              const PackedCentre target = packed(wrapped(box, unpacked(centres[i]) + step));
              if (distance_squared(packed_box, target, lists.origins()[i]) >
                  lists.half_skin_squared()) {
                shields.before_renewal(lists, i);
                ++renewed;
                if (lists.renew(box, i, centres[i])) {
                  shields.after_renewal(packed_box, centres, lists);
                } else {
                  lists.build(box, centres, skin, drift);
                  shields.build(packed_box, centres, lists);
                }
              }
              centres[i] = target;
              shields.follow(packed_box, centres, lists, i);
              ++moved;
            }
            if (trial % 50 == 0) check_lanes(packed_box, centres, lists, shields);
          }
          CHECK(moved > 1000);
          CHECK(renewed > 100);
          CHECK(shut > 1000);
          CHECK(promoted > 100);
        },
        container);
  }
}

TEST_CASE("shields refuse steps through floor and sides to within their margin") {
  for (const Container& container : containers()) {
    CAPTURE(container.index());
    std::visit(
        [&](const auto& box) {
          using Box = std::decay_t<decltype(box)>;
          const PackedBox<Box> packed_box(box);
          RandomStream random(stream_key(33, 0, 0, Purpose::trials));
          for (int trial = 0; trial < 20'000; ++trial) {
            const Vec3 r{width_x(container) * random.uniform(),
                         width_y(container) * random.uniform(), 0.5 + 3 * random.uniform()};
            if (!clear_of_boundaries(box, r)) continue;
            const auto part = [&] { return 2 * random.uniform() - 1; };
            const Vec3 step{part(), part(), part()};
            const bool leaves =
                PackedBox<Box>::leaves(packed_box.room(packed(r)), static_cast<float>(step.x),
                                       static_cast<float>(step.y), static_cast<float>(step.z));
            if (leaves) REQUIRE_FALSE(clear_of_boundaries(box, wrapped(box, r + step)));
            // A step that ends well outside is seen, but for a tube's far side of a chord.
            if (std::holds_alternative<Cylinder>(container)) continue;
            const Vec3 nearer = wrapped(box, r + 0.9999 * step);
            if (!clear_of_boundaries(box, nearer)) REQUIRE(leaves);
          }
        },
        container);
  }
}
