#pragma once

#include <Random123/philox.h>

#include <array>
#include <cstdint>

#include "engine/bed/random.hpp"

// Random123's header brings all intrinsics of the processor, a second of every source that sees it.
namespace jostle::inline engine {

/// The block of four 32-bit words with number (block, lane) of a stream, by Philox4x32-10: Salmon
/// et al., SC11, doi:10.1145/2063384.2063405.
inline std::array<std::uint32_t, 4> philox_block(StreamKey key, std::uint64_t block,
                                                 std::uint32_t lane = 0) {
  const auto k = static_cast<std::uint64_t>(key);
  const philox4x32_ctr_t counter = {
      {static_cast<std::uint32_t>(block), static_cast<std::uint32_t>(block >> 32), lane, 0}};
  const philox4x32_key_t philox_key = {
      {static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(k >> 32)}};
  const philox4x32_ctr_t words = philox4x32_R(10, counter, philox_key);
  return {words.v[0], words.v[1], words.v[2], words.v[3]};
}

}  // namespace jostle::inline engine
