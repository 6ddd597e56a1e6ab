#pragma once

#include <string>

namespace jostle::inline cli {

/// Text of `jostle --version`: version, revision, compiler and the libraries as linked.
std::string version_text();

}  // namespace jostle::inline cli
