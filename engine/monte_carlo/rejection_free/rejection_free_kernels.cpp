// Compiled once for every instruction set, each time into a namespace of its own (JOSTLE_KERNELS).
// It must instantiate nothing that another translation unit could pick up: plain arrays and
// static functions only.
#include "engine/monte_carlo/rejection_free/rejection_free_kernels.hpp"

#include "engine/monte_carlo/rejection_free/obstacles.hpp"

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

inline Floats load(const float* source) {
  return *reinterpret_cast<const Floats*>(source);
}
inline void store(Floats values, float* destination) {
  *reinterpret_cast<Floats*>(destination) = values;
}

// Bounds as inverse lengths times the longest step. For component q of r such a bound is
// slope q + level, wherever this is at least the onset.
struct Coefficients {
  static constexpr std::uint32_t size = Obstacles::size;
  alignas(64) float x[size], y[size], z[size], norm[size], level[size], onset[size];
};

// Inverse lengths are lowered by more than rounding can add to them, reciprocals included.
constexpr float lowered = 0.999f;

// The length beyond which an obstacle certainly rejects a step (all lengths over s, see
// obstacles.hpp). A step of length l along a unit vector u ends at l u, and the obstacle rejects it
// where
//   |r - l u|^2 < 1,  that is  l^2 - 2 q l + c < 0  with  q = r.u  and  c = |r|^2 - 1.
// Its roots are c / h and h, where h(q) = q + sqrt(q^2 - c): the step enters the sphere at c / h
// and leaves it at h. Every length from c / h up to the longest, L, is rejected if L <= h. Both
// roots are L and c / L at q = least = (L + c / L) / 2: from there on h >= L or c / h >= L. The
// bound of 1 / length is then h / c, and any lower number is safe. h is concave, so that it is
// above its chord between two q: from (least, max(L, c / L)), the onset, to (norm, norm + 1), where
// norm = 1 + c / 2 >= |r| and h(norm) >= norm + 1, since norm^2 - c >= 1. This chord is the bound;
// it grows with q, so that the least q of a bin of directions bounds all of the bin. A chord from
// (least, c / L), which is lower, needs no onset: for a lesser q its bound is beyond L.
template <class Spheres, bool with_onset>
void sphere_coefficients(const Obstacles& obstacles, float margin, float longest_step,
                         Coefficients& coefficients) {
  const float per_longest_step = 1.0f / longest_step, lowered_step = lowered * longest_step;
  for (std::uint32_t j = 0; j < obstacles.n; j += 4) {
    const auto* const r = reinterpret_cast<const Four*>(obstacles.r[j]);
    Four x = r[0], y = r[1], z = r[2], s = r[3];
    transpose(x, y, z, s);
    const Scale<Spheres> scale(s);
    const auto longest = longest_step * scale.inverse, per_longest = per_longest_step * scale.s;
    const auto lowered_longest = lowered_step * scale.inverse;
    const Four c = tangent_squared<Spheres>(x, y, z, scale, margin);
    const Four norm = 1.0f + 0.5f * c;
    const Four per_c = 1.0f / c;
    const Four least = 0.5f * (longest + c * per_longest);
    Four onset = Four{} + per_longest;
    if constexpr (with_onset) {
      const Four inside = longest * per_c;
      onset = inside > onset ? inside : onset;
    }
    const Four slope = lowered_longest * (((norm + 1.0f) * per_c - onset) / (norm - least));
    const auto put = [j](Four values, float* destination) {
      *reinterpret_cast<Four*>(destination + j) = values;
    };
    put(x * scale.inverse * slope, coefficients.x);
    put(y * scale.inverse * slope, coefficients.y);
    put(z * scale.inverse * slope, coefficients.z);
    put(norm * slope, coefficients.norm);
    put(lowered_longest * onset - slope * least, coefficients.level);
    put(lowered_longest * onset * 1.00001f, coefficients.onset);  // safe from rounding
  }
}

// A step meets a plane at the gap over q, the component of the plane's normal.
void add_planes(const Planes& planes, std::uint32_t n, float longest, Coefficients& coefficients) {
  for (std::uint32_t w = 0; w < planes.n; ++w, ++n) {
    const float per_gap = lowered * longest / planes.gap[w];
    coefficients.x[n] = planes.x[w] * per_gap;
    coefficients.y[n] = planes.y[w] * per_gap;
    coefficients.z[n] = planes.z[w] * per_gap;
    coefficients.norm[n] = per_gap;
    coefficients.level[n] = 0;
    coefficients.onset[n] = 0;
  }
}

// The lines of all obstacles, [obstacle][sector] and [obstacle][ring]: their product with a ring's
// width and their sum is the bound.
template <int n_sectors>
struct ObstacleLines {
  alignas(64) float sideways[Coefficients::size][n_sectors];
  alignas(64) float downward[Coefficients::size][n_rings];
};

template <int n_sectors>
void draw_lines(const DirectionBins<n_sectors>& bins, const Coefficients& coefficients,
                std::uint32_t n, ObstacleLines<n_sectors>& lines) {
  for (std::uint32_t j = 0; j < n; ++j) {
    for (int p = 0; p < n_sectors; p += lanes) {
      store(coefficients.x[j] * load(&bins.cosine[p]) + coefficients.y[j] * load(&bins.sine[p]),
            &lines.sideways[j][p]);
    }
    for (int k = 0; k < n_rings; ++k) {
      lines.downward[j][k] =
          (coefficients.z[j] * bins.vertical[k] - coefficients.norm[j] * bins.spread[k]) +
          coefficients.level[j];
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

using Inverses = Integers[n_rings];  // one sector per lane

// The inverse of a sphere's bounds without an obstacle: the longest step is possible.
[[gnu::always_inline]] inline void open_to_longest(Inverses& inverse) {
  for (Integers& bound : inverse) bound = (Integers)(Floats{} + 1.0f);
}

// Inverse bounds are the greatest of all lines. All values are positive, so that they compare as
// the integers that store them: these have more units to run on.
template <bool with_onset, int n_sectors>
[[gnu::always_inline]] inline void greatest(const DirectionBins<n_sectors>& bins,
                                            const Coefficients& coefficients,
                                            const ObstacleLines<n_sectors>& lines,
                                            std::uint32_t begin, std::uint32_t end, int p,
                                            Inverses& inverse) {
  for (std::uint32_t j = begin; j < end; ++j) {
    const Floats sideways = load(&lines.sideways[j][p]);
    for (int k = 0; k < n_rings; ++k) {
      Floats bound = sideways * bins.across[k] + lines.downward[j][k];
      if constexpr (with_onset) bound = bound >= coefficients.onset[j] ? bound : Floats{};
      inverse[k] = (Integers)bound > inverse[k] ? (Integers)bound : inverse[k];
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
inline Integers weigh(const DirectionBins<polar_sectors>& bins, const Inverses& inverse, int p,
                      BoundRow<polar_sectors>& row) {
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
  const Integers rounded_up = __builtin_convertvector(bound, Integers) + 1;
  const Integers cap = *reinterpret_cast<const Integers*>(caps);
  return rounded_up < cap ? rounded_up : cap;
}

inline Integers weigh(const DirectionBins<cubic_sectors>& bins, const Inverses& inverse, int p,
                      BoundRow<cubic_sectors>& row) {
  Integers sum = {};
  for (int k = 0; k < n_rings; k += 2) {
    const Integers first = cubed(inverse[k], &bins.cap[k][p]);
    const Integers second = cubed(inverse[k + 1], &bins.cap[k + 1][p]);
    *reinterpret_cast<Integers*>(&row.bounds[k / 2][p]) = first | second << 16;
    sum += first * bins.parts[k] + second * bins.parts[k + 1];
  }
  return sum;
}

// Sums up the weights of sectors.
template <int n_sectors>
[[gnu::always_inline]] inline void sum_weights(const std::int32_t (&sector_weight)[n_sectors],
                                               BoundedSphere& sphere, BoundRow<n_sectors>& row) {
  std::int32_t sum = 0;
  for (int p = 0; p < n_sectors; ++p) row.up_to[p] = sum += sector_weight[p];
  sphere.weight = static_cast<std::uint32_t>(sum);
}

template <bool with_onset, int n_sectors>
[[gnu::always_inline]] inline void make_group(const DirectionBins<n_sectors>& bins,
                                              const ObstacleLimits& limits,
                                              const SphereLists& sphere_lists,
                                              BoundedSphere* spheres, std::size_t n,
                                              BoundRow<n_sectors>* rows) {
  Obstacles obstacles;
  Coefficients coefficients;
  ObstacleLines<n_sectors> lines;
  std::uint32_t ends[group];
  const auto longest = static_cast<float>(bins.longest);
  for (std::size_t s = 0; s < n; ++s) {
    const std::uint32_t i = spheres[s].sphere;
    const std::uint32_t* const list = list_of<EqualSpheres>(sphere_lists, i);
    look_around<EqualSpheres>(limits, sphere_lists, i, list, 1, list[0], obstacles);
    ends[s] = obstacles.n += spheres[s].planes.n;
  }
  sphere_coefficients<EqualSpheres, with_onset>(obstacles, limits.margin, longest, coefficients);
  for (std::size_t s = 0; s < n; ++s) {
    add_planes(spheres[s].planes, ends[s] - spheres[s].planes.n, longest, coefficients);
  }
  draw_lines(bins, coefficients, obstacles.n, lines);
  for (std::size_t s = 0; s < n; ++s) {
    BoundRow<n_sectors>& row = rows[spheres[s].sphere];
    const std::uint32_t begin = s == 0 ? 0 : ends[s - 1];
    alignas(64) std::int32_t sector_weight[n_sectors];
    for (int p = 0; p < n_sectors; p += lanes) {
      Inverses inverse;
      open_to_longest(inverse);
      greatest<with_onset>(bins, coefficients, lines, begin, ends[s], p, inverse);
      *reinterpret_cast<Integers*>(&sector_weight[p]) = weigh(bins, inverse, p, row);
    }
    sum_weights(sector_weight, spheres[s], row);
  }
}

template <bool with_onset, int n_sectors>
void make_bounds(const DirectionBins<n_sectors>& bins, const ObstacleLimits& limits,
                 const SphereLists& sphere_lists, BoundedSphere* spheres, std::size_t n,
                 BoundRow<n_sectors>* rows) {
  for (; n > group; n -= group, spheres += group) {
    make_group<with_onset>(bins, limits, sphere_lists, spheres, group, rows);
  }
  make_group<with_onset>(bins, limits, sphere_lists, spheres, n, rows);
}

// Part of the list of a sphere, short enough for the room that obstacles have in a group: a large
// sphere among small ones has hundreds of neighbours.
struct ListPart {
  BoundedSphere* sphere;
  std::uint32_t first, last;  // places in the list
  bool begins, ends;          // true for the first and the last part of a list
};

// The lists of spheres, part by part.
class ListParts {
 public:
  ListParts(const SphereLists& sphere_lists, BoundedSphere* spheres, std::size_t n)
      : sphere_lists_(sphere_lists), sphere_(spheres), end_(spheres + n) {}

  bool done() const { return sphere_ == end_; }
  ListPart next() {
    const std::uint32_t length = *list_of<SeveralSizes>(sphere_lists_, sphere_->sphere);
    const bool ends = length - passed_ <= most_in_the_way;
    const std::uint32_t last = ends ? length : passed_ + most_in_the_way;
    const ListPart part{sphere_, passed_ + 1, last, passed_ == 0, ends};
    passed_ = ends ? 0 : last;
    sphere_ += ends;
    return part;
  }

 private:
  const SphereLists& sphere_lists_;
  BoundedSphere* sphere_;
  BoundedSphere* end_;
  std::uint32_t passed_ = 0;  // places of the list of sphere_ that earlier parts have
};

// Like make_bounds() for spheres of several sizes, in groups of parts of lists. The greatest of all
// lines does not depend on how a list is cut.
template <bool with_onset, int n_sectors>
void make_bounds_of_sizes(const DirectionBins<n_sectors>& bins, const ObstacleLimits& limits,
                          const SphereLists& sphere_lists, BoundedSphere* spheres, std::size_t n,
                          BoundRow<n_sectors>* rows) {
  const auto longest = static_cast<float>(bins.longest);
  Inverses inverse[n_sectors / lanes];  // kept for the rest of a list in the next group
  for (ListParts lists(sphere_lists, spheres, n); !lists.done();) {
    Obstacles obstacles;
    Coefficients coefficients;
    ObstacleLines<n_sectors> lines;
    ListPart parts[group];
    std::uint32_t ends[group];
    std::size_t n_parts = 0;
    for (; n_parts < group && !lists.done(); ++n_parts) {
      const ListPart part = parts[n_parts] = lists.next();
      const std::uint32_t i = part.sphere->sphere;
      look_around<SeveralSizes>(limits, sphere_lists, i, list_of<SeveralSizes>(sphere_lists, i),
                                part.first, part.last, obstacles);
      ends[n_parts] = obstacles.n += part.ends ? part.sphere->planes.n : 0;
    }
    sphere_coefficients<SeveralSizes, with_onset>(obstacles, limits.margin, longest, coefficients);
    for (std::size_t k = 0; k < n_parts; ++k) {
      if (!parts[k].ends) continue;
      const Planes& planes = parts[k].sphere->planes;
      add_planes(planes, ends[k] - planes.n, longest, coefficients);
    }
    draw_lines(bins, coefficients, obstacles.n, lines);
    for (std::size_t k = 0; k < n_parts; ++k) {
      BoundedSphere& sphere = *parts[k].sphere;
      BoundRow<n_sectors>& row = rows[sphere.sphere];
      const std::uint32_t begin = k == 0 ? 0 : ends[k - 1];
      alignas(64) std::int32_t sector_weight[n_sectors];
      for (int p = 0; p < n_sectors; p += lanes) {
        Inverses& own = inverse[p / lanes];
        if (parts[k].begins) open_to_longest(own);
        greatest<with_onset>(bins, coefficients, lines, begin, ends[k], p, own);
        if (!parts[k].ends) continue;
        *reinterpret_cast<Integers*>(&sector_weight[p]) = weigh(bins, own, p, row);
      }
      if (parts[k].ends) sum_weights(sector_weight, sphere, row);
    }
  }
}

}  // namespace

RejectionFreeKernels rejection_free_kernels() {
  // A polar step is so short that the lower line, without onset, serves as well.
  return {.equal = {make_bounds<false, polar_sectors>, make_bounds<true, cubic_sectors>,
                    seen_by<EqualSpheres>, try_step<EqualSpheres>},
          .several = {make_bounds_of_sizes<false, polar_sectors>,
                      make_bounds_of_sizes<true, cubic_sectors>, seen_by<SeveralSizes>,
                      try_step<SeveralSizes>},
          .draw_candidates = draw_candidates};
}

}  // namespace jostle::inline engine::JOSTLE_KERNELS
