#include "structure/density/profiles.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "engine/bed/slab.hpp"
#include "tests/structure/density/profile_samples.hpp"
#include "tests/structure/reference_deposit.hpp"

using namespace jostle;

namespace {

constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();

// Within 3 standard errors: chi-squared of n bins against n.
void check_misfit(double misfit, std::size_t n_bins) {
  const auto n = static_cast<double>(n_bins);
  CHECK(std::abs(misfit - n) <= 3 * std::sqrt(2 * n));
}

double sum_between(const Packing& packing, HeightWindow window) {
  double volume = 0;
  for (const Vec3& centre : packing.centres) {
    volume += sphere_volume_in_slab(centre.z, window.low, window.high);
  }
  return volume;
}

HeightWindow whole(const Packing& packing) {
  return {0, top_height(packing) + sphere_radius};
}

// The volume of spheres in all bins.
double solid_volume(const Profile& profile) {
  double volume = 0;
  for (std::size_t k = 0; k < profile.size(); ++k) volume += profile.volumes[k] * profile.values[k];
  return volume;
}

}  // namespace

TEST_CASE("Bins of profiles hold all that is solid") {
  // Approx: the error of the sums is rounding.
  const Packing periodic = poured(PeriodicBox{5, 5}, 300, 1);
  const Packing walled = poured(WalledBox{5, 6}, 300, 2);
  const Packing tube = poured(Cylinder{6}, 250, 3);
  for (const double width : {0.013, 0.1, 0.37, 1.0, 4.0}) {
    CAPTURE(width);
    for (const Packing* packing : {&periodic, &walled, &tube}) {
      const Profile profile = vertical_profile(*packing, height_edges(*packing, width));
      const double solids = static_cast<double>(packing->centres.size()) * sphere_volume;
      CHECK(solid_volume(profile) == Approx(solids).epsilon(1e-12));
      CHECK(std::accumulate(profile.volumes.begin(), profile.volumes.end(), 0.0) ==
            Approx(footprint_area(packing->container) * profile.edges.back()).epsilon(1e-12));
    }
    const auto edges = even_edges(0, 5, width);
    for (const bool is_whole : {true, false}) {
      for (const Axis axis : {Axis::x, Axis::y}) {
        const HeightWindow window = is_whole ? whole(periodic) : transverse_window(periodic);
        CHECK(solid_volume(transverse_profile(periodic, axis, edges, window)) ==
              Approx(sum_between(periodic, window)).epsilon(1e-12));
      }
      const HeightWindow window = is_whole ? whole(walled) : HeightWindow{1.1, 4.3};
      CHECK(solid_volume(transverse_profile(walled, Axis::x, edges, window)) ==
            Approx(sum_between(walled, window)).epsilon(1e-12));
      CHECK(solid_volume(wall_profile(walled, even_edges(0, 2.5, width), window)) ==
            Approx(sum_between(walled, window)).epsilon(1e-12));
      const HeightWindow in_tube = is_whole ? whole(tube) : HeightWindow{1.1, 4.3};
      CHECK(solid_volume(radial_profile(tube, even_edges(0, 3, width), in_tube)) ==
            Approx(sum_between(tube, in_tube)).epsilon(1e-12));
    }
  }
}

TEST_CASE("The profile of the reference deposit has the fractions its maker measured") {
  const Packing deposit = reference_deposit();
  const auto reference = reference_measurements();
  const double low = reference.at("zwin").at(0).get<double>() * sphere_radius;
  const double high = reference.at("zwin").at(1).get<double>() * sphere_radius;
  const double edges[] = {0, 2, low, high};
  const Profile profile = vertical_profile(deposit, edges);
  // Margins: half a unit of the last digit printed.
  CHECK(profile.values[0] ==
        Approx(reference.at("phi_b_0_4R").get<double>()).margin(0.5e-5).epsilon(0));
  CHECK(profile.values[2] ==
        Approx(reference.at("phi_bulk").get<double>()).margin(0.5e-5).epsilon(0));
  // Equal to the slabs of the engine, bin by bin.
  const Profile fine = vertical_profile(deposit, height_edges(deposit, 0.1));
  for (std::size_t k = 0; k < fine.size(); ++k) {
    CHECK(fine.values[k] ==
          Approx(solids_fraction(deposit, {fine.edges[k], fine.edges[k + 1]})).margin(1e-12));
  }
  // Philippe & Bideau's transverse window, 4 R to 0.8 x 2<Z>, in R.
  const HeightWindow window = transverse_window(deposit);
  CHECK(window.low == 4 * sphere_radius);
  CHECK(window.high / sphere_radius ==
        Approx(1.6 * reference.at("mean_z_over_R").get<double>()).margin(1e-4).epsilon(0));
}

TEST_CASE("Profiles are what random points find") {
  const int points = 300'000;
  SECTION("vertical") {
    const Packing packing = poured(PeriodicBox{5, 5}, 200, 4);
    const Profile profile = vertical_profile(packing, even_edges(0, 4, 0.23));
    const double misfit = misfit_by_sampling(
        packing, profile, {0, 4}, [](Vec3 r) { return r.z; }, points);
    check_misfit(misfit, profile.size());
  }
  SECTION("along x and y, through the seams of periodic sides") {
    const Packing packing = poured(PeriodicBox{4.7, 5.3}, 200, 5);
    const HeightWindow window{0.8, 4.1};
    const Profile along_x = transverse_profile(packing, Axis::x, even_edges(0, 4.7, 0.3), window);
    check_misfit(misfit_by_sampling(
                     packing, along_x, window, [](Vec3 r) { return r.x; }, points),
                 along_x.size());
    const Profile along_y = transverse_profile(packing, Axis::y, even_edges(0, 5.3, 0.3), window);
    check_misfit(misfit_by_sampling(
                     packing, along_y, window, [](Vec3 r) { return r.y; }, points),
                 along_y.size());
  }
  SECTION("against the distance to the nearest wall") {
    const Packing packing = poured(WalledBox{5, 6}, 200, 6);
    const HeightWindow window{0.8, 4.1};
    const Profile profile = wall_profile(packing, even_edges(0, 2.5, 0.15), window);
    const auto distance = [](Vec3 r) { return std::min({r.x, 5 - r.x, r.y, 6 - r.y}); };
    check_misfit(misfit_by_sampling(packing, profile, window, distance, points), profile.size());
  }
  SECTION("between plates, also near them") {
    const Packing packing = poured(Plates{6, 4}, 180, 8);
    const HeightWindow window{0.8, 4.1};
    const Profile along_x = transverse_profile(packing, Axis::x, even_edges(0, 6, 0.3), window);
    check_misfit(misfit_by_sampling(
                     packing, along_x, window, [](Vec3 r) { return r.x; }, points),
                 along_x.size());
    const Profile along_y = transverse_profile(packing, Axis::y, even_edges(0, 4, 0.25), window);
    check_misfit(misfit_by_sampling(
                     packing, along_y, window, [](Vec3 r) { return r.y; }, points),
                 along_y.size());
    // Their distance is that of both halves of y.
    const Profile near = wall_profile(packing, even_edges(0, 2, 0.25), window);
    for (std::size_t k = 0; k < near.size(); ++k) {
      const double halves = along_y.values[k] + along_y.values[along_y.size() - 1 - k];
      CHECK(near.values[k] == Approx(0.5 * halves).epsilon(1e-12));
    }
  }
  SECTION("from the axis of a cylinder") {
    const Packing packing = poured(Cylinder{6}, 200, 7);
    const HeightWindow window{0.8, 4.1};
    const Profile profile = radial_profile(packing, even_edges(0, 3, 0.15), window);
    const auto distance = [](Vec3 r) {
      const double squared = (r.x - 3) * (r.x - 3) + (r.y - 3) * (r.y - 3);
      return squared < 9 ? std::sqrt(squared) : nowhere;
    };
    check_misfit(misfit_by_sampling(packing, profile, window, distance, points), profile.size());
  }
}

TEST_CASE("Plane cuts are what random points on them find") {
  const Packing packing = poured(PeriodicBox{4.7, 5.3}, 200, 8);
  const HeightWindow window{0.8, 4.1};
  const std::vector<double> places = {0, 0.01, 0.5, 0.77, 1.3, 2.2, 3.1, 4.4, 4.69};
  const auto horizontal = vertical_cuts(packing, places);
  const auto upright = transverse_cuts(packing, Axis::x, places, window);
  const auto across = transverse_cuts(packing, Axis::y, places, window);
  constexpr int points = 40'000;
  RandomStream random(stream_key(52, 0, 0, Purpose::resampling));
  double misfit = 0;
  std::size_t cuts = 0;
  const auto compare = [&](double fraction, auto&& point) {
    if (fraction == 0) return;
    int hits = 0;
    for (int i = 0; i < points; ++i) hits += is_solid(packing, point());
    const double deviation = static_cast<double>(hits) / points - fraction;
    misfit += deviation * deviation / (fraction * (1 - fraction) / points);
    ++cuts;
  };
  const auto anywhere = [&](double low, double high) {
    return low + (high - low) * random.uniform();
  };
  for (std::size_t k = 0; k < places.size(); ++k) {
    const double place = places[k];
    compare(horizontal[k], [&] { return Vec3{anywhere(0, 4.7), anywhere(0, 5.3), place}; });
    compare(upright[k], [&] { return Vec3{place, anywhere(0, 5.3), anywhere(0.8, 4.1)}; });
    compare(across[k], [&] { return Vec3{anywhere(0, 4.7), place, anywhere(0.8, 4.1)}; });
  }
  CHECK(horizontal[0] == 0);  // the floor touches spheres in points
  CHECK(cuts == 26);
  check_misfit(misfit, cuts);
}

TEST_CASE("Plane cuts are the limit of thin bins") {
  const Packing packing = poured(WalledBox{5, 5}, 150, 9);
  const HeightWindow window{0.8, 3.3};
  for (const double place : {0.21, 1.3, 2.4, 4.9}) {
    const double edges[] = {place - 5e-5, place + 5e-5};
    const double middle[] = {place};
    CHECK(vertical_cuts(packing, middle)[0] ==
          Approx(vertical_profile(packing, edges).values[0]).margin(1e-7));
    CHECK(transverse_cuts(packing, Axis::y, middle, window)[0] ==
          Approx(transverse_profile(packing, Axis::y, edges, window).values[0]).margin(1e-6));
  }
}

TEST_CASE("Profiles of one sphere") {
  SECTION("on a seam it shows half at either side") {
    const Packing packing{PeriodicBox{4, 4}, {{0, 0, 0.5}}};
    for (const Axis axis : {Axis::x, Axis::y}) {
      const Profile profile = transverse_profile(packing, axis, even_edges(0, 4, 1), {0, 1});
      CHECK(profile.values[0] == Approx(sphere_volume / 8).epsilon(1e-14));
      CHECK(profile.values[1] == 0);
      CHECK(profile.values[2] == 0);
      CHECK(profile.values[3] == Approx(sphere_volume / 8).epsilon(1e-14));
      const double seam[] = {0, 0.25, 4};
      const auto cuts = transverse_cuts(packing, axis, seam, {0, 1});
      CHECK(cuts[0] == Approx(std::numbers::pi / 16).epsilon(1e-14));
      CHECK(cuts[1] == Approx(std::numbers::pi * (0.25 - 0.0625) / 4).epsilon(1e-14));
      CHECK(cuts[2] == Approx(cuts[0]).epsilon(1e-14));
    }
  }
  SECTION("in a corner, two walls at the same distance") {
    const Packing packing{WalledBox{4, 4}, {{0.5, 0.5, 0.5}}};
    const double edges[] = {0, 0.5, 2};
    const Profile profile = wall_profile(packing, edges, {0, 0.5});
    // Half of the sphere is in the window; a quarter of that is farther from both walls.
    CHECK(profile.values[1] * profile.volumes[1] == Approx(sphere_volume / 8).epsilon(1e-14));
    CHECK(profile.values[0] * profile.volumes[0] == Approx(sphere_volume * 3 / 8).epsilon(1e-14));
    CHECK(profile.volumes[1] == Approx(4.5).epsilon(1e-14));
  }
  SECTION("on the axis of a tube") {
    const Packing packing{Cylinder{3}, {{1.5, 1.5, 0.5}}};
    const double edges[] = {0, 0.3, 0.5, 1.5};
    const Profile profile = radial_profile(packing, edges, {0, 1});
    // The part beyond a bore of half-length 0.4 is a sphere of that radius.
    const double beyond = 4.0 / 3 * std::numbers::pi * 0.064;
    CHECK(profile.values[1] * profile.volumes[1] == Approx(beyond).epsilon(1e-12));
    CHECK(profile.values[0] * profile.volumes[0] == Approx(sphere_volume - beyond).epsilon(1e-12));
    CHECK(profile.values[2] == 0);
  }
  SECTION("between floor and window") {
    const Packing packing{WalledBox{2, 2}, {{1, 1, 0.5}}};
    const double edges[] = {0, 0.25, 1, 3};
    const Profile profile = vertical_profile(packing, edges);
    CHECK(profile.values[0] == Approx(std::numbers::pi * 0.0625 * 1.25 / 3).epsilon(1e-14));
    CHECK(profile.values[2] == 0);
    CHECK(profile.middle(1) == 0.625);
  }
}

TEST_CASE("The mean of x and y needs a square footprint") {
  const Packing packing = poured(WalledBox{5, 5}, 150, 10);
  const auto edges = even_edges(0, 5, 0.4);
  const HeightWindow window{1, 4};
  const Profile mean = mean_transverse_profile(packing, edges, window);
  const Profile x = transverse_profile(packing, Axis::x, edges, window);
  const Profile y = transverse_profile(packing, Axis::y, edges, window);
  for (std::size_t k = 0; k < mean.size(); ++k) {
    CHECK(mean.values[k] == Approx(0.5 * (x.values[k] + y.values[k])).epsilon(1e-15));
  }
  CHECK_THROWS_AS(mean_transverse_profile({WalledBox{5, 6}, packing.centres}, edges, window),
                  std::invalid_argument);
}

TEST_CASE("Lateral and central parts make up the whole") {
  SECTION("between walls") {
    const Packing packing = poured(WalledBox{9, 8}, 500, 11);
    const HeightWindow window{1, 5};
    const double phi = solids_fraction(packing, window);
    const LateralCentral parts = lateral_and_central(packing, window);
    // Along x and y the lateral part is 7 of 9 and 7 of 8 diameters; each adds up to phi.
    const double x_edges[] = {0, 3.5, 5.5, 9}, y_edges[] = {0, 3.5, 4.5, 8};
    const Profile x = transverse_profile(packing, Axis::x, x_edges, window);
    const Profile y = transverse_profile(packing, Axis::y, y_edges, window);
    CHECK((3.5 * x.values[0] + 2 * x.values[1] + 3.5 * x.values[2]) / 9 ==
          Approx(phi).epsilon(1e-12));
    CHECK(parts.lateral ==
          Approx((x.values[0] + x.values[2] + y.values[0] + y.values[2]) / 4).epsilon(1e-12));
    CHECK(parts.central == Approx((x.values[1] + y.values[1]) / 2).epsilon(1e-12));
    CHECK_THROWS_AS(lateral_and_central(packing, window, 4), std::invalid_argument);
  }
  SECTION("between plates y alone has walls") {
    const Packing packing = poured(Plates{7, 8}, 400, 14);
    const HeightWindow window{1, 5};
    const LateralCentral parts = lateral_and_central(packing, window);
    CHECK((7 * parts.lateral + parts.central) / 8 ==
          Approx(solids_fraction(packing, window)).epsilon(1e-12));
    CHECK_THROWS_AS(lateral_and_central(packing, window, 4), std::invalid_argument);
  }
  SECTION("in a cylinder") {
    const Packing packing = poured(Cylinder{9}, 350, 12);
    const HeightWindow window{1, 4};
    const LateralCentral parts = lateral_and_central(packing, window);
    CHECK((parts.central * 1 + parts.lateral * (4.5 * 4.5 - 1)) / (4.5 * 4.5) ==
          Approx(solids_fraction(packing, window)).epsilon(1e-12));
    CHECK_THROWS_AS(lateral_and_central(packing, window, 4.5), std::invalid_argument);
  }
  SECTION("without walls there are none") {
    CHECK_THROWS_AS(lateral_and_central(poured(PeriodicBox{8, 8}, 10, 13), {0, 1}),
                    std::invalid_argument);
  }
}

TEST_CASE("Edges cover their range") {
  CHECK(even_edges(0, 1, 0.25) == std::vector<double>{0, 0.25, 0.5, 0.75, 1});
  CHECK(even_edges(0, 1, 0.4) == std::vector<double>{0, 0.4, 0.8, 1});
  CHECK(even_edges(2, 3, 5) == std::vector<double>{2, 3});
  CHECK(even_edges(0, 5, 0.1).size() == 51);  // 50 x 0.1, whatever rounding makes of it
  CHECK(even_edges(0, 5, 0.1).back() == 5);
  CHECK_THROWS_AS(even_edges(0, 1, 0), std::invalid_argument);
  CHECK_THROWS_AS(even_edges(1, 1, 0.1), std::invalid_argument);
  const Packing packing{WalledBox{2, 2}, {{1, 1, 0.75}}};
  CHECK(height_edges(packing, 0.5) == std::vector<double>{0, 0.5, 1, 1.5});
}

TEST_CASE("Profiles without meaning are refused") {
  const Packing bulk{FullyPeriodicBox{4, 4, 4}, {{1, 1, 1}}};
  const Packing periodic{PeriodicBox{4, 4}, {{1, 1, 0.5}}}, tube{Cylinder{4}, {{2, 2, 0.5}}};
  const double edges[] = {0, 1, 2}, descending[] = {0, 2, 1}, far[] = {0, 5}, single[] = {1};
  const HeightWindow window{0, 1};
  CHECK_THROWS_AS(vertical_profile(bulk, edges), std::invalid_argument);
  CHECK_THROWS_AS(vertical_cuts(bulk, edges), std::invalid_argument);
  CHECK_THROWS_AS(transverse_window(bulk), std::invalid_argument);
  CHECK_THROWS_AS(transverse_profile(bulk, Axis::x, edges, window), std::invalid_argument);
  CHECK_THROWS_AS(transverse_profile(tube, Axis::x, edges, window), std::invalid_argument);
  CHECK_THROWS_AS(wall_profile(periodic, edges, window), std::invalid_argument);
  CHECK_THROWS_AS(radial_profile(periodic, edges, window), std::invalid_argument);
  CHECK_THROWS_AS(vertical_profile(periodic, descending), std::invalid_argument);
  CHECK_THROWS_AS(vertical_profile(periodic, single), std::invalid_argument);
  CHECK_THROWS_AS(transverse_profile(periodic, Axis::x, far, window), std::invalid_argument);
  CHECK_THROWS_AS(transverse_profile(periodic, Axis::x, edges, {1, 1}), std::invalid_argument);
  // One layer ends below 4 R.
  CHECK_THROWS_WITH(transverse_profile(periodic, Axis::x, edges, transverse_window(periodic)),
                    Catch::Contains("too low"));
}
