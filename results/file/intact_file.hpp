#pragma once

#include <string>

#include "results/file/results_file.hpp"

// A results file is intact if its seal verifies, or, if another program opened it for writing and
// thereby removed the seal, if its contents verify. All throw ResultsError.
namespace jostle::inline results {

/// Refuses what is not as jostle wrote it, naming what differs. `known_as`: the file's name in
/// errors.
void require_intact(const std::string& path, const std::string& known_as, Verify verify);

/// Copies a file into one that is going to replace it, and refuses it likewise.
class TemporaryFile;
void copy_intact(const std::string& path, TemporaryFile& copy);

}  // namespace jostle::inline results
