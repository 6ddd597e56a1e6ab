#pragma once

#include <string>
#include <vector>

#include "cli/tables/layout.hpp"
#include "results/file/results_file.hpp"
#include "results/locks/patience.hpp"

namespace jostle::inline cli {

enum class Quiet { no, yes };

/// How much of each fit, analysis and part of structure is printed.
enum class TableDetail { summary, full };

/// How the tables that a scene requests are made and printed.
struct SceneTablesRequest {
  int threads = 1;
  Patience patience = {};  // with another process that works on the file
  Quiet quiet = Quiet::no;
  Layout layout = {};
  TableDetail detail = TableDetail::summary;
};

/// Makes the tables that the scene of a complete file requests, stores and prints them. Returns
/// their names with their groups. Throws like store_scene_tables().
std::vector<std::string> make_scene_tables(const ResultsFile& file,
                                           const SceneTablesRequest& request);

using SceneTablesMaker = decltype(make_scene_tables);

}  // namespace jostle::inline cli
