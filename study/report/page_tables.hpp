#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "config/json/json.hpp"
#include "results/results_file.hpp"

namespace jostle::inline study {

/// The derived tables of a file, a list of page_table(). At most about `room` numbers and texts:
/// they are thinned along their axes, and then left out at some sweep points, evenly spread. What
/// is left out is said in `left_out`.
Json page_tables(const ResultsFile& file, std::size_t room, std::vector<std::string>& left_out);

}  // namespace jostle::inline study
