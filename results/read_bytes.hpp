#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace jostle {

/// A whole file. Throws ResultsError.
std::vector<std::byte> read_bytes(const std::string& path);

}  // namespace jostle
