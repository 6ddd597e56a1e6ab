#pragma once

#include <string>

namespace jostle {

/// The path of tests/data/NAME. Only one source knows the folders, so that a compiler cache takes
/// the others as the same wherever they are built.
std::string test_data(const std::string& name);

/// The path of NAME in the sources.
std::string source_file(const std::string& name);

}  // namespace jostle
