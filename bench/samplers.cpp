// Seconds a tap with the exhaustive and the rejection-free sampler, in turn from the same excited
// beds, with pass or miss.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "bench/stopwatch.hpp"
#include "engine/monte_carlo/relaxation.hpp"
#include "engine/monte_carlo/trial_loop.hpp"
#include "engine/starts/starts.hpp"
#include "engine/taps.hpp"

namespace jostle::bench {
namespace {

constexpr std::uint64_t seed = 20010222;
constexpr std::uint64_t endless = std::uint64_t{1} << 60;

struct Course {
  const char* name;
  Container container;
  std::uint32_t n_spheres;
  Tap tap;
  Move move;
  double eta;     // eta of the mean height, per 100 sweeps
  double target;  // times fewer seconds per tap; 0: reported without a target
};

const std::array courses = {
    Course{"polar, periodic", PeriodicBox{16, 16}, 4096, Dilate{0.02}, PolarMove{}, 1e-5, 2.5},
    Course{"polar, periodic", PeriodicBox{16, 16}, 4096, Dilate{0.02}, PolarMove{}, 1e-6, 5},
    Course{"polar, walls", WalledBox{16, 16}, 4096, Dilate{0.02}, PolarMove{}, 1e-5, 0},
    Course{"polar, walls", WalledBox{16, 16}, 4096, Dilate{0.02}, PolarMove{}, 1e-6, 0},
    Course{"Metropolis at T = 0, walls", WalledBox{16, 16}, 4096, Lift{0.25}, MetropolisMove{},
           1e-5, 2},
    Course{"Metropolis at T = 0, walls", WalledBox{16, 16}, 4096, Lift{0.25}, MetropolisMove{},
           1e-6, 5},
};

// The taps of one sampler, one after another.
struct Side {
  std::unique_ptr<TrialLoop> loop;
  std::vector<double> seconds;
  double sweeps = 0, height = 0;  // sums over taps

  void relax_tap(const Packing& excited, const Stop& stop) {
    loop->load(excited);
    loop->begin_tap();
    RelaxationProgress progress;
    const double began = thread_seconds();
    relax(*loop, stop, {}, progress, endless);
    seconds.push_back(thread_seconds() - began);
    sweeps += static_cast<double>(progress.trials) / loop->n_spheres();
    height += loop->mean_height();
  }
};

Side side_of(const Course& course, Sampler sampler) {
  const StreamKey key = stream_key(seed, static_cast<std::uint64_t>(sampler), 1, Purpose::trials);
  return {make_trial_loop(course.container, course.move, key, best_instruction_set(), sampler), {}};
}

double sum(const std::vector<double>& values) {
  double total = 0;
  for (const double value : values) total += value;
  return total;
}

void report(const Course& course, const Side& exhaustive, const Side& rejection_free) {
  const auto taps = static_cast<double>(exhaustive.seconds.size());
  const double ratio = sum(exhaustive.seconds) / sum(rejection_free.seconds);
  std::vector<double> ratios;
  for (std::size_t k = 0; k < exhaustive.seconds.size(); ++k) {
    ratios.push_back(exhaustive.seconds[k] / rejection_free.seconds[k]);
  }
  const auto [least, most] = std::ranges::minmax(ratios);
  const std::string verdict =
      course.target == 0
          ? "no target"
          : fmt::format("target {}: {}", course.target, ratio >= course.target ? "pass" : "MISS");
  fmt::print(
      "{:<23} eta {:.0e}: {:.3f} against {:.3f} s a tap: {:.2f} times ({:.2f} to {:.2f}), {}\n",
      course.name, course.eta, sum(rejection_free.seconds) / taps, sum(exhaustive.seconds) / taps,
      ratio, least, most, verdict);
  for (const Side* side : {&exhaustive, &rejection_free}) {
    const TrialTally& tally = side->loop->tally();
    const auto accepted = static_cast<double>(tally.accepted);
    fmt::print(
        "    {:<10} {:6.1f} million trials/s in effect, {:.0f} sweeps per tap, <Z> {:.4f}, "
        "acceptance {:.5f}",
        side == &exhaustive ? "exhaustive" : "skipping",
        static_cast<double>(tally.trials) / sum(side->seconds) / 1e6, side->sweeps / taps,
        side->height / taps, accepted / static_cast<double>(tally.trials));
    if (side == &rejection_free) {
      fmt::print(", {:.2f} candidates and {:.2f} rows of bounds an accepted step",
                 static_cast<double>(tally.candidates) / accepted,
                 static_cast<double>(tally.bound_rows) / accepted);
    }
    fmt::print("\n");
  }
  std::fflush(stdout);
}

void compare(const Course& course, int taps) {
  RandomStream start_random(stream_key(seed, 0, 0, Purpose::start));
  RandomStream tap_random(stream_key(seed, 0, 0, Purpose::tap));
  Packing bed = make_start(SteepestDescentPour{}, course.container, course.n_spheres, start_random);
  Side exhaustive = side_of(course, Sampler::exhaustive);
  Side rejection_free = side_of(course, Sampler::rejection_free);
  const Stop stop{MeanHeightStop{.eta = course.eta, .every_sweeps = 100}, 100'000'000};
  for (int k = 0; k < taps; ++k) {
    excite(bed, course.tap, tap_random);
    exhaustive.relax_tap(bed, stop);
    rejection_free.relax_tap(bed, stop);
    exhaustive.loop->store(bed);
  }
  report(course, exhaustive, rejection_free);
}

}  // namespace
}  // namespace jostle::bench

int main(int argc, char** argv) {
  using namespace jostle;
  using namespace jostle::bench;
  const int taps = argc > 1 ? std::atoi(argv[1]) : 5;
  if (argc > 2 || taps < 1) {
    fmt::print(stderr, "bench_samplers [TAPS]: sums over so many taps, by default 5\n");
    return 2;
  }
  fmt::print("instruction set {}, sums of {} taps, processor time\n", name(best_instruction_set()),
             taps);
  for (const Course& course : courses) compare(course, taps);
}
