// "grains COUNT" makes time steps of grains without friction, between periodic sides and on a floor
// that rests, written out: nothing but lists, forces and motion. The excess of `cost_of_grains` is
// the price of unused effects.
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "bench/costs/cost_grains.hpp"
#include "engine/discrete_element/contact_lists.hpp"
#include "engine/discrete_element/reduced.hpp"

int main(int argc, char** argv) {
  using namespace jostle;
  if (argc != 3) return 2;
  const std::uint64_t count = std::strtoull(argv[2], nullptr, 10);
  const Packing bed = bench::stacked_grains(PeriodicBox{8, 8});
  const ReducedSettings units = reduced(bench::counted_grains(0));
  const GrainKernels kernels = avx2::grain_kernels(GrainLaw::walton_braun_smooth);
  const std::size_t n = bed.centres.size();
  std::vector<SphereRow> rows(n + 2);
  for (std::size_t i = 0; i < n; ++i)
    rows[i] = {bed.centres[i].x, bed.centres[i].y, bed.centres[i].z};
  rows[n].z = -1e3;
  rows[n + 1].z = -2e3;
  std::vector<double> spins(n + 2), dissipated(2 * n);
  std::vector<std::uint32_t> numbers(n);
  std::iota(numbers.begin(), numbers.end(), 0u);
  ContactLists lists(bed.container, kernels.n_history);
  lists.find_far({rows.data(), n}, numbers);
  lists.find_near({rows.data(), n}, 0);
  SphereArrays spheres{.n = n,
                       .rows = rows.data(),
                       .spin_z = spins.data(),
                       .dissipated = dissipated.data(),
                       .begin = lists.begin().data(),
                       .slot = lists.slots().data(),
                       .action = lists.action()};
  const ContactArrays pairs = lists.pairs(), floor = lists.floor();
  double path = 0;
  for (std::uint64_t step = 0; step < count; ++step) {
    lists.measure_sides({rows.data(), n}, 0);
    kernels.pairs(pairs, spheres, units.spheres);
    kernels.sides(floor, spheres, units.floor);
    Advance advance{.time_step = units.time_step, .gravity = units.gravity};
    spheres.acted_upon = lists.acted_upon();
    kernels.advance(spheres, advance);
    path += 2 * units.time_step * std::sqrt(advance.fastest_squared);
  }
  return path < 0.5 * ContactLists::side_skin ? 0 : 1;  // else the lists no longer hold
}
