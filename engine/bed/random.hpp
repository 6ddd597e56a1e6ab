#pragma once

#include <cstdint>

// Counter-based random numbers (philox.hpp): a stream is a 64-bit key, and its n-th number is a
// function of (key, n) alone, so a realization can be resumed anywhere and depends on no other.
namespace jostle::inline engine {

/// Purposes of the streams of a realization. The numbers are part of the results' identity.
enum class Purpose : std::uint32_t {
  start = 1,
  tap = 2,
  trials = 3,
  resampling = 4,
  start_trials = 5,
  void_points = 6,
  sizes = 7
};

enum class StreamKey : std::uint64_t {};

/// The key of one stream: the words (seed, sweep_point, realization, purpose) absorbed in turn by
/// h -> mix(h ^ word), mix being SplitMix64's step (add 0x9e3779b97f4a7c15, then its finalizer).
/// sweep_point is the sweep point's id, not its index, so that adding a point changes no other.
StreamKey stream_key(std::uint64_t seed, std::uint64_t sweep_point, std::uint64_t realization,
                     Purpose purpose);

/// A stream read one number after another; `position` alone restores it.
class RandomStream {
 public:
  explicit RandomStream(StreamKey key, std::uint64_t position = 0)
      : key_(key), position_(position) {}

  /// Uniform in (0, 1), 53 bits: never 0, never 1.
  double uniform();
  /// Uniform in {0, ..., n - 1}, n > 0.
  std::uint64_t integer_below(std::uint64_t n);
  /// Numbers drawn so far.
  std::uint64_t position() const { return position_; }

 private:
  std::uint64_t next64();

  StreamKey key_;
  std::uint64_t position_;
};

}  // namespace jostle::inline engine
