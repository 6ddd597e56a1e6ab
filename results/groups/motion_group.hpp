#pragma once

#include <span>
#include <string>

#include "ensemble/motion/motion_records.hpp"
#include "results/hdf5/handle.hpp"

// /motion/<point>: what was found of the motion, by origin, lag and realization.
namespace jostle::inline results {

/// `kinds`: names of the kinds of a mixture.
void write_motion_records(hid_t group, const MotionRecords& records,
                          std::span<const std::string> kinds);

/// Fills the values of records that have the settings of the file. Throws Hdf5Error.
void read_motion_records(hid_t group, MotionRecords& records);

}  // namespace jostle::inline results
