#include "study/scene_tables.hpp"

#include "study/tables/analyse.hpp"
#include "study/tables/fits.hpp"
#include "study/tables/structure.hpp"

namespace jostle {

void make_scene_tables(const std::string& results, int threads, bool quiet) {
  make_scene_fits(results, threads, quiet);
  make_scene_analyses(results, threads, quiet);  // sweeps are drawn of fits too
  make_scene_structure(results, threads, quiet);
}

}  // namespace jostle
