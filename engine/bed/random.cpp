#include "engine/bed/random.hpp"

#include <algorithm>

#include "engine/bed/philox.hpp"

namespace jostle::inline engine {

namespace {

constexpr std::uint64_t mix(std::uint64_t h) {
  h += 0x9e3779b97f4a7c15;
  h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9;
  h = (h ^ (h >> 27)) * 0x94d049bb133111eb;
  return h ^ (h >> 31);
}

}  // namespace

StreamKey stream_key(std::uint64_t seed, std::uint64_t sweep_point, std::uint64_t realization,
                     Purpose purpose) {
  std::uint64_t h = 0;
  for (const std::uint64_t word :
       {seed, sweep_point, realization, static_cast<std::uint64_t>(purpose)}) {
    h = mix(h ^ word);
  }
  return StreamKey{h};
}

std::uint64_t RandomStream::next64() {
  // Two 64-bit numbers a block.
  const auto words = philox_block(key_, position_ >> 1);
  const std::size_t half = 2 * (position_ & 1);
  ++position_;
  return (static_cast<std::uint64_t>(words[half + 1]) << 32) | words[half];
}

double RandomStream::uniform() {
  // The sum has 53 bits, too: its last value would round up to 1.
  constexpr double largest = 1 - 0x1p-53;
  return std::min((static_cast<double>(next64() >> 11) + 0.5) * 0x1p-53, largest);
}

std::uint64_t RandomStream::integer_below(std::uint64_t n) {
  // Lemire's multiplication with rejection: exactly uniform.
  __extension__ using Wide = unsigned __int128;
  const std::uint64_t least = (0 - n) % n;
  for (;;) {
    const Wide product = static_cast<Wide>(next64()) * n;
    if (static_cast<std::uint64_t>(product) >= least) {
      return static_cast<std::uint64_t>(product >> 64);
    }
  }
}

}  // namespace jostle::inline engine
