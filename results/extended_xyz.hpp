#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "engine/packing.hpp"

namespace jostle {

/// One frame of an extended XYZ file, counted from 0; the last if none is named. Throws
/// ResultsError.
Packing read_extended_xyz(const std::string& path, std::optional<std::uint64_t> frame);

}  // namespace jostle
