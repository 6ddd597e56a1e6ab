#include "structure/order/ordered_front.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "close_packings.hpp"
#include "structure/density/layers.hpp"
#include "structure/measure.hpp"
#include "structure/observables.hpp"
#include "tests/structure/reference_deposit.hpp"

using namespace jostle;

namespace {

const double rise = std::sqrt(2.0 / 3);

double single(const std::vector<Measurement>& parts, std::string_view name) {
  for (const Measurement& part : parts) {
    if (const MeasuredQuantity* found = part.find(name)) return found->values.at(0);
  }
  FAIL("no " << name);
  return 0;
}

/// Upwards from the floor's slice, every slice counted anew.
double front_by_counting(const Packing& packing, const std::vector<CrystalOrder>& orders) {
  double front = 0;
  for (int k = 1;; ++k) {
    const double low = 0.5 + (k - 0.5) * rise, high = low + rise;
    int all = 0, crystalline = 0;
    for (std::size_t i = 0; i < orders.size(); ++i) {
      if (packing.centres[i].z < low || packing.centres[i].z >= high) continue;
      ++all;
      crystalline += orders[i] == CrystalOrder::fcc || orders[i] == CrystalOrder::hcp ? 1 : 0;
    }
    if (all == 0 || 2 * crystalline < all) return front;
    front = high;
  }
}

/// A crystal of 8 layers under a disordered bed.
Packing crystal_under_disorder() {
  Packing packing = stacked_layers("ABABABAB");
  const Packing loose = shaken(stacked_layers("ABCABC"), 0.18);
  for (Vec3 r : loose.centres) packing.centres.push_back({r.x, r.y, r.z + 8 * rise + 0.3});
  return packing;
}

}  // namespace

TEST_CASE("The front of a perfect crystal is below its top layer") {
  for (const char* stacking : {"ABABABAB", "ABCABCAB"}) {
    const Packing crystal = stacked_layers(stacking);
    CHECK(ordered_height(crystal, crystal_order(crystal)) == Approx(0.5 + 6.5 * rise));
  }
  const Packing two = stacked_layers("AB");
  CHECK(ordered_height(two, crystal_order(two)) == 0);
  const Packing nothing{PeriodicBox{12, 12}, {}};
  CHECK(ordered_height(nothing, {}) == 0);
}

TEST_CASE("Between walls the spheres at them are left out: the crystal beside them has its front") {
  // A crystal of 12 x 12 d that ends at walls: a third of its spheres have too few neighbours.
  Packing crystal = stacked_layers("ABABABAB");
  double width = 0;
  for (Vec3& r : crystal.centres) {
    r.x += 0.5;
    r.y += 0.5;
    width = std::max({width, r.x + 0.5, r.y + 0.5});
  }
  for (const double part : {1.0, 0.55}) {
    Packing walled{WalledBox{part * width, part * width}, {}};
    for (const Vec3& r : crystal.centres) {
      if (r.x <= part * width - 0.5 && r.y <= part * width - 0.5) walled.centres.push_back(r);
    }
    CAPTURE(width, walled.centres.size());
    CHECK(ordered_height(walled, crystal_order(walled)) == Approx(0.5 + 6.5 * rise));
  }
}

TEST_CASE("The front is where slices counted one by one have it") {
  for (const double amplitude : {0.0, 0.08, 0.12}) {
    const Packing packing = shaken(crystal_under_disorder(), amplitude);
    const auto orders = crystal_order(packing);
    CHECK(ordered_height(packing, orders) ==
          Approx(front_by_counting(packing, orders)).epsilon(1e-12));
  }
  const Packing packing = crystal_under_disorder();
  CHECK(ordered_height(packing, crystal_order(packing)) == Approx(0.5 + 6.5 * rise));
}

TEST_CASE("Observables of order are what structure finds in the same packing") {
  StructureSettings settings;
  settings.order.emplace();
  settings.layers.emplace();
  const std::vector<Observable> observables = {CrystallineFraction{}, GrownLayers{},
                                               OrderedHeight{}};
  for (const Packing& packing :
       {crystal_under_disorder(), shaken(stacked_layers("ABCABCABC"), 0.1), reference_deposit()}) {
    const std::vector<Measurement> parts = measure(packing, settings, StreamKey{});
    const std::vector<double> values = Observer(observables, packing)(packing);
    CHECK(values[0] == Approx(single(parts, "fcc") + single(parts, "hcp")).epsilon(1e-12));
    CHECK(values[1] == single(parts, "grown_layers"));
    CHECK(values[2] == single(parts, "ordered_height"));
  }
}
