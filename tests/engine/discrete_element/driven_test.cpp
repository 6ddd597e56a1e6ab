#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "engine/discrete_element/driven_sums.hpp"
#include "engine/discrete_element/state.hpp"
#include "engine/engines.hpp"
#include "tests/engine/discrete_element/grain_cases.hpp"

using namespace jostle;
using namespace jostle::grain_cases;

namespace {

const Container box = PeriodicBox{4, 4};

/// A bed at rest whose floor has just begun to shake; every second slice is saved and restored.
struct ShakenBed {
  DiscreteElement settings;
  std::unique_ptr<Dynamics> dynamics = make_dynamics(EngineSettings{settings}, {});

  ShakenBed(const Tap& tap, double bin_width) {
    dynamics->load(dilute_column(box, 50, 8));
    dynamics->settle(RandomSettle{});
    while (dynamics->advance(1'000'000) == DynamicsStatus::running) {
    }
    RandomStream random(stream_key(1, 0, 0, Purpose::tap));
    dynamics->tap(tap, random);
    if (bin_width > 0) dynamics->watch_motion(bin_width);
  }
  void store_and_restore() {
    Packing bed;
    dynamics->store(bed);
    const std::vector<std::byte> state = dynamics->save();
    dynamics = make_dynamics(EngineSettings{settings}, {});
    dynamics->load(bed);
    dynamics->restore(state);
  }
};

bool is_same(const std::vector<double>& a, const std::vector<double>& b) {
  bool equal = a.size() == b.size();
  for (std::size_t k = 0; equal && k < a.size(); ++k)
    equal = a[k] == b[k] || (std::isnan(a[k]) && std::isnan(b[k]));
  return equal;
}
bool is_same(const DrivenBed& a, const DrivenBed& b) {
  return is_same(a.fraction, b.fraction) && is_same(a.lateral, b.lateral) &&
         is_same(a.vertical, b.vertical);
}

}  // namespace

TEST_CASE("samples of a driven bed add up by hand") {
  DrivenSums sums;
  sums.bin_width = 1;
  CHECK(driven_bed(sums, 1).fraction.empty());
  // Two spheres in the bin from 1 to 2 above a floor at 0.5, one in the next, one below the floor.
  add_sample(sums,
             std::vector{grain({0, 0, 1.6}, {1, 0, 3}), grain({0, 0, 2.4}, {-1, 4, 1}),
                         grain({0, 0, 2.6}, {9, 9, 9}), grain({0, 0, 0.4}, {5, 5, 5})},
             0.5);
  // Later they are together in the lowest bin, at rest in each other's frame.
  add_sample(sums,
             std::vector{grain({0, 0, 0.1}, {7, 7, 7}), grain({0, 0, 0.2}, {7, 7, 7}),
                         grain({0, 0, 0.3}, {7, 7, 7}), grain({0, 0, 0.9}, {7, 7, 8})},
             0);
  const DrivenBed bed = driven_bed(sums, 0.5);
  CHECK(bed.fraction == std::vector{5.0 / 8, 2.0 / 8, 1.0 / 8});
  REQUIRE(bed.lateral.size() == 2);  // the highest bin never held two
  CHECK(bed.lateral[0] == 0);
  CHECK(bed.vertical[0] ==
        Approx(4 * 0.75 / 3));  // in seconds; 0.75 of one in four that differs by 1
  CHECK(bed.lateral[1] == Approx(4 * 0.5 * (2 + 8)));
  CHECK(bed.vertical[1] == Approx(4 * 2));
}

TEST_CASE("what is watched of a motion does not depend on slices, and nothing on it") {
  for (const Tap& tap : {Tap{Vibration{0.1, 40, 5}}, Tap{HalfSine{0.4413, 7.5}}}) {
    ShakenBed straight(tap, 0.5), stopped(tap, 0.5), unwatched(tap, 0);
    while (straight.dynamics->advance(1'000'000) == DynamicsStatus::running) {
    }
    while (stopped.dynamics->advance(50 * 1377) == DynamicsStatus::running)
      stopped.store_and_restore();
    while (unwatched.dynamics->advance(1'000'000) == DynamicsStatus::running) {
    }
    CHECK(straight.dynamics->diagnostics() == unwatched.dynamics->diagnostics());
    Packing a, b;
    straight.dynamics->store(a);
    unwatched.dynamics->store(b);
    CHECK(a.centres == b.centres);
    const DrivenBed driven = straight.dynamics->mechanics().driven;
    CHECK(driven.fraction.size() > 3);
    CHECK(is_same(driven, stopped.dynamics->mechanics().driven));
    CHECK(unwatched.dynamics->mechanics().driven.fraction.empty());
    stopped.store_and_restore();
    CHECK(is_same(driven, stopped.dynamics->mechanics().driven));
    // The next tap is not watched unless it is asked for.
    RandomStream random(stream_key(1, 0, 0, Purpose::tap));
    straight.dynamics->tap(tap, random);
    straight.dynamics->advance(200'000);
    CHECK(straight.dynamics->mechanics().driven.fraction.empty());
  }
}

// A twin that looks at every seventh step, by other sums.
TEST_CASE("the granular temperature of a driven bed is the variance of its velocities") {
  constexpr double bin_width = 1, frequency = 30, amplitude = 0.2;
  constexpr std::uint64_t cycles = 12;
  ShakenBed bed(Vibration{amplitude, frequency, cycles}, bin_width);
  const double unit = reduced(bed.settings).seconds;
  const FloorMotion motion{amplitude, frequency * unit, 2 * cycles};
  struct Sums {
    double n = 0, freedom = 0, lateral = 0, vertical = 0;
  };
  std::map<int, Sums> sums;
  double all = 0;
  for (;;) {
    bed.dynamics->advance(50 * 7);
    const GrainLoop::State state = grain_state(bed.dynamics->save()).loop;
    const double time = static_cast<double>(state.steps) * reduced(bed.settings).time_step;
    if (!(time < motion.duration())) break;
    struct Moments {
      double n = 0;
      Vec3 sum;
      double x2 = 0, y2 = 0, z2 = 0;
    };
    std::map<int, Moments> bins;
    for (const GrainState& grain : state.grains) {
      Moments& bin =
          bins[static_cast<int>((grain.centre.z - motion.place_at(time).height) / bin_width)];
      bin.n += 1;
      bin.sum = bin.sum + grain.velocity;
      bin.x2 += grain.velocity.x * grain.velocity.x;
      bin.y2 += grain.velocity.y * grain.velocity.y;
      bin.z2 += grain.velocity.z * grain.velocity.z;
    }
    for (const auto& [k, bin] : bins) {
      const Vec3 mean = (1 / bin.n) * bin.sum;
      sums[k].n += bin.n;
      sums[k].freedom += bin.n - 1;
      sums[k].lateral += 0.5 * (bin.x2 + bin.y2 - bin.n * (mean.x * mean.x + mean.y * mean.y));
      sums[k].vertical += bin.z2 - bin.n * mean.z * mean.z;
      all += bin.n;
    }
  }
  while (bed.dynamics->advance(1'000'000) == DynamicsStatus::running) {
  }
  const DrivenBed driven = bed.dynamics->mechanics().driven;
  REQUIRE(driven.lateral.size() >= 3);
  for (int k = 0; k < 3; ++k) {
    const auto index = static_cast<std::size_t>(k);
    const Sums& bin = sums[k];
    CAPTURE(k, driven.lateral[index], driven.vertical[index]);
    CHECK(driven.fraction[index] == Approx(bin.n / all).epsilon(0.02));
    CHECK(driven.lateral[index] == Approx(bin.lateral / bin.freedom / unit / unit).epsilon(0.1));
    CHECK(driven.vertical[index] == Approx(bin.vertical / bin.freedom / unit / unit).epsilon(0.1));
  }
  // The floor puts energy into vertical motion; collisions share it with the lateral.
  CHECK(driven.lateral[0] < driven.vertical[0]);
  CHECK(driven.lateral[0] > 0);
}

TEST_CASE("a state with forged sums of a driven bed is refused") {
  ShakenBed bed(Vibration{0.1, 40, 5}, 0.5);
  bed.dynamics->advance(500'000);
  const std::vector<std::byte> state = bed.dynamics->save();
  REQUIRE(grain_state(state).driven.samples > 0);
  const auto refused = [&](auto change) {
    GrainDynamicsState changed = grain_state(state);
    change(changed.driven);
    CHECK_THROWS_AS(bed.dynamics->restore(bytes_of(changed)), StateError);
  };
  refused([](DrivenSums& sums) { sums.bin_width = std::numeric_limits<double>::infinity(); });
  refused([](DrivenSums& sums) { sums.bins[0].lateral = std::nan(""); });
  CHECK_THROWS_AS(bed.dynamics->restore(std::span(state).first(40)), StateError);
}
