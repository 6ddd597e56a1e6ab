#pragma once

#include <string>

namespace jostle::inline config {

/// What is wrong with one value of a scene.
struct Fault {
  std::string pointer;  // JSON pointer to the value (RFC 6901); "" is the whole scene
  std::string message;  // what, why, the allowed range or keys, and a did-you-mean
  bool operator==(const Fault&) const = default;
};

}  // namespace jostle::inline config
