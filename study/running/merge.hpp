#pragma once

#include <optional>
#include <span>
#include <string>

#include "results/content/study.hpp"

namespace jostle::inline study {

/// The study of files whose scenes differ in the values of their sweeps alone; nothing where they
/// are shares of one run: the last argument of merge_files(). Throws ResultsError where they differ
/// in more.
std::optional<Study> joined_study(std::span<const std::string> files);

}  // namespace jostle::inline study
