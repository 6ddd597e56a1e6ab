#pragma once

#include <cstdint>
#include <vector>

#include "engine/bed/packing.hpp"
#include "engine/fields.hpp"
#include "structure/region.hpp"

// Correlations over long distances. Lengths in diameters, wave numbers in 1/diameter.
namespace jostle::inline structure {

struct StructureFactorSettings {
  double k_max = 8;
  double bin_width = 0.25;
  std::uint64_t modes = 200;  // most modes of a bin, evenly spread among all
  double fit_to = 3;          // up to which k lines are drawn to k = 0
  bool operator==(const StructureFactorSettings&) const = default;

  static constexpr Description description{
      "structure_factor", "S(k) of wave vectors that fit the periodic sides, and S at k = 0"};
  template <class Self = StructureFactorSettings>
  static constexpr auto fields() {
    return std::tuple{
        field("k_max", &Self::k_max, Number{closed_range(0.5, 50), "1/diameter"},
              "Largest wave number"),
        field("bin_width", &Self::bin_width, Number{closed_range(0.01, 10), "1/diameter"},
              "Width of bins of wave numbers"),
        field("fit_to", &Self::fit_to, Number{closed_range(0.1, 50), "1/diameter"},
              "Up to which k straight lines are drawn to k = 0"),
        field("modes", &Self::modes, Whole{1, 1'000'000}, "Wave vectors of a bin, at most")};
  }
};

/// S(k) averaged over wave vectors of each bin of |k|.
struct StructureFactor {
  std::vector<double> k;             // middles of bins, [n_bins]
  std::vector<double> s;             // NaN without wave vectors, [n_bins]
  std::vector<std::uint64_t> modes;  // wave vectors averaged, each with its opposite, [n_bins]
  /// At k = 0, of straight lines by least squares through the wave vectors used up to `fit_to`: in
  /// k^2, as of fluids and solids with sound, and in k, as of jammed disordered packings. NaN with
  /// fewer than three different k.
  double s_0_of_squares, s_0_of_line;
  double fitted_from;          // least k of those wave vectors; NaN without any
  std::uint64_t fitted_modes;  // how many they are
};

/// S(k) = |sum_j w(z_j) exp(-i k . r_j)|^2 / sum_j w(z_j)^2 (Hansen & McDonald, Theory of Simple
/// Liquids, sec. 4.1, without w). Wave vectors fit the periodic sides: k_x = 2 pi n_x / width_x,
/// and y alike, so that the shape of the box adds nothing. In a fully periodic box z is alike, and
/// w = 1. With a floor the spheres between the region's heights are taken with Hann's taper w =
/// sin^2(pi (z - low)/(high - low)) and k_z = 2 pi n_z / (high - low), and k_x and k_y are not both
/// 0: the mean profile of a bed then adds nothing. The taper smears k_z by about 2 pi / (high -
/// low): wave vectors shorter than that are left out. Throws std::invalid_argument where sides are
/// walls or a cylinder, and where the region holds no sphere.
StructureFactor structure_factor(const Packing& packing, const StructureFactorSettings& settings,
                                 const Region& region);

}  // namespace jostle::inline structure
