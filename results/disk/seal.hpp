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

/// `lost`: the line is missing, and the file ends where its superblock ends it. HDF5 leaves every
/// file in this state that was opened for writing, changed or not; only the contents can show that
/// they are the old ones (file/contents.hpp).
enum class SealState { whole, lost };

/// Reads the ends of the file alone. Throws ResultsError where it is no HDF5 file, or where it ends
/// neither with the line nor at HDF5's end.
SealState seal_state(const std::string& path);

/// Verifies the checksum, where there is one. Throws ResultsError that describes the fault of the
/// file: missing, not HDF5, truncated, changed. `take` is given the whole file, piece by piece,
/// before that is known: one reading is enough to verify and to copy.
[[nodiscard]] SealState verify_seal(
    const std::string& path, const std::function<void(std::span<const std::byte>)>& take = {});

/// True if a file has HDF5's signature, behind a user block too. Throws ResultsError where it
/// cannot be read.
bool is_hdf5_file(const std::string& path);

}  // namespace jostle::inline results
