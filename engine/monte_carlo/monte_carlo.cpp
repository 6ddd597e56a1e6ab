#include "engine/monte_carlo/monte_carlo.hpp"

#include "engine/dropped_offsets.hpp"

namespace jostle::inline engine {

const Relaxation* relaxation_of_start(const MonteCarlo& settings, const Start& start) {
  if (settings.relax_start) return &*settings.relax_start;
  return std::holds_alternative<RandomSettle>(start) ? &settings.relax : nullptr;
}

std::vector<Column> columns(const MonteCarlo&, Spheres) {
  return {{.name = MonteCarlo::work_column,
           .units = "1",
           .long_name = "sweeps of the relaxation after the tap",
           .source = "jostle",
           .shown = Shown::mean,
           .decimals = 0},
          {.name = "acceptance",
           .units = "1",
           .long_name = "accepted trials / trials of the relaxation",
           .source = "jostle",
           .shown = Shown::mean},
          {.name = "capped",
           .units = "1",
           .long_name = "1 where the cap ended the relaxation",
           .source = "jostle",
           .shown = Shown::count,
           .if_any = "{} relaxations ended at the cap on sweeps: raise max_sweeps",
           .if_none = "no relaxation ended at the cap on sweeps"},
          dropped_offsets_column()};
}

}  // namespace jostle::inline engine
