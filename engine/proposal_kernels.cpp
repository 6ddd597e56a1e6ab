// Compiled once for every instruction set, each time into a namespace of its own (JOSTLE_KERNELS).
// It must instantiate nothing that another translation unit could pick up: plain arrays and
// static functions only.
#include "engine/elementary.hpp"
#include "engine/proposals.hpp"
#include "engine/theta_table.hpp"

namespace jostle::JOSTLE_KERNELS {

namespace {

constexpr std::uint32_t n = ProposalBatch::size;

// The four words of n consecutive Philox4x32-10 blocks, word by word.
struct Words {
  alignas(64) std::uint32_t w[4][n];
};

// Philox4x32-10 (Salmon et al. 2011); constants as in Random123, against which it is tested.
void philox_blocks(const BatchOrigin& origin, Words& words) {
  for (std::uint32_t t = 0; t < n; ++t) {
    // origin.first is a multiple of n, so the sum never carries into the high word.
    std::uint32_t c0 = static_cast<std::uint32_t>(origin.first) + t;
    std::uint32_t c1 = static_cast<std::uint32_t>(origin.first >> 32);
    std::uint32_t c2 = 0, c3 = 0;
    auto k0 = static_cast<std::uint32_t>(origin.key);
    auto k1 = static_cast<std::uint32_t>(origin.key >> 32);
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
    words.w[0][t] = c0;
    words.w[1][t] = c1;
    words.w[2][t] = c2;
    words.w[3][t] = c3;
  }
}

// (w + 1/2) 2^-32, in (0, 1), exactly.
inline double unit(std::uint32_t w) {
  return static_cast<double>(static_cast<std::int32_t>(w ^ 0x80000000u)) * 0x1p-32 +
         (0.5 + 0x1p-33);
}

inline void choose_spheres(const Words& words, std::uint32_t n_spheres, ProposalBatch& batch) {
  for (std::uint32_t t = 0; t < n; ++t) {
    batch.sphere[t] =
        static_cast<std::uint32_t>((static_cast<std::uint64_t>(words.w[0][t]) * n_spheres) >> 32);
  }
}

void polar(const BatchOrigin& origin, const double* theta_table, double max_step,
           ProposalBatch& batch) {
  Words words;
  philox_blocks(origin, words);
  choose_spheres(words, origin.n_spheres, batch);
  constexpr int shift = theta_table::shift;
  for (std::uint32_t t = 0; t < n; ++t) {
    const double v = unit(words.w[3][t]);
    const std::uint64_t bits = __builtin_bit_cast(std::uint64_t, v);
    const auto node = static_cast<std::int64_t>((bits >> shift) - theta_table::first);
    // The fraction of the way to the next node is in the remaining bits.
    constexpr std::uint64_t rest = (std::uint64_t{1} << shift) - 1;
    const double along =
        __builtin_bit_cast(double, ((bits & rest) << theta_table::log2_nodes_per_octave) |
                                       __builtin_bit_cast(std::uint64_t, 1.0)) -
        1.0;
    const double low = theta_table[node];
    batch.dz[t] = low + (theta_table[node + 1] - low) * along;
  }
  for (std::uint32_t t = 0; t < n; ++t) {
    const SineCosine theta = sine_cosine(batch.dz[t]);
    const SineCosine azimuth = sine_cosine(4 * unit(words.w[1][t]));
    const double length = max_step * unit(words.w[2][t]);
    const double sideways = length * theta.sine;
    batch.dx[t] = sideways * azimuth.cosine;
    batch.dy[t] = sideways * azimuth.sine;
    batch.dz[t] = -(length * theta.cosine);
  }
}

void metropolis(const BatchOrigin& origin, ProposalBatch& batch) {
  Words words;
  philox_blocks(origin, words);
  choose_spheres(words, origin.n_spheres, batch);
  for (std::uint32_t t = 0; t < n; ++t) {
    batch.dx[t] = 1 - 2 * unit(words.w[1][t]);
    batch.dy[t] = 1 - 2 * unit(words.w[2][t]);
    batch.dz[t] = 1 - 2 * unit(words.w[3][t]);
  }
}

}  // namespace

ProposalKernels proposal_kernels() {
  return {polar, metropolis};
}

}  // namespace jostle::JOSTLE_KERNELS
