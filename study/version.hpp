#pragma once

namespace jostle::inline study {

/// The version that CITATION.cff states, as "0.3.0".
const char* version();

/// The commit this was built from, "-dirty" appended where tracked files differed; "unknown" where
/// it was not built from a git checkout.
const char* git_revision();

}  // namespace jostle::inline study
