#pragma once

#include <span>
#include <stdexcept>

#include "engine/bytes.hpp"
#include "engine/dynamics.hpp"

namespace jostle::inline engine {

/// Returns the result of `read` on all bytes of an engine's state. `read` throws std::out_of_range
/// where they are not its own; then this throws StateError.
template <class Read>
auto state_from(std::span<const std::byte> bytes, Read&& read) {
  try {
    ByteReader reader(bytes);
    auto state = read(reader);
    if (!reader.at_end()) throw std::out_of_range("too long");
    return state;
  } catch (const std::out_of_range&) {
    throw StateError(
        "the stored state belongs to another engine, is damaged, or was written by another version "
        "of jostle: resume with the version that wrote it");
  }
}

}  // namespace jostle::inline engine
