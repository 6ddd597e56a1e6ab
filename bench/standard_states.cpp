#include "bench/standard_states.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "engine/bed/boundary.hpp"
#include "engine/bed/cells/cell_grid.hpp"
#include "engine/bed/geometry.hpp"
#include "engine/bed/random.hpp"
#include "engine/monte_carlo/relaxation.hpp"
#include "engine/monte_carlo/trial_loop.hpp"
#include "engine/starts/starts.hpp"
#include "engine/taps.hpp"

namespace jostle::bench {

namespace {

constexpr std::uint64_t seed = 20010222;
constexpr std::uint32_t most_made_whole = 16384;
constexpr std::uint32_t tile_spheres = 4096;

StreamKey stream(Purpose purpose) {
  return stream_key(seed, 0, 0, purpose);
}

Packing settled_bed(std::uint32_t n_spheres, double width, const Tap& tap, const Move& move) {
  RandomStream start_random(stream(Purpose::start)), tap_random(stream(Purpose::tap));
  Packing packing =
      make_start(SteepestDescentPour{}, PeriodicBox{width, width}, n_spheres, start_random);
  excite(packing, tap, tap_random);
  const auto loop = make_trial_loop(packing.container, move, stream(Purpose::trials));
  loop->load(packing);
  loop->begin_tap();
  const Stop stop{MeanHeightStop{.eta = 1e-5, .every_sweeps = 100}};
  RelaxationProgress progress;
  relax(*loop, stop, {}, progress, stop.max_sweeps * n_spheres);
  loop->store(packing);
  return packing;
}

FullyPeriodicBox cube(std::uint32_t n_spheres, double fraction) {
  const double side = std::cbrt(n_spheres * sphere_volume / fraction);
  return {side, side, side};
}

Packing grown(std::uint32_t n_spheres, double fraction) {
  RandomStream random(stream(Purpose::start));
  return make_start(Grow{}, cube(n_spheres, fraction), n_spheres, random);
}

// Pushes every overlapping pair apart by half its overlap each, the next pair seeing it, as if
// diameters were `diameter`. Returns the deepest overlap met, in those diameters.
double push_apart(const FullyPeriodicBox& box, std::vector<Vec3>& centres, double diameter) {
  CellGrid grid;
  const auto n = static_cast<std::uint32_t>(centres.size());
  grid.build(Boundary(box), 1.1 * diameter, n, [&](std::uint32_t i) { return centres[i]; });
  double deepest = 0;
  for (std::uint32_t i = 0; i < n; ++i) {
    grid.for_each_near(centres[i], [&](std::uint32_t j) {
      if (j <= i) return;
      const Vec3 offset = separation(box, centres[i], centres[j]);
      const double distance = std::sqrt(norm_squared(offset));
      if (distance >= diameter) return;
      const Vec3 push = (0.5 * (diameter - distance) / distance) * offset;
      deepest = std::max(deepest, diameter - distance);
      centres[i] = wrapped(box, centres[i] + push);
      centres[j] = wrapped(box, centres[j] - push);
    });
  }
  return deepest;
}

// Growing takes too long where the fluid turns to glass: the spheres of a thinner fluid, brought
// closer, push one another apart.
Packing squeezed(std::uint32_t n_spheres, double fraction) {
  constexpr double margin = 1e-3;  // diameters, so that pushing ends
  constexpr int most_rounds = 20'000;
  Packing packing = grown(n_spheres, 0.55);
  const double width_before = width_x(packing.container);
  const FullyPeriodicBox box = cube(n_spheres, fraction);
  packing.container = box;
  for (Vec3& r : packing.centres) r = wrapped(box, (box.width_x / width_before) * r);
  for (int round = 0; round < most_rounds; ++round) {
    if (push_apart(box, packing.centres, 1 + margin) < margin) return packing;
  }
  throw std::runtime_error("the dense state still overlaps after " + std::to_string(most_rounds) +
                           " rounds of pushing");
}

Packing equilibrated(Packing packing, const Move& move) {
  constexpr std::uint64_t sweeps = 200;
  const auto n_spheres = packing.centres.size();
  const auto loop = make_trial_loop(packing.container, move, stream(Purpose::trials));
  loop->load(packing);
  loop->run(sweeps * n_spheres);
  loop->store(packing);
  return packing;
}

Case made_whole(StandardState state, std::uint32_t n_spheres) {
  const PolarMove polar{};
  const MetropolisMove metropolis{};
  switch (state) {
    case StandardState::tapped_bed:
      return {settled_bed(n_spheres, 16 * std::sqrt(n_spheres / 4096.0), Dilate{0.02}, polar),
              polar};
    case StandardState::lifted_bed:
      return {settled_bed(n_spheres, 12 * std::sqrt(n_spheres / 3456.0), Lift{0.25}, metropolis),
              metropolis};
    case StandardState::dense_60:
      return {equilibrated(squeezed(n_spheres, 0.60), metropolis), metropolis};
    case StandardState::fluid_55:
      return {equilibrated(grown(n_spheres, 0.55), metropolis), metropolis};
    case StandardState::fluid_45:
      return {equilibrated(grown(n_spheres, 0.45), metropolis), metropolis};
  }
  throw std::invalid_argument("no such standard state");
}

void shuffle(std::vector<Vec3>& centres) {
  RandomStream random(stream(Purpose::start));
  for (std::size_t k = centres.size(); k > 1; --k) {
    std::swap(centres[k - 1], centres[random.integer_below(k)]);
  }
}

// `copies` beside one another along each periodic direction.
Packing repeated(const Packing& tile, std::uint32_t copies) {
  Packing whole = tile;
  Vec3 shift{0, 0, 0};
  if (auto* bed = std::get_if<PeriodicBox>(&whole.container)) {
    shift = {bed->width_x, bed->width_y, 0};
    *bed = {copies * bed->width_x, copies * bed->width_y};
  } else {
    auto& bulk = std::get<FullyPeriodicBox>(whole.container);
    shift = {bulk.width_x, bulk.width_y, bulk.height};
    bulk = {copies * bulk.width_x, copies * bulk.width_y, copies * bulk.height};
  }
  const std::uint32_t layers = shift.z > 0 ? copies : 1;
  whole.centres.clear();
  whole.centres.reserve(tile.centres.size() * copies * copies * layers);
  for (std::uint32_t a = 0; a < copies; ++a) {
    for (std::uint32_t b = 0; b < copies; ++b) {
      for (std::uint32_t c = 0; c < layers; ++c) {
        for (const Vec3& r : tile.centres) {
          whole.centres.push_back(r + Vec3{a * shift.x, b * shift.y, c * shift.z});
        }
      }
    }
  }
  shuffle(whole.centres);
  return whole;
}

}  // namespace

std::string_view name(StandardState state) {
  switch (state) {
    case StandardState::tapped_bed:
      return "tapped_bed";
    case StandardState::lifted_bed:
      return "lifted_bed";
    case StandardState::dense_60:
      return "dense_0.60";
    case StandardState::fluid_55:
      return "fluid_0.55";
    case StandardState::fluid_45:
      return "fluid_0.45";
  }
  return "";
}

Case standard_state(StandardState state, std::uint32_t n_spheres) {
  if (n_spheres <= most_made_whole) return made_whole(state, n_spheres);
  Case made = made_whole(state, tile_spheres);
  const double tiles = static_cast<double>(n_spheres) / tile_spheres;
  const bool bulk = Boundary(made.packing.container).periodic_z;
  const auto copies =
      static_cast<std::uint32_t>(std::lround(bulk ? std::cbrt(tiles) : std::sqrt(tiles)));
  made.packing = repeated(made.packing, copies);
  if (made.packing.centres.size() != n_spheres) {
    throw std::invalid_argument(std::to_string(n_spheres) + " spheres are not " +
                                std::to_string(tile_spheres) + (bulk ? " k^3" : " k^2") +
                                ": choose such a number, or at most " +
                                std::to_string(most_made_whole));
  }
  return made;
}

}  // namespace jostle::bench
