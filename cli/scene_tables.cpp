#include "cli/scene_tables.hpp"

#include "cli/analyse_run.hpp"
#include "cli/fit_run.hpp"
#include "cli/structure_run.hpp"

namespace jostle {

void make_scene_tables(const std::string& results, int threads, bool quiet) {
  make_scene_fits(results, threads, quiet);
  make_scene_analyses(results, threads, quiet);  // sweeps are drawn of fits too
  make_scene_structure(results, threads, quiet);
}

}  // namespace jostle
