#pragma once

#include <string>

namespace jostle {

/// Refuses, with BadInput, what no file can replace: a folder, a pipe, a device, a descriptor such
/// as /dev/stdout. `example` is a file's name to choose instead.
void require_replaceable(const std::string& output, const std::string& example);

}  // namespace jostle
