#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace jostle::inline ensemble {

/// A count with what it counts: "1 sphere", "2 spheres".
inline std::string counted(std::uint64_t n, std::string_view singular) {
  std::string text = std::to_string(n);
  text.append(" ").append(singular);
  if (n != 1) text += 's';
  return text;
}

}  // namespace jostle::inline ensemble
