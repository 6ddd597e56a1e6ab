// Compiled once for every instruction set, each time into a namespace of its own (JOSTLE_KERNELS).
// It must instantiate nothing that another translation unit could pick up: plain arrays and
// static functions only.
#include "engine/monte_carlo/rejection_free/rejection_free_kernels.hpp"

#include <cassert>

#include "engine/monte_carlo/kernel/four_floats.hpp"

namespace jostle::inline engine::JOSTLE_KERNELS {

namespace {

// Number of sectors in a register of the instruction set.
#if defined(__AVX512F__)
constexpr int lanes = 16;
#elif defined(__AVX2__)
constexpr int lanes = 8;
#else
constexpr int lanes = 4;
#endif
using Floats = float __attribute__((vector_size(4 * lanes)));
using Integers = std::int32_t __attribute__((vector_size(4 * lanes)));

inline Floats load(const float* at) {
  return *reinterpret_cast<const Floats*>(at);
}
inline void store(Floats values, float* at) {
  *reinterpret_cast<Floats*>(at) = values;
}

// Four numbers, of four spheres or the coordinates of one.
using Four = FourFloats;
using FourIntegers = std::int32_t __attribute__((vector_size(16)));

inline FourIntegers at(const GridPlace& place) {
  return *reinterpret_cast<const FourIntegers*>(place.at);
}

// Number of spheres per group.
constexpr std::size_t group = 8;

// Obstacles of a group of spheres: r, relative to each centre.
struct Obstacles {
  static constexpr std::uint32_t size = group * (most_in_the_way + Planes::most) + 4;
  std::uint32_t n = 0;
  alignas(16) float r[size][4];
};

// Another position relative to a sphere's own. All use one arithmetic for obstacles.
// Differences wrap around, as places do through periodic sides.
inline Four seen_from(const Sight& sight, FourIntegers own, FourIntegers other) {
  using Wrapping = std::uint32_t __attribute__((vector_size(16)));
  const auto between = (FourIntegers)((Wrapping)other - (Wrapping)own);
  return __builtin_convertvector(between, Four) * *reinterpret_cast<const Four*>(sight.unit);
}

// |r|^2 - 1, rounded up; > 0.
inline Four tangent_squared(Four x, Four y, Four z, float margin) {
  return ((x * x + y * y + z * z) - 1.0f) + margin;
}

// Tests four for obstacles, one bit each.
inline unsigned in_the_way(const Sight& sight, const Four (&r)[4]) {
  Four x = r[0], y = r[1], z = r[2], rest = r[3];
  transpose(x, y, z, rest);
  const auto counts =
      (tangent_squared(x, y, z, sight.margin) < sight.farthest) & (z > -sight.highest);
  return bits_of_four(counts);
}

// Four of a list, from place m on.
struct ListedFour {
  std::uint32_t sphere[4];
  unsigned mask;  // those that are listed; the others repeat the last
};
inline ListedFour listed_from(const std::uint32_t* list, std::uint32_t m) {
  const std::uint32_t last = list[0];
  ListedFour four;
  for (std::uint32_t k = 0; k < 4; ++k) four.sphere[k] = list[m + k < last ? m + k : last];
  four.mask = last - m < 3 ? (2u << (last - m)) - 1 : 15;
  return four;
}

inline void look_around(const Sight& sight, const Surroundings& around, std::uint32_t i,
                        Obstacles& seen) {
  const std::uint32_t* const list = around.lists + i * around.stride;
  const FourIntegers own = at(around.places[i]);
  std::uint32_t n = seen.n;
  for (std::uint32_t m = 1; m <= list[0]; m += 4) {
    const ListedFour four = listed_from(list, m);
    Four r[4];
    for (int k = 0; k < 4; ++k) r[k] = seen_from(sight, own, at(around.places[four.sphere[k]]));
    const unsigned counts = in_the_way(sight, r) & four.mask;
    for (int k = 0; k < 4; ++k) {
      *reinterpret_cast<Four*>(seen.r[n]) = r[k];
      n += counts >> k & 1;  // no branch: it could not be guessed
    }
    assert(n < seen.n + most_in_the_way);
  }
  seen.n = n;
}

std::uint32_t seen_by(const Sight& sight, const Surroundings& around, std::uint32_t i,
                      const GridPlace& former, std::uint32_t* seeing) {
  const std::uint32_t* const list = around.lists + i * around.stride;
  const FourIntegers before = at(former), now = at(around.places[i]);
  std::uint32_t n = 0;
  for (std::uint32_t m = 1; m <= list[0]; m += 4) {
    const ListedFour four = listed_from(list, m);
    Four r_before[4], r_now[4];
    for (int k = 0; k < 4; ++k) {
      const FourIntegers own = at(around.places[four.sphere[k]]);
      r_before[k] = seen_from(sight, own, before);
      r_now[k] = seen_from(sight, own, now);
    }
    const unsigned counts = (in_the_way(sight, r_before) | in_the_way(sight, r_now)) & four.mask;
    for (int k = 0; k < 4; ++k) {
      seeing[n] = four.sphere[k];
      n += counts >> k & 1;
    }
  }
  return n;
}

StepOutcome try_step(const Sight& sight, const Surroundings& around, std::uint32_t i, double dx,
                     double dy, double dz) {
  const std::uint32_t* const list = around.lists + i * around.stride;
  const FourIntegers own = at(around.places[i]);
  const Four step = {static_cast<float>(dx), static_cast<float>(dy), static_cast<float>(-dz), 0};
  Four nearest = {2, 2, 2, 2};
  for (std::uint32_t m = 1; m <= list[0]; m += 4) {
    const ListedFour four = listed_from(list, m);
    Four r[4];
    for (int k = 0; k < 4; ++k) {
      r[k] = seen_from(sight, own, at(around.places[four.sphere[k]])) - step;
    }
    transpose(r[0], r[1], r[2], r[3]);
    const Four squared = r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
    nearest = squared < nearest ? squared : nearest;
  }
  if (any_of_four(nearest < 1.0f - sight.doubt)) return StepOutcome::blocked;
  const bool unsure = any_of_four(nearest < 1.0f + sight.doubt);
  return unsure ? StepOutcome::unsure : StepOutcome::free;
}

// Bounds as inverse lengths times the longest step. For component s of r such a bound is
// slope s + level, wherever this is at least the onset.
struct Coefficients {
  static constexpr std::uint32_t size = Obstacles::size;
  alignas(64) float x[size], y[size], z[size], norm[size], level[size], onset[size];
};

// Inverse lengths are lowered by more than rounding can add to them, reciprocals included.
constexpr float lowered = 0.999f;

// A step along a direction with component s of r enters the sphere at L = c / h(s), with
// c = |r|^2 - 1 and h = s + sqrt(s^2 - c), and leaves it at h. From s = (longest + c / longest) / 2
// on, where the longest step enters or leaves the sphere, every step beyond L is rejected. There h
// is the greater of longest and c / longest; it is concave, so it is above the straight line from
// there to norm + 1 at any norm >= |r|. A line from c / longest, which is lower, needs no onset:
// for a lesser s it gives a bound beyond the longest step.
template <bool with_onset>
void sphere_coefficients(const Obstacles& obstacles, float margin, float longest,
                         Coefficients& out) {
  const float per_longest = 1.0f / longest, scale = lowered * longest;
  for (std::uint32_t j = 0; j < obstacles.n; j += 4) {
    const auto* const r = reinterpret_cast<const Four*>(obstacles.r[j]);
    Four x = r[0], y = r[1], z = r[2], rest = r[3];
    transpose(x, y, z, rest);
    const Four c = tangent_squared(x, y, z, margin);
    const Four norm = 1.0f + 0.5f * c;
    const Four per_c = 1.0f / c;
    const Four least = 0.5f * (longest + c * per_longest);
    Four onset = Four{} + per_longest;
    if constexpr (with_onset) {
      const Four inside = longest * per_c;
      onset = inside > onset ? inside : onset;
    }
    const Four slope = scale * (((norm + 1.0f) * per_c - onset) / (norm - least));
    const auto put = [j](Four values, float* to) { *reinterpret_cast<Four*>(to + j) = values; };
    put(x * slope, out.x);
    put(y * slope, out.y);
    put(z * slope, out.z);
    put(norm * slope, out.norm);
    put(scale * onset - slope * least, out.level);
    put(scale * onset * 1.00001f, out.onset);  // safe from rounding
  }
}

// A plane is met at the gap over the component of its normal.
void add_planes(const Planes& planes, std::uint32_t n, float longest, Coefficients& out) {
  for (std::uint32_t w = 0; w < planes.n; ++w, ++n) {
    const float per_gap = lowered * longest / planes.gap[w];
    out.x[n] = planes.x[w] * per_gap;
    out.y[n] = planes.y[w] * per_gap;
    out.z[n] = planes.z[w] * per_gap;
    out.norm[n] = per_gap;
    out.level[n] = 0;
    out.onset[n] = 0;
  }
}

// The lines of all obstacles, [obstacle][sector] and [obstacle][ring]: their product with a ring's
// width and their sum is the bound.
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

// Bounds are the greatest of all lines, at least 1. All values are positive, so that they compare
// as the integers that store them: these have more units to run on.
template <bool with_onset, int n_sectors>
[[gnu::always_inline]] inline void greatest(const DirectionBins<n_sectors>& bins,
                                            const Coefficients& coefficients,
                                            const Lines<n_sectors>& lines, std::uint32_t begin,
                                            std::uint32_t end, int p,
                                            Integers (&inverse)[n_rings]) {
  for (Integers& bound : inverse) bound = (Integers)(Floats{} + 1.0f);
  for (std::uint32_t j = begin; j < end; ++j) {
    const Floats sideways = load(&lines.sideways[j][p]);
    for (int k = 0; k < n_rings; ++k) {
      Floats here = sideways * bins.across[k] + lines.downward[j][k];
      if constexpr (with_onset) here = here >= coefficients.onset[j] ? here : Floats{};
      inverse[k] = (Integers)here > inverse[k] ? (Integers)here : inverse[k];
    }
  }
}

// The lengths of four rings, each times its parts, from their inverses, by a single division.
inline Floats sum_of_lengths(const Integers* inverse, const int* parts) {
  const auto x = [inverse](int k) { return (Floats)(inverse[k] & std::int32_t(0xffff0000)); };
  const auto p = [parts](int k) { return static_cast<float>(parts[k]); };
  const Floats product_01 = x(0) * x(1), product_23 = x(2) * x(3);
  const Floats sum_01 = p(0) * x(1) + p(1) * x(0), sum_23 = p(2) * x(3) + p(3) * x(2);
  return (sum_01 * product_23 + sum_23 * product_01) / (product_01 * product_23);
}

// Stores the bounds of `lanes` sectors from p and returns the sectors' weights.
inline Integers weigh(const DirectionBins<polar_sectors>& bins, const Integers (&inverse)[n_rings],
                      int p, BoundRow<polar_sectors>& row) {
  static_assert(n_rings == 8);
  for (int k = 0; k < n_rings; k += 2) {
    using Bits = std::uint32_t __attribute__((vector_size(4 * lanes)));
    *reinterpret_cast<Bits*>(&row.bounds[k / 2][p]) =
        (Bits)inverse[k] >> 16 | ((Bits)inverse[k + 1] & 0xffff0000u);
  }
  const Floats length =
      sum_of_lengths(inverse, bins.parts) + sum_of_lengths(inverse + 4, bins.parts + 4);
  return __builtin_convertvector(length * (1.00001f * whole_weight), Integers) + 1;
}

inline Integers cubed(Integers inverse, const std::int32_t* caps) {
  const Floats ratio = reciprocal((Floats)inverse);
  const Floats bound = ratio * ratio * ratio * float{whole_weight};
  const Integers above = __builtin_convertvector(bound, Integers) + 1;
  const Integers cap = *reinterpret_cast<const Integers*>(caps);
  return above < cap ? above : cap;
}

inline Integers weigh(const DirectionBins<cubic_sectors>& bins, const Integers (&inverse)[n_rings],
                      int p, BoundRow<cubic_sectors>& row) {
  Integers sum = {};
  for (int k = 0; k < n_rings; k += 2) {
    const Integers first = cubed(inverse[k], &bins.cap[k][p]);
    const Integers second = cubed(inverse[k + 1], &bins.cap[k + 1][p]);
    *reinterpret_cast<Integers*>(&row.bounds[k / 2][p]) = first | second << 16;
    sum += first * bins.parts[k] + second * bins.parts[k + 1];
  }
  return sum;
}

template <bool with_onset, int n_sectors>
[[gnu::always_inline]] inline void make_group(const DirectionBins<n_sectors>& bins,
                                              const Sight& sight, const Surroundings& around,
                                              Bounded* spheres, std::size_t n,
                                              BoundRow<n_sectors>* rows) {
  Obstacles obstacles;
  Coefficients coefficients;
  Lines<n_sectors> lines;
  std::uint32_t ends[group];
  const auto longest = static_cast<float>(bins.longest);
  for (std::size_t s = 0; s < n; ++s) {
    look_around(sight, around, spheres[s].sphere, obstacles);
    ends[s] = obstacles.n += spheres[s].planes.n;
  }
  sphere_coefficients<with_onset>(obstacles, sight.margin, longest, coefficients);
  for (std::size_t s = 0; s < n; ++s) {
    add_planes(spheres[s].planes, ends[s] - spheres[s].planes.n, longest, coefficients);
  }
  draw_lines(bins, coefficients, obstacles.n, lines);
  for (std::size_t s = 0; s < n; ++s) {
    BoundRow<n_sectors>& row = rows[spheres[s].sphere];
    const std::uint32_t begin = s == 0 ? 0 : ends[s - 1];
    alignas(64) std::int32_t sector_weight[n_sectors];
    for (int p = 0; p < n_sectors; p += lanes) {
      Integers inverse[n_rings];
      greatest<with_onset>(bins, coefficients, lines, begin, ends[s], p, inverse);
      *reinterpret_cast<Integers*>(&sector_weight[p]) = weigh(bins, inverse, p, row);
    }
    std::int32_t sum = 0;
    for (int p = 0; p < n_sectors; ++p) row.up_to[p] = sum += sector_weight[p];
    spheres[s].weight = static_cast<std::uint32_t>(sum);
  }
}

template <bool with_onset, int n_sectors>
void make_bounds(const DirectionBins<n_sectors>& bins, const Sight& sight,
                 const Surroundings& around, Bounded* spheres, std::size_t n,
                 BoundRow<n_sectors>* rows) {
  for (; n > group; n -= group, spheres += group) {
    make_group<with_onset>(bins, sight, around, spheres, group, rows);
  }
  make_group<with_onset>(bins, sight, around, spheres, n, rows);
}

}  // namespace

RejectionFreeKernels rejection_free_kernels() {
  // A polar step is so short that the lower line, without onset, serves as well.
  return {make_bounds<false, polar_sectors>, make_bounds<true, cubic_sectors>, seen_by, try_step,
          draw_candidates};
}

}  // namespace jostle::inline engine::JOSTLE_KERNELS
