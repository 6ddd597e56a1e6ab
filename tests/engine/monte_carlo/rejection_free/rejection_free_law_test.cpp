#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>

#include "engine/monte_carlo/relaxation.hpp"
#include "engine/monte_carlo/trial_loop.hpp"
#include "engine/taps.hpp"
#include "tests/engine/sample_packings.hpp"
#include "tests/test_files.hpp"
#include "tests/two_samples.hpp"

using namespace jostle;

namespace {

constexpr std::uint64_t endless = std::uint64_t{1} << 60;

// One loop serves all taps of a sampler: its trials never draw the same numbers again.
std::unique_ptr<TrialLoop> loop_of(const Packing& packing, const Move& move, Sampler sampler,
                                   std::uint64_t use) {
  const StreamKey key = stream_key(71, static_cast<std::uint64_t>(sampler), use, Purpose::trials);
  return make_trial_loop(packing.container, move, key, best_instruction_set(), sampler);
}

// Results of each sampler for equal taps: one number per tap.
struct TapSamples {
  std::vector<double> sweeps, height, bottom, bulk, acceptance;
};

struct Course {
  Move move;
  Tap tap;
  Stop stop;
  HeightWindow bulk;
};

void relax_and_measure(TrialLoop& loop, const Packing& excited, const Course& course,
                       TapSamples& samples) {
  loop.load(excited);
  loop.begin_tap();
  RelaxationProgress progress;
  relax(loop, course.stop, {}, progress, endless);
  REQUIRE(progress.status == DynamicsStatus::settled);
  samples.sweeps.push_back(static_cast<double>(progress.trials) / loop.n_spheres());
  samples.height.push_back(loop.mean_height());
  samples.bottom.push_back(loop.solids_fraction({0, 2}));
  samples.bulk.push_back(loop.solids_fraction(course.bulk));
  samples.acceptance.push_back(static_cast<double>(progress.accepted) /
                               static_cast<double>(progress.trials));
}

// The chain of beds continues from other relaxations; both samplers start from each excited bed.
void compare_taps(Packing bed, const Course& course, int taps) {
  TapSamples exhaustive, rejection_free;
  const auto all = loop_of(bed, course.move, Sampler::exhaustive, 1);
  const auto few = loop_of(bed, course.move, Sampler::rejection_free, 1);
  const auto chain = loop_of(bed, course.move, Sampler::exhaustive, 2);
  RandomStream random(stream_key(72, 0, 0, Purpose::tap));
  for (int tap = 0; tap < taps; ++tap) {
    excite(bed, course.tap, random);
    relax_and_measure(*all, bed, course, exhaustive);
    relax_and_measure(*few, bed, course, rejection_free);
    chain->load(bed);
    chain->begin_tap();
    RelaxationProgress progress;
    relax(*chain, course.stop, {}, progress, endless);
    chain->store(bed);
  }
  CHECK(few->tally().candidates > 0);
  CHECK(few->tally().candidates < few->tally().trials / 10);
  check_same_law("sweeps", exhaustive.sweeps, rejection_free.sweeps);
  check_same_law("mean height", exhaustive.height, rejection_free.height);
  check_same_law("bottom fraction", exhaustive.bottom, rejection_free.bottom);
  check_same_law("bulk fraction", exhaustive.bulk, rejection_free.bulk);
  check_same_law("acceptance", exhaustive.acceptance, rejection_free.acceptance);
}

Packing settled(const Container& container, std::uint32_t n, const Move& move,
                std::uint64_t sweeps = 5000) {
  Packing packing = random_packing(container, n, 0.3 * n, 73);
  const auto loop = loop_of(packing, move, Sampler::exhaustive, 3);
  loop->load(packing);
  loop->run(sweeps * n);
  loop->store(packing);
  return packing;
}

// Displacements of the spheres that moved within 20 sweeps, nearly all once: lengths and falls; and
// how many moved.
struct StepSamples {
  std::vector<double> length, fall, count;
};

StepSamples steps_from(const Packing& bed, const Move& move, Sampler sampler, int runs) {
  StepSamples samples;
  const std::uint64_t n = bed.centres.size();
  const auto loop = loop_of(bed, move, sampler, 4);
  for (int run = 0; run < runs; ++run) {
    loop->load(bed);
    loop->begin_tap();
    loop->run(25 * n);
    if (sampler == Sampler::rejection_free) REQUIRE(loop->sampler_state().active);
    Packing packing_before = bed, packing_after = bed;
    loop->store(packing_before);
    loop->run(20 * n);
    loop->store(packing_after);
    int moved = 0;
    for (std::size_t i = 0; i < n; ++i) {
      if (packing_before.centres[i] == packing_after.centres[i]) continue;
      const Vec3 step = separation(std::get<PeriodicBox>(bed.container), packing_after.centres[i],
                                   packing_before.centres[i]);
      samples.length.push_back(std::sqrt(norm_squared(step)));
      samples.fall.push_back(-step.z);
      ++moved;
    }
    samples.count.push_back(moved);
  }
  return samples;
}

}  // namespace

TEST_CASE("rejection-free sampling has the law of looking at every trial: polar taps",
          "[statistics]") {
  const PeriodicBox box{4, 4};
  compare_taps(settled(box, 100, PolarMove{}),
               {PolarMove{}, Dilate{0.03}, {MeanHeightStop{3e-5, 100}, 1'000'000}, {1.5, 4.5}},
               200);
}

TEST_CASE("rejection-free sampling has the law of looking at every trial: Metropolis taps",
          "[statistics]") {
  MetropolisMove move{0.1};
  move.adaptation = StepAdaptation{0.99, 10'000, 0.5, AcceptanceBase::all_trials, true};
  const WalledBox box{4.5, 4.5};
  compare_taps(settled(box, 100, move),
               {move, Lift{0.25}, {MeanHeightStop{3e-5, 100}, 1'000'000}, {1.5, 4.5}}, 200);
}

TEST_CASE("rejection-free sampling has the law of looking at every trial: taps in a tube",
          "[slow]") {
  const Cylinder tube{5};
  compare_taps(settled(tube, 100, PolarMove{}),
               {PolarMove{}, Dilate{0.03}, {MeanHeightStop{3e-5, 100}, 1'000'000}, {1.5, 4.5}},
               200);
  compare_taps(settled(tube, 100, MetropolisMove{}),
               {MetropolisMove{}, Lift{0.25}, {MeanHeightStop{3e-5, 100}, 1'000'000}, {1.5, 4.5}},
               200);
}

TEST_CASE("rejection-free sampling has the law of looking at every trial: taps between plates",
          "[slow]") {
  const Plates plates{4.5, 4};
  compare_taps(settled(plates, 100, PolarMove{}),
               {PolarMove{}, Dilate{0.03}, {MeanHeightStop{3e-5, 100}, 1'000'000}, {1.5, 4.5}},
               200);
}

TEST_CASE("rejection-free sampling has the law of looking at every trial: accepted steps",
          "[slow]") {
  for (const Move& move : {Move{PolarMove{}}, Move{MetropolisMove{0.1}}}) {
    const Packing bed = settled(PeriodicBox{4, 4}, 100, move, 20'000);
    const StepSamples exhaustive = steps_from(bed, move, Sampler::exhaustive, 5000);
    const StepSamples rejection_free = steps_from(bed, move, Sampler::rejection_free, 5000);
    CHECK(exhaustive.length.size() > 1000);
    check_same_law("length", exhaustive.length, rejection_free.length);
    check_same_law("fall", exhaustive.fall, rejection_free.fall);
    check_same_law("moved spheres", exhaustive.count, rejection_free.count);
  }
}

TEST_CASE("rejection-free sampling has the law of looking at every trial: 4096 spheres",
          "[nightly]") {
  std::ifstream file(test_data("dep_L32_N4096_s1.dat"));
  file.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  const PeriodicBox box{16, 16};
  Packing bed{box, {}};
  double x = 0, y = 0, z = 0, supports = 0;
  while (file >> x >> y >> z >> supports) {
    bed.centres.push_back(wrapped(box, Vec3{x / 2, y / 2, z / 2}));
  }
  REQUIRE(bed.centres.size() == 4096);
  compare_taps(bed, {PolarMove{}, Dilate{0.02}, {MeanHeightStop{1e-5, 100}, 1'000'000}, {4, 10}},
               200);
}
