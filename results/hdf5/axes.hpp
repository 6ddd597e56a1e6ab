#pragma once

#include <string>
#include <vector>

#include "results/hdf5/handle.hpp"

// Dimension scales as HDF5's high-level library keeps them, read without it: it trusts what it
// reads. https://support.hdfgroup.org/documentation/hdf5/latest/group___h5_d_s.html
namespace jostle::inline results {

/// True if a dataset is an axis.
bool is_axis(hid_t dataset);

/// Where in the file the axes of a dataset lie: for every dimension the addresses of its axes;
/// empty for an axis itself and for what has none. Throws Hdf5Error.
std::vector<std::vector<haddr_t>> axes_of(hid_t dataset);

}  // namespace jostle::inline results
