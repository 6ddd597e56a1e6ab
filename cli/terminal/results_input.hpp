#pragma once

#include <span>
#include <string>
#include <vector>

#include "results/results_file.hpp"

namespace CLI {
class App;
}

// What commands read results from.
namespace jostle {

/// By its first bytes.
bool is_results_file(const std::string& path);

/// Whether two names are of one file, there already or not.
bool is_same_file(const std::string& a, const std::string& b);

/// What is read of a run that goes on or was killed: its file alone, or its checkpoints too.
enum class Live { no, yes };

/// The flag --live.
void add_live(CLI::App& command, Live& live);

/// A results file whose data are wanted. Throws BadInput for a run that has none yet; says on
/// stderr where it is unfinished. Throws ResultsError for the file.
ResultsFile open_results(const std::string& path, Live live = Live::no);

/// Throws BadInput where a file is named twice: it would count as more data than there are.
void require_different(std::span<const std::string> paths);

/// The sweep points that `wanted` names, by number or as "pointer=value"; all where it is empty.
/// Throws BadInput naming what there is.
std::vector<std::uint32_t> chosen_points(const Study& study, const std::string& wanted);

}  // namespace jostle
