#pragma once

#include <string>

namespace jostle::inline cli {

/// What `jostle --version` prints: version, revision, compiler and the libraries as linked.
std::string version_text();

}  // namespace jostle::inline cli
