#pragma once

#include <span>
#include <string>

#include "results/export/particle_columns.hpp"

namespace jostle::inline results {

/// Frames in LAMMPS's text dump format, the tap as the time step; ids count from 1. The box
/// reaches from the floor to the top of the highest sphere, around a cylinder's footprint.
/// Numbers read back to the same bits. https://docs.lammps.org/dump.html
std::string lammps_dump_text(std::span<const ExportedFrame> frames);

}  // namespace jostle::inline results
