#pragma once

#include <hdf5.h>

#include <span>
#include <string>
#include <vector>

// /provenance/contents: a hash of every item of the file (content_walk.hpp), in one dataset for the
// root and one for each group below it. The seal is over bytes, which another program may move;
// these hashes show if the contents are unchanged since jostle wrote them, and name the changes.
namespace jostle::inline results {

/// Hashes all of a file that is open for writing. Throws Hdf5Error.
void write_contents(hid_t file);

/// Hashes some of the groups below the root anew, and the root, in a file whose other groups are as
/// they were; of a file that has no hashes, all. Throws Hdf5Error.
void update_contents(hid_t file, std::span<const std::string> groups);

/// Describes what differs from the hashes, in words, a place each; empty where all is. Throws
/// Hdf5Error where there are no hashes, and for what no results file has.
std::vector<std::string> changed_contents(hid_t file);

/// The SHA-256 of digest_of(), of an open HDF5 file that may be none of results. Throws Hdf5Error.
std::string data_digest(hid_t file);

}  // namespace jostle::inline results
