#pragma once

#include <string>

#include "cli/tables/layout.hpp"
#include "ensemble/analysis/table.hpp"

namespace jostle::inline cli {

/// A table for people: its name, what was found, its other notes, single values with their errors
/// (with_half_widths), then columns, one block a set of axes. Of few columns those that have room,
/// of short blocks; what is not shown is named.
std::string table_text(const Table& table, const Layout& layout);

}  // namespace jostle::inline cli
