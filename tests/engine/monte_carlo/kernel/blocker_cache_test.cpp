#include "engine/monte_carlo/kernel/blocker_cache.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "engine/bed/geometry.hpp"
#include "engine/bed/random.hpp"

using namespace jostle;

namespace {

Vec3 random_direction(RandomStream& random) {
  for (;;) {
    const Vec3 v{2 * random.uniform() - 1, 2 * random.uniform() - 1, 2 * random.uniform() - 1};
    const double squared = norm_squared(v);
    if (squared > 0.01 && squared <= 1) return 1 / std::sqrt(squared) * v;
  }
}

// A step of a length up to `longest`; the shorter the likelier.
Vec3 random_step(double longest, RandomStream& random) {
  return longest * random.uniform() * random.uniform() * random_direction(random);
}

bool rejects(const SizedBlockerCache& cache, Vec3 step) {
  return certainly_rejects<PeriodicBox>(cache, static_cast<float>(step.x),
                                        static_cast<float>(step.y), static_cast<float>(step.z));
}

struct Counts {
  int rejected = 0, overlapping = 0, near_contact = 0;
};

// One sphere and its blocker, and steps of which half end near contact.
Counts check_pairs(double smallest, double ratio, double longest, int trials) {
  const FullyPeriodicBox container{60, 70, 80};
  const PackedBox<FullyPeriodicBox, SeveralSizes> box(container);
  RandomStream random(stream_key(61, 0, 0, Purpose::trials));
  Counts counts;
  for (int trial = 0; trial < trials; ++trial) {
    const auto radius = [&] { return 0.5 * smallest * std::pow(ratio, random.uniform()); };
    const Vec3 r{60 * random.uniform(), 70 * random.uniform(), 80 * random.uniform()};
    const PackedCentre start = packed_sphere(r, radius());
    const double other_radius = radius(), touching = start.radius + other_radius;
    const Vec3 step = random_step(longest, random);
    const Vec3 target = wrapped(container, r + step);
    const Vec3 direction = random_direction(random);
    const bool near_contact = trial % 2 == 0;
    // To within a few times the margin of the cache.
    const double reach = touching + longest, narrow = 2e-5 * reach * reach / touching;
    const double gap = near_contact ? narrow * (random.uniform() - 0.5) * random.uniform()
                                    : longest * random.uniform();
    // Near contact the blocker is placed from where the step ends, else from where it begins.
    const Vec3 origin = near_contact ? target : r;
    const Vec3 b = wrapped(container, origin + (touching + gap) * direction);
    if (overlaps(container, r, b, touching)) continue;
    const PackedCentre end = packed_sphere(b, other_radius);
    SizedBlockerCache cache;
    cache.see(box, start, end, trial % 4, longest);
    const bool is_rejected = rejects(cache, step);
    const double squared = norm_squared(separation(container, target, b));
    const bool overlapping = squared < touching * touching;
    if (is_rejected) REQUIRE(overlapping);
    // The margin is a few millionths of the squares of what the test adds up.
    const double scale = norm_squared(separation(container, b, r)) + longest * longest;
    if (squared < touching * touching - 5e-6 * scale) REQUIRE(is_rejected);
    counts.rejected += is_rejected;
    counts.overlapping += overlapping;
    counts.near_contact += near_contact;
  }
  return counts;
}

// One sphere near floor and sides.
template <class Box>
void check_faces(const Box& container, double smallest, double ratio, double longest, int trials) {
  const PackedBox<Box, SeveralSizes> box(container);
  RandomStream random(stream_key(62, 0, 0, Purpose::trials));
  int rejected = 0, leaving = 0, on_floor = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const double radius = 0.5 * smallest * std::pow(ratio, random.uniform());
    const Vec3 extent = container.extent();
    const auto across = [&](double w) { return radius + (w - 2 * radius) * random.uniform(); };
    Vec3 r{across(extent.x), across(extent.y), radius + 2 * longest * random.uniform()};
    if (trial % 3 == 0) r.x = radius + longest * random.uniform() * random.uniform();
    if (!clear_of_boundaries(container, r, radius)) continue;
    SizedBlockerCache cache;
    cache.see_faces(box, packed_sphere(r, radius), longest);
    Vec3 step = random_step(longest, random);
    if (trial % 5 == 0) step.z = radius - r.z + 1e-6 * (random.uniform() - 0.5);  // to the floor
    if (norm_squared(step) > longest * longest) continue;
    const bool is_rejected = rejects(cache, step);
    const Vec3 target = wrapped(container, r + step);
    const bool clear = clear_of_boundaries(container, target, radius);
    if (is_rejected) REQUIRE_FALSE(clear);
    if (target.z < radius - 5e-6 * longest) on_floor += is_rejected;
    rejected += is_rejected;
    leaving += !clear;
  }
  CHECK(leaving > trials / 100);
  CHECK(rejected > leaving / 4);
  CHECK(on_floor > leaving / 20);
}

void check_ratio(double ratio, int trials) {
  for (const double smallest : {0.2, 1.0, 10 / ratio}) {
    for (const double longest : {0.05, 0.3, 2 * smallest}) {
      CAPTURE(ratio, smallest, longest);
      const Counts counts = check_pairs(smallest, ratio, longest, trials);
      CHECK(counts.near_contact > trials / 10);
      CHECK(counts.overlapping > trials / 20);
      CHECK(counts.rejected > counts.overlapping / 2);
      const double largest = smallest * ratio, width = 1.1 * largest + 4 * longest;
      check_faces(WalledBox{width, width + 1}, smallest, ratio, longest, trials / 4);
      check_faces(Cylinder{1.5 * width}, smallest, ratio, longest, trials / 4);
      check_faces(PeriodicBox{2 * width, 2 * width}, smallest, ratio, longest, trials / 4);
    }
  }
}

}  // namespace

TEST_CASE("no cache line of several sizes rejects what double precision accepts") {
  for (const double ratio : {1.0, 1.4, 3.0, 10.0}) check_ratio(ratio, 20'000);
}

TEST_CASE("no cache line of several sizes rejects wrongly, a million pairs per ratio", "[slow]") {
  for (const double ratio : {1.4, 3.0, 10.0}) check_ratio(ratio, 120'000);
}

TEST_CASE("a face takes the last lane of a cache of several sizes, where a step can reach it") {
  const PackedBox<WalledBox, SeveralSizes> box(WalledBox{8, 8});
  const auto shown = [&](Vec3 r) {
    SizedBlockerCache cache;
    cache.see_faces(box, packed_sphere(r, 1.5), 0.2);
    return cache.shown();
  };
  CHECK(shown({4, 4, 1.5}) == 3);
  CHECK(shown({4, 4, 1.69}) == 3);
  CHECK(shown({4, 4, 1.71}) == 4);
  CHECK(shown({1.6, 4, 5}) == 3);
  CHECK(shown({4, 6.45, 5}) == 3);
  CHECK(shown({4, 6.2, 5}) == 4);
}
