// Compiled once for every instruction set, each time into a namespace of its own (JOSTLE_KERNELS).
// It must instantiate nothing that another translation unit could pick up: plain arrays and
// static functions only.
#include "engine/monte_carlo/rejection_free/rejection_free_kernels.hpp"

#include <numbers>

#include "engine/bed/elementary.hpp"

namespace jostle::inline engine::JOSTLE_KERNELS {

namespace {

// As many sectors as a register of the instruction set holds.
#if defined(__AVX512F__)
constexpr int lanes = 16;
#elif defined(__AVX2__)
constexpr int lanes = 8;
#else
constexpr int lanes = 4;
#endif
using Floats = float __attribute__((vector_size(4 * lanes)));
using Integers = std::int32_t __attribute__((vector_size(4 * lanes)));
using Shorts = std::uint16_t __attribute__((vector_size(2 * lanes)));

inline Floats load(const float* at) {
  return *reinterpret_cast<const Floats*>(at);
}
inline void store(Floats values, float* at) {
  *reinterpret_cast<Floats*>(at) = values;
}

// For component s of r an inverse length 1 / L >= slope s + level, wherever this is at least the
// onset.
struct Coefficients {
  static constexpr std::uint32_t size = Obstacles::most_spheres + 16;
  alignas(64) float x[size], y[size], z[size], norm[size], level[size], onset[size];
};

// A step along a direction with component s of r enters the sphere at L = c / h(s), with
// c = |r|^2 - 1 and h = s + sqrt(s^2 - c), and leaves it at h. From s = (longest + c / longest) / 2
// on, where the longest step enters or leaves the sphere, every step beyond L is rejected. There h
// is the greater of longest and c / longest; it is concave, so it is above the straight line from
// there to norm + 1 at any norm >= |r|. A line from c / longest, which is lower, needs no onset:
// for a lesser s it gives a bound beyond the longest step.
template <bool with_onset>
void sphere_coefficients(const Obstacles& obstacles, float longest, Coefficients& out) {
  const float per_longest = 1.0f / longest;
  for (std::uint32_t j = 0; j < obstacles.n_spheres; j += lanes) {
    const Floats x = load(&obstacles.x[j]), y = load(&obstacles.y[j]), z = load(&obstacles.z[j]);
    const Floats c = load(&obstacles.tangent_squared[j]);
    const Floats norm = 1.0f + 0.5f * c;
    const Floats per_c = 1.0f / c;
    const Floats least = 0.5f * (longest + c * per_longest);
    Floats onset = Floats{} + per_longest;
    if constexpr (with_onset) {
      const Floats inside = longest * per_c;
      onset = inside > onset ? inside : onset;
    }
    const Floats slope = ((norm + 1.0f) * per_c - onset) / (norm - least);
    store(x * slope, &out.x[j]);
    store(y * slope, &out.y[j]);
    store(z * slope, &out.z[j]);
    store(norm * slope, &out.norm[j]);
    store(onset - slope * least, &out.level[j]);
    store(onset * 1.00001f, &out.onset[j]);  // safe from rounding
  }
}

// A plane is met at the gap over the component of its normal.
void add_planes(const Obstacles& obstacles, Coefficients& out) {
  std::uint32_t n = obstacles.n_spheres;
  for (std::uint32_t w = 0; w < obstacles.n_planes; ++w, ++n) {
    const float per_gap = 1.0f / obstacles.gap[w];
    out.x[n] = obstacles.plane_x[w] * per_gap;
    out.y[n] = obstacles.plane_y[w] * per_gap;
    out.z[n] = obstacles.plane_z[w] * per_gap;
    out.norm[n] = per_gap;
    out.level[n] = 0;
    out.onset[n] = 0;
  }
}

// The lines of all obstacles, [obstacle][sector] and [obstacle][ring]: their product with a ring's
// width and their sum is the inverse length.
template <int n_sectors>
struct Lines {
  alignas(64) float sideways[Coefficients::size][n_sectors];
  alignas(64) float downward[Coefficients::size][n_rings];
};

template <int n_sectors>
void draw_lines(const DirectionBins<n_sectors>& bins, const Coefficients& of, std::uint32_t n,
                Lines<n_sectors>& lines) {
  for (std::uint32_t j = 0; j < n; ++j) {
    for (int p = 0; p < n_sectors; p += lanes) {
      store(of.x[j] * load(&bins.cosine[p]) + of.y[j] * load(&bins.sine[p]), &lines.sideways[j][p]);
    }
    for (int k = 0; k < n_rings; ++k) {
      lines.downward[j][k] = (of.z[j] * bins.down[k] - of.norm[j] * bins.spread[k]) + of.level[j];
    }
  }
}

// 1 / x for x from 1e-30 to 1e30, too small by at most 2 parts in 100 000: a first guess from the
// bits, 6 % off at most, and Newton's method twice. A division takes longer.
inline Floats reciprocal(Floats x) {
  Floats y = (Floats)(0x7ef127ea - (Integers)x);
  y *= 2.0f - x * y;
  return y * (2.0f - x * y);
}

template <bool cubic, int n_sectors>
[[gnu::always_inline]] inline std::uint32_t bounds(const DirectionBins<n_sectors>& bins,
                                                   const Obstacles& obstacles,
                                                   BoundRow<n_sectors>& row) {
  constexpr int block = 4;
  Coefficients coefficients;
  Lines<n_sectors> lines;
  sphere_coefficients<cubic>(obstacles, static_cast<float>(bins.longest), coefficients);
  add_planes(obstacles, coefficients);
  const std::uint32_t n = obstacles.n_spheres + obstacles.n_planes;
  draw_lines(bins, coefficients, n, lines);
  // Inverse lengths are positive where they count, so that they compare as the integers they are
  // stored as: these have more units to run on.
  const Integers open = (Integers)(Floats{} + 1.0f / static_cast<float>(bins.longest));
  // A part in a thousand more than reciprocals and rounding can take away.
  const float scale = 1.001f / static_cast<float>(bins.longest);
  Integers sum = {};
  for (int p = 0; p < n_sectors; p += lanes) {
    Integers sector_weight = {};
    for (int first = 0; first < n_rings; first += block) {
      Integers inverse[block];
      for (Integers& least : inverse) least = open;
      for (std::uint32_t j = 0; j < n; ++j) {
        const Floats sideways = load(&lines.sideways[j][p]);
        for (int k = 0; k < block; ++k) {
          Floats here = sideways * bins.across[first + k] + lines.downward[j][first + k];
          // A polar step is so short that the lower line serves as well.
          if constexpr (cubic) here = here >= coefficients.onset[j] ? here : Floats{};
          inverse[k] = (Integers)here > inverse[k] ? (Integers)here : inverse[k];
        }
      }
      for (int k = 0; k < block; ++k) {
        const Floats ratio = scale * reciprocal((Floats)inverse[k]);
        const Floats bound = (cubic ? ratio * ratio * ratio : ratio) * float{whole_weight};
        const Integers above = __builtin_convertvector(bound, Integers) + 1;
        const Integers cap = *reinterpret_cast<const Integers*>(&bins.cap[first + k][p]);
        const Integers weight = above < cap ? above : cap;
        *reinterpret_cast<Shorts*>(&row.weight[first + k][p]) =
            __builtin_convertvector(weight, Shorts);
        sector_weight += weight * bins.parts[first + k];
      }
    }
    *reinterpret_cast<Integers*>(&row.sector_weight[p]) = sector_weight;
    sum += sector_weight;
  }
  std::int32_t total = 0;
  for (int lane = 0; lane < lanes; ++lane) total += sum[lane];
  return static_cast<std::uint32_t>(total);
}

std::uint32_t linear_bounds(const DirectionBins<polar_sectors>& bins, const Obstacles& obstacles,
                            BoundRow<polar_sectors>& row) {
  return bounds<false>(bins, obstacles, row);
}

std::uint32_t cubic_bounds(const DirectionBins<cubic_sectors>& bins, const Obstacles& obstacles,
                           BoundRow<cubic_sectors>& row) {
  return bounds<true>(bins, obstacles, row);
}

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

void candidates(std::uint64_t key, std::uint64_t first, int n_sectors, CandidateBatch& batch) {
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

}  // namespace

RejectionFreeKernels rejection_free_kernels() {
  return {linear_bounds, cubic_bounds, candidates};
}

}  // namespace jostle::inline engine::JOSTLE_KERNELS
