// Prints each target of the trial loop as a ratio to the yardstick, with pass or miss.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "bench/rates.hpp"
#include "bench/standard_states.hpp"
#include "bench/stopwatch.hpp"
#include "bench/yardstick.hpp"
#include "engine/bed/boundary.hpp"

namespace jostle::bench {
namespace {

const StreamKey key = stream_key(20010222, 0, 1, Purpose::trials);

Yardstick yardstick_for(StandardState state, const Case& made) {
  std::vector<std::array<double, 3>> centres;
  for (const Vec3& r : made.packing.centres) centres.push_back({r.x, r.y, r.z});
  const Container& container = made.packing.container;
  const Boundary boundary(container);
  const bool polar = std::holds_alternative<PolarMove>(made.move);
  const auto move = polar                 ? YardstickMove::polar
                    : boundary.periodic_z ? YardstickMove::metropolis_free
                                          : YardstickMove::metropolis_cold;
  const double step = std::visit([](const auto& m) { return m.max_step; }, made.move);
  const bool fluid = state == StandardState::fluid_45 || state == StandardState::fluid_55;
  return {centres,
          width_x(container),
          width_y(container),
          boundary.periods().z,
          move,
          step,
          fluid ? YardstickLists::split : YardstickLists::sorted};
}

Rate measure_yardstick(Yardstick& yardstick, std::uint64_t trials) {
  const Yardstick yardstick_before = yardstick;
  const double began = thread_seconds();
  yardstick.run(trials);
  Rate rate{.trials = trials, .seconds = thread_seconds() - began};
  const auto n = static_cast<double>(trials);
  rate.acceptance = static_cast<double>(yardstick.accepted - yardstick_before.accepted) / n;
  rate.distance_tests_per_trial =
      static_cast<double>(yardstick.distance_tests - yardstick_before.distance_tests) / n;
  rate.list_renewals_per_sweep =
      static_cast<double>(yardstick.list_rebuilds - yardstick_before.list_rebuilds) *
      yardstick.n_spheres() * yardstick.n_spheres() / n;
  return rate;
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

// Medians over repetitions, the two sides in turn from the same packing.
struct Comparison {
  double engine = 0, yardstick = 0, ratio = 0;  // trials per second; and of one repetition, divided
  Rate last_engine, last_yardstick;
};

Comparison compare(StandardState state, int repetitions) {
  const Case made = standard_state(state);
  const std::uint64_t sweep = made.packing.centres.size();
  // About 0.1 s a repetition.
  const std::uint64_t trials = sweep * (state == StandardState::tapped_bed ? 1000 : 300);
  Comparison result;
  std::vector<double> engine, yardstick, ratio;
  for (int k = 0; k < repetitions; ++k) {
    const auto loop = make_trial_loop(made.packing.container, made.move, key);
    loop->load(made.packing);
    Yardstick plain = yardstick_for(state, made);
    loop->run(10 * sweep);
    plain.run(10 * sweep);
    result.last_engine = measure_rate(*loop, trials);
    result.last_yardstick = measure_yardstick(plain, trials);
    engine.push_back(result.last_engine.trials_per_second());
    yardstick.push_back(result.last_yardstick.trials_per_second());
    ratio.push_back(engine.back() / yardstick.back());
  }
  result.engine = median(engine);
  result.yardstick = median(yardstick);
  result.ratio = median(ratio);
  return result;
}

struct Target {
  StandardState state;
  double ratio;  // 0: reported without a target
};
constexpr std::array targets = {
    Target{StandardState::tapped_bed, 1.4}, Target{StandardState::lifted_bed, 0},
    Target{StandardState::dense_60, 1.6}, Target{StandardState::fluid_55, 2.0},
    Target{StandardState::fluid_45, 3.0}};

std::string verdict(double measured, double wanted) {
  if (wanted == 0) return "no target";
  return fmt::format("target {}: {}", wanted, measured >= wanted ? "pass" : "MISS");
}

void print(const char* side, const Rate& rate) {
  fmt::print(
      "    {:<10} acceptance {:.4f}, {:.2f} distance tests per trial, {:.1f} list renewals a "
      "sweep\n",
      side, rate.acceptance, rate.distance_tests_per_trial, rate.list_renewals_per_sweep);
}

void report(const Target& target, int repetitions) {
  const Comparison c = compare(target.state, repetitions);
  fmt::print("{:<11} {:6.1f} against {:5.1f} million trials/s: {:.2f} times, {}\n",
             name(target.state), c.engine / 1e6, c.yardstick / 1e6, c.ratio,
             verdict(c.ratio, target.ratio));
  print("engine", c.last_engine);
  print("yardstick", c.last_yardstick);
  std::fflush(stdout);
}

// The settled bed of 2^20 spheres against that of 4096, in turn.
void report_growth(int repetitions) {
  constexpr std::uint64_t trials = 4'000'000;
  constexpr double most_bytes = 300;
  std::array<std::unique_ptr<TrialLoop>, 2> loops;
  for (int k = 0; k < 2; ++k) {
    const Case made = standard_state(StandardState::tapped_bed, k == 0 ? 1u << 20 : 4096);
    loops[k] = make_trial_loop(made.packing.container, made.move, key);
    loops[k]->load(made.packing);
    loops[k]->run(10'000'000);
  }
  std::vector<double> ratio, large;
  double bytes = 0;
  for (int k = 0; k < repetitions; ++k) {
    const Rate large_rate = measure_rate(*loops[0], trials), few = measure_rate(*loops[1], trials);
    large.push_back(large_rate.trials_per_second());
    ratio.push_back(large.back() / few.trials_per_second());
    bytes = large_rate.bytes_per_sphere;
  }
  fmt::print("1048576 spheres: {:.1f} million trials/s, {:.2f} of the rate at 4096, {}\n",
             median(large) / 1e6, median(ratio), verdict(median(ratio), 0.5));
  fmt::print("    {:.0f} bytes per sphere, target at most {:.0f}: {}\n", bytes, most_bytes,
             bytes <= most_bytes ? "pass" : "MISS");
}

}  // namespace
}  // namespace jostle::bench

int main(int argc, char** argv) {
  using namespace jostle;
  using namespace jostle::bench;
  const int repetitions = argc > 1 ? std::atoi(argv[1]) : 7;
  if (argc > 2 || repetitions < 1) {
    fmt::print(stderr, "bench_targets [REPETITIONS]: medians over so many, by default 7\n");
    return 2;
  }
  fmt::print("instruction set {}, medians of {} interleaved repetitions, processor time\n",
             name(best_instruction_set()), repetitions);
  for (const Target& target : targets) report(target, repetitions);
  report_growth(repetitions);
}
