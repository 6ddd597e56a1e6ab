#pragma once

#include <Random123/philox.h>

#include <array>
#include <cstdint>

// Counter-based random numbers: Philox4x32-10 (Salmon et al., SC11, doi:10.1145/2063384.2063405).
// A stream is a 64-bit key; the n-th block of a stream is a function of (key, n) alone, so a
// realization can be resumed anywhere and depends on no other.
namespace jostle::inline engine {

/// What a stream of a realization is for. The numbers are part of the results' identity.
enum class Purpose : std::uint32_t {
  start = 1,
  tap = 2,
  trials = 3,
  resampling = 4,
  start_trials = 5,
  void_points = 6
};

enum class StreamKey : std::uint64_t {};

/// The key of one stream: the words (seed, sweep_point, realization, purpose) absorbed in turn by
/// h -> mix(h ^ word), mix being SplitMix64's step (add 0x9e3779b97f4a7c15, then its finalizer).
/// sweep_point is the sweep point's id, not its index, so that adding a point changes no other.
StreamKey stream_key(std::uint64_t seed, std::uint64_t sweep_point, std::uint64_t realization,
                     Purpose purpose);

/// The block of four 32-bit words with number (block, lane) of a stream.
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

/// A stream read one number after another; `position` alone restores it.
class RandomStream {
 public:
  explicit RandomStream(StreamKey key, std::uint64_t position = 0)
      : key_(key), position_(position) {}

  /// Uniform in (0, 1), 53 bits: never 0, never 1.
  double uniform();
  /// Uniform in {0, ..., n - 1}, n > 0.
  std::uint64_t below(std::uint64_t n);
  /// Numbers drawn so far.
  std::uint64_t position() const { return position_; }

 private:
  std::uint64_t next64();

  StreamKey key_;
  std::uint64_t position_;
};

}  // namespace jostle::inline engine
