#pragma once

#include <span>
#include <string>

#include "config/json/json.hpp"
#include "ensemble/analysis/table.hpp"
#include "results/study.hpp"

namespace jostle::inline cli {

/// Stores the tables in `group` of a results file. A file that cannot be changed, as in an archive,
/// still gives its tables: a word on stderr says that they are not stored.
void keep_tables(const std::string& path, const std::string& group, std::span<const Table> tables,
                 const Provenance& by);

/// Puts the text into a file, whole or not at all, or into a pipe or a device. Throws ResultsError.
void write_text(const std::string& path, const std::string& text);

/// Who made what is printed.
Json provenance_json(const Provenance& by);

}  // namespace jostle::inline cli
