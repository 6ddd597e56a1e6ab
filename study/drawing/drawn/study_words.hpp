#pragma once

#include <string>

#include "results/content/study.hpp"

// Describes the simulation in the words of pages and figures.
namespace jostle::inline study {

/// "512 spheres in periodic sides, 8 x 8 diameters".
std::string bed_words(const StudyPoint& point);

/// The bed and the number of realizations, so that a caption is complete by itself: "512 spheres in
/// periodic sides, 8 x 8 diameters; 8 realizations". The text mentions beds that change with the
/// sweep.
std::string study_words(const Study& study);

}  // namespace jostle::inline study
