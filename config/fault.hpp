#pragma once

#include <string>

namespace jostle::inline config {

/// A fault of one value of a scene.
struct Fault {
  std::string pointer;  // JSON pointer to the value (RFC 6901); "" is the whole scene
  std::string
      message;  // the fault, the reason, the allowed range or keys, and the closest valid name
  bool operator==(const Fault&) const = default;
};

}  // namespace jostle::inline config
