// Compiled once for every instruction set, each time into a namespace of its own (JOSTLE_KERNELS).
// It must instantiate nothing that another translation unit could pick up: plain arrays, intrinsics
// and static functions only.
#include "engine/bed/elementary.hpp"
#include "engine/monte_carlo/kernel/proposals.hpp"
#include "engine/monte_carlo/kernel/word_lanes.hpp"
#include "engine/monte_carlo/theta_table.hpp"

namespace jostle::inline engine::JOSTLE_KERNELS {

namespace {

constexpr std::uint32_t n = ProposalBatch::size;
constexpr std::uint32_t n_made = n + ProposalBatch::margin;

// The words of consecutive Philox blocks, word by word; word 0 already turned into a sphere.
struct Words {
  alignas(64) std::uint64_t sphere[n_made], w1[n_made], w2[n_made], w3[n_made];
};

void name_next_spheres(const Words& words, ProposalBatch& batch) {
  for (std::uint32_t t = n; t < n_made; ++t) {
    batch.sphere[t] = static_cast<std::uint32_t>(words.sphere[t]);
  }
}

// Philox4x32-10 (Salmon et al. 2011, doi:10.1145/2063384.2063405); constants as in Random123,
// against which it is tested.
void make_words(const BatchOrigin& origin, Words& words) {
  constexpr WordLanes zero = {};
  const WordLanes multiplier0 = zero + 0xD2511F53u, multiplier1 = zero + 0xCD9E8D57u;
  const WordLanes n_spheres = zero + origin.n_spheres;
  WordLanes first = zero;
  for (std::uint32_t lane = 0; lane < n_lanes; ++lane) first[lane] = lane;
  for (std::uint32_t t = 0; t < n_made; t += n_lanes) {
    // origin.first is a multiple of n, so the sum never carries into the high word within a batch.
    WordLanes c0 = first + ((origin.first & 0xffffffffu) + t);
    WordLanes c1 = zero + (origin.first >> 32), c2 = zero, c3 = zero;
    auto k0 = static_cast<std::uint32_t>(origin.key);
    auto k1 = static_cast<std::uint32_t>(origin.key >> 32);
#pragma GCC unroll 10
    for (int round = 0; round < 10; ++round) {
      const WordLanes p0 = product_of_lower_halves(c0, multiplier0);
      const WordLanes p1 = product_of_lower_halves(c2, multiplier1);
      c0 = (p1 >> 32) ^ c1 ^ k0;
      c2 = (p0 >> 32) ^ c3 ^ k1;
      c1 = p1;
      c3 = p0;
      k0 += 0x9E3779B9u;
      k1 += 0xBB67AE85u;
    }
    *reinterpret_cast<WordLanes*>(words.sphere + t) = product_of_lower_halves(c0, n_spheres) >> 32;
    *reinterpret_cast<WordLanes*>(words.w1 + t) = c1;
    *reinterpret_cast<WordLanes*>(words.w2 + t) = c2;
    *reinterpret_cast<WordLanes*>(words.w3 + t) = c3;
  }
}

constexpr double quarter_pi = 0.78539816339744830962;

// The lower half w of a lane as a double: 2^52 + w has it in its last bits.
inline double lower_half(std::uint64_t lane) {
  return __builtin_bit_cast(double, (lane & 0xffffffffu) | 0x4330000000000000u) - 0x1p52;
}

// (w + 1/2) 2^-32, in (0, 1), exactly.
inline double unit(std::uint64_t lane) {
  return lower_half(lane) * 0x1p-32 + 0x1p-33;
}

// 2 (w + 1/2) 2^-32 - 1, in (-1, 1), exactly.
inline double centred(std::uint64_t lane) {
  return lower_half(lane) * 0x1p-31 + (0x1p-32 - 1);
}

void polar(const BatchOrigin& origin, const double* __restrict theta_table, double max_step,
           ProposalBatch& __restrict batch) {
  Words words;
  make_words(origin, words);
  name_next_spheres(words, batch);
  for (std::uint32_t t = 0; t < n; ++t) {
    constexpr int shift = theta_table::shift;
    constexpr std::uint64_t rest = (std::uint64_t{1} << shift) - 1;
    const std::uint64_t bits = __builtin_bit_cast(std::uint64_t, unit(words.w3[t]));
    const auto node = static_cast<std::int64_t>((bits >> shift) - theta_table::first);
    // The fraction of the way to the next node is in the remaining bits.
    const double azimuthal =
        __builtin_bit_cast(double, ((bits & rest) << theta_table::log2_nodes_per_octave) |
                                       __builtin_bit_cast(std::uint64_t, 1.0)) -
        1.0;
    const double low = theta_table[node];
    const double half_theta = low + (theta_table[node + 1] - low) * azimuthal;
    // Angles in [0, pi/2] and (-pi, pi) from their half and their quarter.
    const SineCosine theta = doubled(sine_cosine(half_theta));
    const SineCosine azimuth = doubled(doubled(sine_cosine(quarter_pi * centred(words.w1[t]))));
    const double length = max_step * unit(words.w2[t]);
    const double sideways = length * theta.sine;
    batch.sphere[t] = static_cast<std::uint32_t>(words.sphere[t]);
    batch.dx[t] = sideways * azimuth.cosine;
    batch.dy[t] = sideways * azimuth.sine;
    batch.dz[t] = -(length * theta.cosine);
  }
}

void metropolis(const BatchOrigin& origin, ProposalBatch& __restrict batch) {
  Words words;
  make_words(origin, words);
  name_next_spheres(words, batch);
  for (std::uint32_t t = 0; t < n; ++t) {
    batch.sphere[t] = static_cast<std::uint32_t>(words.sphere[t]);
    batch.dx[t] = -centred(words.w1[t]);
    batch.dy[t] = -centred(words.w2[t]);
    batch.dz[t] = -centred(words.w3[t]);
  }
}

}  // namespace

ProposalKernels proposal_kernels() {
  return {polar, metropolis};
}

}  // namespace jostle::inline engine::JOSTLE_KERNELS
