#pragma once

#include <string_view>

#include "results/file/study_writer.hpp"
#include "results/record.hpp"
#include "results/study.hpp"

// What every reader relies on, and what only a file that jostle did not write breaks. All throw
// Hdf5Error.
namespace jostle::inline results {

/// Counts, sizes and names of a study, and the shares and processes of its run.
void validate(const Study& study, const FileProvenance& provenance);

/// What a realization goes on from.
void validate(const RealizationState& state, const StudyPoint& point);

/// True if squares of the coordinates are numbers: a bed that is tapped before it has fallen back
/// grows without end.
bool is_position(const Vec3& centre);

/// Brackets within brackets in a JSON text, at most; of a text that is no JSON, no matter what.
std::size_t nesting_of(std::string_view json);

}  // namespace jostle::inline results
