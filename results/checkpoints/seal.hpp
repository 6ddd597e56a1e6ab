#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>

// A results file ends with a line that holds the SHA-256 of everything before it. HDF5 does not
// look beyond its own end, and a damaged file is refused before HDF5 sees it.
namespace jostle::inline results {

/// Appends the line to a file. Throws ResultsError.
void seal(const std::string& path);

/// Throws ResultsError where the file does not end as one that is whole. Reads its ends alone.
void require_seal(const std::string& path);

/// Throws ResultsError saying what is wrong with the file: missing, not HDF5, truncated, changed.
/// `take` is given the whole file, piece by piece, before that is known: one reading is enough to
/// verify and to copy.
void verify_seal(const std::string& path,
                 const std::function<void(std::span<const std::byte>)>& take = {});

}  // namespace jostle::inline results
