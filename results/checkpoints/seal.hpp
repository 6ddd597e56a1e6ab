#pragma once

#include <string>

// A results file ends with a line that holds the SHA-256 of everything before it. HDF5 does not
// look beyond its own end, and a damaged file is refused before HDF5 sees it.
namespace jostle {

/// Appends the line to a file. Throws ResultsError.
void seal(const std::string& path);

/// Throws ResultsError saying what is wrong with the file: missing, not HDF5, truncated, changed.
void verify_seal(const std::string& path);

}  // namespace jostle
