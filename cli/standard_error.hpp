#pragma once

#include <cstdio>
#include <string>

namespace jostle {

/// Writes to standard error. Where that goes to a full disk or a closed terminal the text is lost,
/// and not the run: fmt::print would throw.
inline void print_to_standard_error(const std::string& text) {
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace jostle
