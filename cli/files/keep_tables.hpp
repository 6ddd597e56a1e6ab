#pragma once

#include <optional>
#include <span>
#include <string>

#include "config/json/json.hpp"
#include "ensemble/analysis/table.hpp"
#include "results/content/study.hpp"
#include "results/disk/publish.hpp"
#include "results/export/export.hpp"
#include "results/file/results_file.hpp"
#include "results/locks/patience.hpp"

namespace jostle::inline cli {

/// Stores the tables of one request in `group` of a results file, if it still holds the data of
/// which they were `made` (empty: whatever it holds), in place of tables of the same names. If no
/// table of the request has results, stored tables with results stay, and standard error names
/// them. Returns false where nothing could be stored: standard error gives the reason.
[[nodiscard]] bool keep_tables(const std::string& path, const std::string& group,
                               std::span<const Table> tables, const Provenance& provenance,
                               const Patience& patience, const std::optional<DataVersion>& made);

/// Puts the text into a file, whole or not at all, or into a pipe or a device. Throws ResultsError.
void write_text(const std::string& path, const std::string& text, ExistingFile existing);

/// Puts each of the texts into its file, or, where one cannot be, none: what was there stays. Pipes
/// and devices are written last. Throws ResultsError.
void write_together(std::span<const ExportedFile> files, ExistingFile existing);

/// Who made what is printed.
Json provenance_json(const Provenance& provenance);

}  // namespace jostle::inline cli
