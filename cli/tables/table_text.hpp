#pragma once

#include <string>

#include "cli/tables/layout.hpp"
#include "ensemble/analysis/table.hpp"

namespace jostle::inline cli {

/// A table for people: its name, its result, other notes, single values with their errors
/// (with_half_widths), then columns, one block per set of axes. Only the columns and rows that fit;
/// omitted ones are named.
std::string table_text(const Table& table, const Layout& layout);

}  // namespace jostle::inline cli
