// Sphere steps per second of discrete elements: of a settled bed of 3456 spheres, the box of Rosato
// et al. 2010, at rest and in the midst of a tap; of two beds on two threads; of larger beds.
//   bench_grains [FOLDER]   the laws; writes bed and runs for LAMMPS into FOLDER, for
//                           bench/grains_against_lammps.py, which compares them
//   bench_grains threads    one bed on one thread, two beds on two
//   bench_grains sizes      beds of a thousand to a hundred thousand spheres
//   bench_grains mixtures   spheres of several sizes beside equal ones
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <numbers>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "bench/stopwatch.hpp"
#include "engine/bed/mixture.hpp"
#include "engine/discrete_element/grain_loop.hpp"
#include "engine/starts/starts.hpp"

namespace {

using namespace jostle;

constexpr std::uint32_t n_spheres = 3456;
constexpr std::uint64_t steps = 1000;
// A thrown bed flies for some seven of these; after ten it has landed.
constexpr int turns = 4, flight_turns = 6, tap_turns = 16, thread_turns = 9;
const PeriodicBox box{12, 12};

struct Law {
  const char* name;
  ContactLaw contact;
};

ReducedSettings settings_of(const ContactLaw& contact) {
  DiscreteElement engine;
  engine.spheres = contact;
  engine.steps_per_contact = 40;  // steps per contact, for every law
  return reduced(engine);
}

/// The tap of Rosato et al. at a dimensionless acceleration of 2.
FloorMotion tap_of(const ReducedSettings& units) {
  return {0.4413, 7.5 * units.seconds, 1};
}

double seconds_of(GrainLoop& loop, std::uint64_t count) {
  const double began = bench::thread_seconds();
  loop.run(count);
  return bench::thread_seconds() - began;
}

/// Millions of sphere steps per second.
double rate(GrainLoop& loop, std::uint64_t count) {
  return 1e-6 * static_cast<double>(loop.n_spheres() * count) / seconds_of(loop, count);
}

/// A poured bed that has come to rest under the law.
GrainLoop settled(const Container& container, const ReducedSettings& units, std::uint32_t n,
                  std::uint64_t count) {
  RandomStream random(stream_key(1, 0, 0, Purpose::start));
  GrainLoop loop(container, units);
  loop.load(make_start(SteepestDescentPour{}, container, n, random));
  loop.run(count);
  return loop;
}

struct Mixture {
  const char* name;
  std::vector<MixtureKind> kinds;  // empty: equal spheres, by the kernels that are made for them
};

std::vector<Mixture> mixtures() {
  const auto kind = [](const char* name, std::uint32_t count, DiameterLaw diameter) {
    return MixtureKind{.name = name, .count = count, .diameter = std::move(diameter)};
  };
  constexpr std::uint32_t half = n_spheres / 2;
  const FixedDiameter small{1};
  return {
      {"equal spheres", {}},
      {"diameter 1, as sizes", {kind("all", n_spheres, small)}},
      {"lognormal, 10 %", {kind("all", n_spheres, LognormalDiameter{1, 0.1})}},
      {"1 and 1.4, half each", {kind("s", half, small), kind("l", half, FixedDiameter{1.4})}},
      {"one intruder of 5", {kind("s", n_spheres - 1, small), kind("l", 1, FixedDiameter{5})}},
      {"four of 10", {kind("s", n_spheres - 4, small), kind("l", 4, FixedDiameter{10})}},
  };
}

/// Like settled(), for a mixture in a footprint wide enough for it.
GrainLoop settled_mixture(const Mixture& mixture, const ContactLaw& contact, std::uint64_t count) {
  RandomStream diameters(stream_key(1, 0, 0, Purpose::sizes));
  RandomStream places(stream_key(1, 0, 0, Purpose::start));
  StartSpheres spheres{n_spheres};
  if (!mixture.kinds.empty()) spheres.sizes = draw_sizes(mixture.kinds, diameters);
  const double width = mixture.kinds.empty() || range_of(mixture.kinds).greatest < 6 ? 12 : 21;
  const Packing bed = make_start(SteepestDescentPour{}, PeriodicBox{width, width}, spheres, places);
  DiscreteElement engine;
  engine.spheres = contact;
  engine.steps_per_contact = 40;
  GrainLoop loop(bed.container, reduced(engine, lightest_masses(bed)), best_instruction_set(),
                 bed.sizes);
  loop.load(bed);
  loop.run(count);
  return loop;
}

/// The speed at which the floor of a tap throws it.
double throwing_speed(const ReducedSettings& units) {
  const FloorMotion tap = tap_of(units);
  return tap.amplitude * 2 * std::numbers::pi * tap.frequency;
}

/// The bed with every sphere at this speed upwards, its contacts as new: what LAMMPS begins with.
GrainLoop thrown(const GrainLoop& bed, const ReducedSettings& units) {
  Packing packing;
  bed.store(packing);
  const Vec3 velocity = {0, 0, throwing_speed(units)};
  GrainLoop::State state;
  for (const Vec3& centre : packing.centres)
    state.grains.push_back({centre, velocity, {}, velocity, {}});
  GrainLoop loop(box, units);
  loop.restore(state);
  return loop;
}

/// The bed and three runs: at rest, thrown while it flies, and thrown until it rests again.
void write_for_lammps(const std::string& folder, const GrainLoop& loop,
                      const ReducedSettings& units) {
  Packing bed;
  loop.store(bed);
  std::ofstream data(folder + "/bed.data");
  data << fmt::format(
      "a settled bed\n\n{} atoms\n1 atom types\n0 {} xlo xhi\n0 {} ylo yhi\n-1 80 zlo zhi\n\n"
      "Atoms # sphere\n\n",
      n_spheres, box.width_x, box.width_y);
  constexpr double density = 1 / sphere_volume;  // mass 1
  for (std::size_t i = 0; i < bed.centres.size(); ++i) {
    const Vec3 r = bed.centres[i];
    data << fmt::format("{} 1 1.0 {} {} {} {}\n", i + 1, density, r.x, r.y, r.z);
  }
  const auto law = [](const LawConstants& constants, double mass) {
    return fmt::format("{} {} {} {} {} 1", constants.stiffness, constants.tangential,
                       constants.damping / mass, constants.shear_damping / mass,
                       constants.friction);
  };
  const auto write = [&](const char* name, const std::string& throwing, std::uint64_t count) {
    std::ofstream input(fmt::format("{}/{}", folder, name));
    input << fmt::format(
        "units lj\natom_style sphere\nboundary p p f\nnewton off\ncomm_modify vel yes\n"
        "read_data bed.data\npair_style gran/hooke/history {}\npair_coeff * *\n"
        "neighbor 0.05 bin\nneigh_modify delay 0 every 1 check yes\nfix 1 all nve/sphere\n"
        "fix 2 all gravity 1.0 vector 0 0 -1\n"
        "fix 3 all wall/gran hooke/history {} zplane 0.0 NULL\ntimestep {}\nthermo {}\n{}run {}\n",
        law(units.spheres, 0.5), law(units.floor, 1), units.time_step, count, throwing, count);
  };
  write("in.rest", "", steps * turns);
  const std::string throwing =
      fmt::format("velocity all set NULL NULL {}\n", throwing_speed(units));
  write("in.flight", throwing, steps * flight_turns);
  write("in.thrown", throwing, steps * tap_turns);
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

void compare_laws(const char* folder) {
  const std::vector<Law> laws = {{"linear_spring_dashpot", LinearSpringDashpot{}},
                                 {"walton_braun", WaltonBraun{}},
                                 {"walton_braun, no friction", WaltonBraun{.friction = 0}}};
  for (const auto& [name, contact] : laws) {
    const ReducedSettings units = settings_of(contact);
    GrainLoop loop = settled(box, units, n_spheres, 20'000);
    if (folder != nullptr && std::holds_alternative<LinearSpringDashpot>(contact))
      write_for_lammps(folder, loop, units);
    GrainLoop flying = thrown(loop, units), landing = flying;
    const double at_rest = rate(loop, steps * turns);
    loop.begin_motion(tap_of(units));
    fmt::print("{:<26} at rest {:6.2f}   in flight {:6.2f}   thrown {:6.2f}   in a tap {:6.2f}\n",
               name, at_rest, rate(flying, steps * flight_turns), rate(landing, steps * tap_turns),
               rate(loop, steps * tap_turns));
  }
}

/// Processor time a bed, and elapsed time, of as many beds as threads.
struct Times {
  double processor, elapsed;
};
Times run_on_threads(std::vector<GrainLoop>& beds) {
  std::vector<double> processor(beds.size());
  const auto began = std::chrono::steady_clock::now();
  std::vector<std::thread> threads;
  for (std::size_t k = 0; k < beds.size(); ++k)
    threads.emplace_back([&, k] { processor[k] = seconds_of(beds[k], steps * turns); });
  for (std::thread& thread : threads) thread.join();
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - began;
  return {*std::ranges::max_element(processor), elapsed.count()};
}

void compare_threads() {
  const ReducedSettings units = settings_of(WaltonBraun{});
  std::vector<GrainLoop> two(2, settled(box, units, n_spheres, 20'000));
  std::vector<GrainLoop> single(1, two[0]);
  std::vector<double> processor, elapsed;
  for (int turn = 0; turn < thread_turns; ++turn) {
    const Times alone = run_on_threads(single), concurrent = run_on_threads(two);
    processor.push_back(alone.processor / concurrent.processor);
    elapsed.push_back(alone.elapsed / concurrent.elapsed);
  }
  const auto print = [](const char* label, const std::vector<double>& found) {
    fmt::print("two beds on two threads, efficiency by {} time: {:.3f} ({:.3f} to {:.3f})\n", label,
               median(found), *std::ranges::min_element(found), *std::ranges::max_element(found));
  };
  print("processor", processor);
  print("elapsed", elapsed);
}

void compare_sizes() {
  const ReducedSettings units = settings_of(WaltonBraun{});
  for (const std::uint32_t n : {1000u, 3456u, 10'000u, 30'000u, 100'000u}) {
    const double width = 12 * std::sqrt(n / 3456.0);
    GrainLoop loop = settled(PeriodicBox{width, width}, units, n, 10'000);
    std::vector<double> rest;
    for (int turn = 0; turn < turns; ++turn)
      rest.push_back(rate(loop, std::max<std::uint64_t>(100, n_spheres * steps / n)));
    fmt::print("{:>7} spheres {:6.2f} ({:.2f} to {:.2f})   {:5.0f} bytes per sphere\n", n,
               median(rest), *std::ranges::min_element(rest), *std::ranges::max_element(rest),
               static_cast<double>(loop.bytes()) / static_cast<double>(n));
  }
}

void compare_mixtures() {
  for (const auto& [law, contact] : std::vector<Law>{
           {"walton_braun", WaltonBraun{}}, {"linear_spring_dashpot", LinearSpringDashpot{}}}) {
    struct Side {
      const char* name;
      GrainLoop loop;
      std::vector<double> rates;
    };
    std::vector<Side> sides;
    for (const Mixture& mixture : mixtures())
      sides.push_back({mixture.name, settled_mixture(mixture, contact, 20'000), {}});
    for (int turn = 0; turn < thread_turns; ++turn)
      for (Side& side : sides) side.rates.push_back(rate(side.loop, steps));
    for (const Side& side : sides) {
      fmt::print("{:<22} {:<22} {:6.2f}, ratio {:.2f}\n", law, side.name, median(side.rates),
                 median(side.rates) / median(sides.front().rates));
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string selection = argc > 1 ? argv[1] : "";
  fmt::print("instruction set {}, million sphere steps per second of processor time\n",
             name(best_instruction_set()));
  if (selection == "threads") {
    compare_threads();
  } else if (selection == "sizes") {
    compare_sizes();
  } else if (selection == "mixtures") {
    compare_mixtures();
  } else {
    compare_laws(argc > 1 ? argv[1] : nullptr);
  }
}
