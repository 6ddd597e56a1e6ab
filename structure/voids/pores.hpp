#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/bed/random.hpp"
#include "structure/region.hpp"
#include "structure/voids/voronoi.hpp"

// The void of a packing: the largest spheres that fit between its spheres, and the chance that a
// random sphere finds room. Lengths in diameters; xi = r / R as Philippe & Bideau 2001.
namespace jostle::inline structure {

/// A void sphere: centred on a Voronoi vertex, it touches the spheres around it.
struct Pore {
  Vec3 centre;                        // wrapped
  double radius = 0;                  // diameters; xi = radius / sphere_radius
  std::vector<std::uint32_t> owners;  // the spheres it touches, ascending: 4, more if degenerate
};

/// [PB]'s region: heights of 2 R to 20 R, 2 R away from walls.
inline constexpr Region pore_region{1, 10, 1};

/// Every Voronoi vertex that no boundary cuts, once. Vertices of different cells closer than
/// `merge` are one pore: those of exact crystals, where more than four cells meet, come out of
/// rounding as several, and under noise need a `merge` somewhat larger than it.
std::vector<Pore> pores(const Packing& packing, const VoronoiCells& cells, double merge = 1e-6);

/// Those whose centres lie in the region.
std::vector<Pore> pores_in(const std::vector<Pore>& all, const Container& container,
                           const Region& region);

/// Those that touch no sphere whose centre lies outside of the region: as Philippe & Bideau 2001
/// count them, by their numbers of pores.
std::vector<Pore> pores_of_spheres_in(const std::vector<Pore>& all, const Packing& packing,
                                      const Region& region);

/// Sites of close packing. A radius within `tolerance` of xi = sqrt(3/2) - 1 (tetrahedral) or
/// sqrt(2) - 1 (octahedral).
enum class Site { irregular, tetrahedral, octahedral };
Site site_of(const Pore& pore, double tolerance = 0.02);

/// Distributions of pore sizes: counts a unit of xi, of v = xi^3 and of ln v, as densities whose
/// integral is the number of pores. Philippe & Bideau 2001, sec. V: rho_v = rho_xi / (3 xi^2),
/// v rho_v = (xi / 3) rho_xi.
struct PoreDistribution {
  std::vector<double> xi;  // middles of the bins, [n_bins]
  std::vector<double> rho_xi, rho_v, v_rho_v;
};
PoreDistribution pore_distribution(std::span<const Pore> pores, double bin_width, double xi_max);

/// nu = <v>, the mean of xi^3.
double mean_pore_volume(std::span<const Pore> pores);

/// P0(sigma): chance that a sphere of radius sigma R, centred anywhere in the region, contains no
/// centre. Philippe & Bideau 2001, sec. V.
struct VoidProbability {
  std::vector<double> sigma, probability, error;  // error: binomial, 0 where exact
};
/// Up to sigma = 1, where spheres of radius sigma R do not overlap, exactly: one minus the part of
/// the region that they fill. Beyond by `points` random points, of which those count whose sphere
/// is in the region of possible centres (border correction: Baddeley & Gill 1997, Ann. Statist. 25,
/// 263): 1/2 + sigma R away from floor and walls, and sigma R below 2<Z> - 1/2. A sphere that
/// reaches into the layer beside a wall, where no centre can be, would more often be empty. NaN
/// where no point counts.
VoidProbability void_probability(const Packing& packing, const Region& region,
                                 std::span<const double> sigma, std::uint64_t points,
                                 StreamKey key);

/// P0 of the Percus-Yevick fluid of packing fraction phi: Gotoh's result, Philippe & Bideau
/// 2001, eqs. 8 and 9 with the sign of eq. 9's 2 phi corrected (as printed it jumps at sigma = 1).
double gotoh_void_probability(double phi, double sigma);

}  // namespace jostle::inline structure
