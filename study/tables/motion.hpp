#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ensemble/analysis/table.hpp"
#include "results/file/results_file.hpp"

namespace jostle::inline study {

/// The motion of spheres at the given sweep points, point_PPPP/motion/displacement, overlap and
/// layers, of those whose scene asks for it. Throws BadInput where none does.
std::vector<Table> motion_of(const ResultsFile& file, std::span<const std::uint32_t> points);

/// True if a sweep point of the file follows the motion.
bool follows_motion(const ResultsFile& file);

}  // namespace jostle::inline study
