// The random numbers of candidates. Compiled once for every instruction set, as
// rejection_free_kernels.cpp is, and under the same rule: plain arrays and static functions only.
#include <numbers>

#include "engine/bed/elementary.hpp"
#include "engine/monte_carlo/rejection_free/rejection_free_kernels.hpp"

namespace jostle::inline engine::JOSTLE_KERNELS {

namespace {

// The four words of the n consecutive blocks (first, lane), (first + 1, lane), ... of a stream,
// word by word. first is a multiple of n, a power of two. Philox4x32-10 (Salmon et al. 2011);
// constants as in Random123, against which it is tested.
inline void philox_words(std::uint64_t key, std::uint64_t first, std::uint32_t lane,
                         std::uint32_t n, std::uint32_t* __restrict w0,
                         std::uint32_t* __restrict w1, std::uint32_t* __restrict w2,
                         std::uint32_t* __restrict w3) {
  for (std::uint32_t t = 0; t < n; ++t) {
    // first is a multiple of n, so the sum never carries into the high word.
    std::uint32_t c0 = static_cast<std::uint32_t>(first) + t;
    std::uint32_t c1 = static_cast<std::uint32_t>(first >> 32);
    std::uint32_t c2 = lane, c3 = 0;
    auto k0 = static_cast<std::uint32_t>(key);
    auto k1 = static_cast<std::uint32_t>(key >> 32);
#pragma GCC unroll 10
    for (int round = 0; round < 10; ++round) {
      const std::uint64_t p0 = static_cast<std::uint64_t>(c0) * 0xD2511F53u;
      const std::uint64_t p1 = static_cast<std::uint64_t>(c2) * 0xCD9E8D57u;
      c0 = static_cast<std::uint32_t>(p1 >> 32) ^ c1 ^ k0;
      c2 = static_cast<std::uint32_t>(p0 >> 32) ^ c3 ^ k1;
      c1 = static_cast<std::uint32_t>(p1);
      c3 = static_cast<std::uint32_t>(p0);
      k0 += 0x9E3779B9u;
      k1 += 0xBB67AE85u;
    }
    w0[t] = c0;
    w1[t] = c1;
    w2[t] = c2;
    w3[t] = c3;
  }
}

// (w + 1/2) 2^-32, in (0, 1), exactly.
inline double unit_interval(std::uint32_t w) {
  return static_cast<double>(static_cast<std::int32_t>(w ^ 0x80000000u)) * 0x1p-32 +
         (0.5 + 0x1p-33);
}

}  // namespace

void draw_candidates(std::uint64_t key, std::uint64_t first, int n_sectors, CandidateBatch& batch) {
  constexpr std::uint32_t n = CandidateBatch::size;
  const double half_sector = std::numbers::pi / n_sectors;
  alignas(64) std::uint32_t w[2][n];
  philox_words(key, first, 2, n, w[0], batch.theta, w[1], batch.length[0]);
  for (std::uint32_t t = 0; t < n; ++t) batch.waiting[t] = -natural_log(unit_interval(w[0][t]));
  for (std::uint32_t t = 0; t < n; ++t) {
    const SineCosine azimuth = doubled(sine_cosine(half_sector * unit_interval(w[1][t])));
    batch.sine[t] = azimuth.sine;
    batch.cosine[t] = azimuth.cosine;
  }
  philox_words(key, first, 3, n, w[0], w[1], batch.length[1], batch.length[2]);
  for (std::uint32_t t = 0; t < n; ++t) {
    batch.choice[t] = static_cast<std::uint64_t>(w[0][t]) << 32 | w[1][t];
  }
}

}  // namespace jostle::inline engine::JOSTLE_KERNELS
