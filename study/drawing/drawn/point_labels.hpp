#pragma once

#include <string>
#include <vector>

#include "results/content/study.hpp"

// Names of sweep points on the page and in figures.
namespace jostle::inline study {

/// The labels that the scene gives, else short ones made of the swept values: "ε = 0.05", "Monte
/// Carlo". A value that varies with another one is left out. If two points
/// would have one label, the labels of the file are used. Empty texts where nothing is swept.
std::vector<std::string> shown_labels(const Study& study);

}  // namespace jostle::inline study
