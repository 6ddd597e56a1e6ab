#pragma once

#include <string>

#include "results/study.hpp"

// What was simulated, in the words of pages and figures.
namespace jostle::inline study {

/// "512 spheres in periodic sides, 8 x 8 diameters".
std::string bed_words(const StudyPoint& point);

/// The bed and the number of realizations, so that a caption stands alone: "512 spheres in periodic
/// sides, 8 x 8 diameters; 8 realizations". Where beds change with the sweep, it says so.
std::string study_words(const Study& study);

}  // namespace jostle::inline study
