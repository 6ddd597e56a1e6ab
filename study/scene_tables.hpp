#pragma once

#include <string>

namespace jostle {

/// What a complete results file ends with: makes, prints briefly (unless quiet) and stores the
/// fits, the analyses and the structure that its scene asks for. Throws ResultsError.
void make_scene_tables(const std::string& results, int threads, bool quiet);

}  // namespace jostle
