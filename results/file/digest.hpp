#pragma once

#include <hdf5.h>

#include <string>

namespace jostle::inline results {

/// The SHA-256 of digest_of(), of an open HDF5 file that may be none of results. Throws Hdf5Error.
std::string data_digest(hid_t file);

}  // namespace jostle::inline results
