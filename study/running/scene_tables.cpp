#include "study/running/scene_tables.hpp"

#include <fmt/format.h>

#include <numeric>

#include "config/scene.hpp"
#include "results/file/tables.hpp"
#include "study/bad_input.hpp"
#include "study/provenance.hpp"
#include "study/tables/analyse.hpp"
#include "study/tables/motion.hpp"
#include "study/tables/points/sweep.hpp"
#include "study/tables/structure.hpp"
#include "study/tables/target_precision.hpp"

namespace jostle::inline study {
namespace {

std::vector<std::uint32_t> all_points(const ResultsFile& file) {
  std::vector<std::uint32_t> points(file.study().points.size());
  std::iota(points.begin(), points.end(), 0u);
  return points;
}

std::vector<Table> fits_of(const ResultsFile& file, const Scene& scene, int threads,
                           TablesObserver& observer) {
  const FitManner manner{.resampling = {.threads = threads}};
  std::vector<Table> tables;
  for (const FittedCurve& fitted :
       scene_fits(file, scene.fits, manner, [&](const auto& made) { observer.fitted(made); })) {
    for (Table& table : fit_tables(fitted, manner)) tables.push_back(std::move(table));
  }
  return tables;
}

std::vector<Table> analyses_of(const ResultsFile& file, const Scene& scene, int threads,
                               std::vector<Table> fits) {
  const MadeTables made{std::move(fits), analyse(file, all_points(file), scene.analyse, threads)};
  const ResultsFile* const files[] = {&file};
  std::vector<Table> tables = made.analyses;
  for (Table& table : sweep_tables(files, made, scene.analyse.sweep)) {
    tables.push_back(std::move(table));
  }
  return tables;
}

/// Those before one that cannot be made are in `groups` all the same.
void make_tables(const ResultsFile& file, const Scene& scene, int threads, TablesObserver& observer,
                 std::vector<TableGroup>& groups) {
  if (requested_tables(scene).empty()) return;  // a program that makes none relies on this list
  if (!scene.until.targets.empty()) {
    groups.push_back({"analysis", {precision_status(file, scene.until).table}});
  }
  std::vector<Table> fits;
  if (!scene.fits.empty()) {
    fits = fits_of(file, scene, threads, observer);
    groups.push_back({"fits", fits});
  }
  if (!scene.analyse.empty()) {  // sweeps are drawn of fits too
    groups.push_back({"analysis", analyses_of(file, scene, threads, std::move(fits))});
    for (const Table& table : groups.back().tables) observer.analysed(table);
  }
  if (scene.motion) {
    groups.push_back({"analysis", motion_of(file, all_points(file))});
    for (const Table& table : groups.back().tables) observer.analysed(table);
  }
  if (scene.structure.empty()) return;
  try {
    groups.push_back(
        {"structure", structure_of(file, all_points(file), scene.structure, {}, threads)});
  } catch (const BadInput& refusal) {  // the run is stored and stays so
    return observer.without_structure(refusal.what());
  }
  for (const Table& table : groups.back().tables) observer.analysed(table);
}

void store(const ResultsFile& file, const std::vector<TableGroup>& groups, int threads,
           const Patience& patience) {
  if (groups.empty()) return;
  store_tables(file.path(), groups, provenance_of_this_run(fmt::to_string(threads)), patience,
               StoredResults::replaced, file.data_version());
}

}  // namespace

std::vector<std::string> store_scene_tables(const ResultsFile& file, int threads,
                                            TablesObserver& observer, const Patience& patience) {
  const ParsedScene parsed = parse_scene(file.study().resolved_scene);
  std::vector<TableGroup> groups;
  if (parsed.scene) {
    try {
      make_tables(file, *parsed.scene, threads, observer, groups);
    } catch (...) {
      store(file, groups, threads, patience);
      throw;
    }
    store(file, groups, threads, patience);
  }
  std::vector<std::string> names;
  for (const TableGroup& group : groups) {
    for (const Table& table : group.tables) names.push_back(group.name + "/" + table.name);
  }
  return names;
}

}  // namespace jostle::inline study
