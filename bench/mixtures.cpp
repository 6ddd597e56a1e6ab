// Rates of both samplers in mixtures against equal spheres, in turns, polar move.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "bench/rates.hpp"
#include "engine/bed/mixture.hpp"
#include "engine/starts/starts.hpp"
#include "engine/taps.hpp"

namespace jostle::bench {
namespace {

constexpr std::uint64_t seed = 20010222;
constexpr std::uint32_t n_spheres = 4096;

struct Mixture {
  const char* name;
  std::vector<MixtureKind> kinds;  // empty: equal spheres, by the loop that is made for them
  double target = 0;               // least ratio of rates; 0: reported without a target
  double width = 16;               // width of the periodic box, diameters
};

MixtureKind kind(const char* name, std::uint32_t count, DiameterLaw diameter) {
  return {.name = name, .count = count, .diameter = std::move(diameter)};
}

std::vector<Mixture> mixtures() {
  constexpr std::uint32_t half = n_spheres / 2;
  const FixedDiameter small{1};
  return {
      {"equal spheres", {}},
      {"diameter 1, as sizes", {kind("all", n_spheres, small)}},
      {"lognormal, 10 %", {kind("all", n_spheres, LognormalDiameter{1, 0.1})}, 0.85},
      {"1 and 1.4, half each", {kind("s", half, small), kind("l", half, FixedDiameter{1.4})}, 0.8},
      {"one intruder of 5", {kind("s", n_spheres - 1, small), kind("l", 1, FixedDiameter{5})}, 0.7},
      {"eight of 7", {kind("s", n_spheres - 8, small), kind("l", 8, FixedDiameter{7})}},
      // In a box so narrow that the bed is as deep as that of 1 and 1.4: a tap dilates a bed by a
      // share of its depth, and the deeper bed accepts more of the trials after it.
      {"equal, as deep as 1.4", {}, 0, 16 / std::sqrt(0.5 * (1 + 1.4 * 1.4 * 1.4))},
  };
}

std::unique_ptr<TrialLoop> loop_for(const Packing& bed, std::uint64_t realization,
                                    Sampler sampler = Sampler::exhaustive) {
  auto loop = make_trial_loop(
      bed.container, PolarMove{}, stream_key(seed, 0, realization, Purpose::trials),
      best_instruction_set(), sampler, bed.sizes ? SphereSizes::several : SphereSizes::equal);
  loop->load(bed);
  return loop;
}

// A bed that settled from random places, tapped once and relaxed.
Packing bed_of(const Mixture& mixture) {
  StartSpheres spheres{n_spheres};
  RandomStream diameters(stream_key(seed, 0, 0, Purpose::sizes));
  if (!mixture.kinds.empty()) spheres.sizes = draw_sizes(mixture.kinds, diameters);
  RandomStream places(stream_key(seed, 0, 0, Purpose::start));
  const PeriodicBox box{mixture.width, mixture.width};
  Packing bed = make_start(RandomSettle{0.2}, box, spheres, places);
  RandomStream taps(stream_key(seed, 0, 0, Purpose::tap));
  for (std::uint64_t tap = 0; tap < 2; ++tap) {
    if (tap > 0) excite(bed, Dilate{0.02}, taps);
    const auto loop = loop_for(bed, tap);
    loop->run(3000 * n_spheres);
    loop->store(bed);
  }
  return bed;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct Side {
  Mixture mixture;
  Packing bed;  // at rest
  std::unique_ptr<TrialLoop> loop, skipping;
  std::vector<double> rates, tapped_rates, skipping_rates, step_seconds;  // [turn]
  Rate last, last_tapped;
};

// Exhaustive trials of a whole relaxation: a tap and the sweeps after it.
Rate tapped_rate(const Side& side, std::uint64_t turn) {
  constexpr std::uint64_t sweeps = 2000;
  Packing bed = side.bed;
  RandomStream taps(stream_key(seed, 1, turn, Purpose::tap));
  excite(bed, Dilate{0.02}, taps);
  const auto loop = loop_for(bed, 10 + turn);
  loop->begin_tap();
  return measure_rate(*loop, sweeps * n_spheres);
}

const char* verdict_of(const Mixture& mixture, double ratio) {
  return mixture.target == 0 ? "" : ratio >= mixture.target ? "pass" : "missed";
}

void print_tapped(const std::vector<Side>& sides) {
  const double equal = median(sides.front().tapped_rates);
  for (const Side& side : sides) {
    const double rate = median(side.tapped_rates), ratio = rate / equal;
    fmt::print(
        "{:<22} {:6.1f} million trials/s, ratio {:.2f} {:<6} acceptance {:.4f}, {:.2f} distance "
        "tests per trial, {:.1f} list renewals per sweep\n",
        side.mixture.name, 1e-6 * rate, ratio, verdict_of(side.mixture, ratio),
        side.last_tapped.acceptance, side.last_tapped.distance_tests_per_trial,
        side.last_tapped.list_renewals_per_sweep);
  }
}

// In rejection-free sampling the rate counts the trials that are advanced over; the time of an
// accepted step hardly depends on how far the bed has come to rest.
void print_skipping(const std::vector<Side>& sides) {
  const double equal = median(sides.front().step_seconds);
  for (const Side& side : sides) {
    const double step = median(side.step_seconds);
    const TrialTally& tally = side.skipping->tally();
    fmt::print(
        "{:<22} {:6.1f} million trials/s in effect, {:.1f} of the exhaustive rate, {:.2f} us per "
        "accepted step, speed {:.2f} of equal spheres, {:.1f} candidates and {:.1f} rows of bounds "
        "per step{}\n",
        side.mixture.name, 1e-6 * median(side.skipping_rates),
        median(side.skipping_rates) / median(side.rates), 1e6 * step, equal / step,
        static_cast<double>(tally.candidates) / static_cast<double>(tally.accepted),
        static_cast<double>(tally.bound_rows) / static_cast<double>(tally.accepted),
        side.skipping->sampler_state().active ? "" : " (exhaustive at the end)");
  }
}

void compare(int turns) {
  std::vector<Side> sides;
  for (Mixture& mixture : mixtures()) {
    const Packing bed = bed_of(mixture);
    auto loop = loop_for(bed, 2), skipping = loop_for(bed, 2, Sampler::rejection_free);
    loop->run(10 * n_spheres);  // lists made, caches warm
    skipping->run(200 * n_spheres);
    sides.push_back(
        {std::move(mixture), bed, std::move(loop), std::move(skipping), {}, {}, {}, {}, {}, {}});
  }
  for (int turn = 0; turn < turns; ++turn) {
    for (Side& side : sides) {
      side.last = measure_rate(*side.loop, 1'000'000);
      side.rates.push_back(side.last.trials_per_second());
      side.last_tapped = tapped_rate(side, static_cast<std::uint64_t>(turn));
      side.tapped_rates.push_back(side.last_tapped.trials_per_second());
      const Rate skipped = measure_rate(*side.skipping, 8'000'000);
      side.skipping_rates.push_back(skipped.trials_per_second());
      side.step_seconds.push_back(skipped.seconds /
                                  (skipped.acceptance * static_cast<double>(skipped.trials)));
    }
  }
  const double equal = median(sides.front().rates);
  for (const Side& side : sides) {
    const double rate = median(side.rates), ratio = rate / equal;
    fmt::print(
        "{:<22} {:6.1f} million trials/s, ratio {:.2f} {:<6} acceptance {:.4f}, {:.2f} "
        "distance tests per trial, {:.0f} bytes per sphere\n",
        side.mixture.name, 1e-6 * rate, ratio, verdict_of(side.mixture, ratio),
        side.last.acceptance, side.last.distance_tests_per_trial, side.last.bytes_per_sphere);
  }
  fmt::print("\nA tap and 2000 sweeps after it:\n");
  print_tapped(sides);
  fmt::print("\nRejection-free sampling:\n");
  print_skipping(sides);
}

}  // namespace
}  // namespace jostle::bench

int main(int argc, char** argv) {
  const int turns = argc > 1 ? std::atoi(argv[1]) : 7;
  if (turns < 1) {
    fmt::print(stderr, "bench_mixtures [TURNS]: medians over so many turns, by default 7\n");
    return 2;
  }
  jostle::bench::compare(turns);
}
