// Sphere steps a second of discrete elements: on the settled bed of 3456 spheres of Rosato et al.
// 2010, and in the midst of a tap. With a folder as its argument it also writes that bed, and the
// same run, for LAMMPS: bench/grains_against_lammps.py compares them.
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "bench/stopwatch.hpp"
#include "engine/discrete_element/grain_loop.hpp"
#include "engine/starts/starts.hpp"

namespace {

using namespace jostle;

constexpr std::uint32_t n_spheres = 3456;
constexpr std::uint64_t steps = 1000;
constexpr int turns = 4;

struct Law {
  const char* name;
  ContactLaw contact;
};

ReducedSettings settings_of(const ContactLaw& contact) {
  DiscreteElement engine;
  engine.spheres = contact;
  return reduced(engine);
}

double rate(GrainLoop& loop) {
  const double began = bench::thread_seconds();
  loop.run(steps);
  return static_cast<double>(n_spheres * steps) / (bench::thread_seconds() - began);
}

/// A poured bed that has come to rest under the law.
GrainLoop settled(const Container& box, const ReducedSettings& units) {
  RandomStream random(stream_key(1, 0, 0, Purpose::start));
  GrainLoop loop(box, units);
  loop.load(make_start(SteepestDescentPour{}, box, n_spheres, random));
  loop.run(20'000);
  return loop;
}

void write_for_lammps(const std::string& folder, const GrainLoop& loop,
                      const ReducedSettings& units, double width) {
  Packing bed;
  loop.store(bed);
  std::ofstream data(folder + "/bed.data");
  data << fmt::format(
      "a settled bed\n\n{} atoms\n1 atom types\n0 {} xlo xhi\n0 {} ylo yhi\n0 60 zlo zhi\n\n"
      "Atoms # sphere\n\n",
      n_spheres, width, width);
  constexpr double density = 1 / sphere_volume;  // mass 1
  for (std::size_t i = 0; i < bed.centres.size(); ++i) {
    const Vec3 r = bed.centres[i];
    data << fmt::format("{} 1 1.0 {} {} {} {}\n", i + 1, density, r.x, r.y, r.z);
  }
  const auto law = [](const LawConstants& of, double mass) {
    return fmt::format("{} {} {} {} {} 1", of.stiffness, of.tangential, of.damping / mass,
                       of.shear_damping / mass, of.friction);
  };
  std::ofstream input(folder + "/in.lammps");
  input << fmt::format(
      "units lj\natom_style sphere\nboundary p p f\nnewton off\ncomm_modify vel yes\n"
      "read_data bed.data\npair_style gran/hooke/history {}\npair_coeff * *\n"
      "neighbor 0.05 bin\nneigh_modify delay 0 every 1 check yes\nfix 1 all nve/sphere\n"
      "fix 2 all gravity 1.0 vector 0 0 -1\n"
      "fix 3 all wall/gran hooke/history {} zplane 0.0 NULL\ntimestep {}\nthermo {}\nrun {}\n",
      law(units.spheres, 0.5), law(units.floor, 1), units.time_step, steps * turns, steps * turns);
}

}  // namespace

int main(int argc, char** argv) {
  const PeriodicBox box{12, 12};
  const std::vector<Law> laws = {{"linear_spring_dashpot", LinearSpringDashpot{}},
                                 {"walton_braun", WaltonBraun{}},
                                 {"walton_braun, no friction", WaltonBraun{.friction = 0}}};
  fmt::print("instruction set {}, million sphere steps a second of processor time\n",
             name(best_instruction_set()));
  for (const auto& [name, contact] : laws) {
    const ReducedSettings units = settings_of(contact);
    GrainLoop loop = settled(box, units);
    if (argc > 1 && std::holds_alternative<LinearSpringDashpot>(contact))
      write_for_lammps(argv[1], loop, units, box.width_x);
    std::vector<double> rest, tap;
    for (int turn = 0; turn < turns; ++turn) rest.push_back(rate(loop));
    loop.begin_motion({0.4413, 7.5 * units.seconds, 1});
    for (int turn = 0; turn < turns; ++turn) tap.push_back(rate(loop));
    const double at_rest = *std::ranges::max_element(rest), tapped = *std::ranges::max_element(tap);
    fmt::print("{:<26} at rest {:6.2f}   in a tap {:6.2f} (least {:.2f})\n", name, 1e-6 * at_rest,
               1e-6 * tapped, 1e-6 * *std::ranges::min_element(tap));
  }
}
