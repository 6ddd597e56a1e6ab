#pragma once

#include <string_view>

#include "results/content/record.hpp"
#include "results/content/study.hpp"
#include "results/file/study_writer.hpp"

// Conditions that every reader requires, and that only files of other programs violate. All throw
// Hdf5Error.
namespace jostle::inline results {

/// Counts, sizes and names of a study, and the shares and processes of its run.
void validate(const Study& study, const FileProvenance& provenance);

/// State from which a realization resumes.
void validate(const RealizationState& state, const StudyPoint& point);

/// Brackets within brackets in a JSON text, at most; of a text that is no JSON, no matter what.
std::size_t nesting_of(std::string_view json);

}  // namespace jostle::inline results
