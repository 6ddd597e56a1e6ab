#pragma once

#include <span>
#include <vector>

#include "engine/bed/packing.hpp"
#include "engine/bed/window.hpp"

// Where the solids of one packing are: packing fraction against height, against a side or from the
// walls inwards. Planes cut spheres into parts of known volume, so nothing is sampled. Lengths in
// diameters. Philippe & Bideau 2001, sec. IV.
//
// Every container but the fully periodic one has these profiles: what has no floor or no walls is
// refused with std::invalid_argument, as are edges that do not ascend and empty height windows.
namespace jostle::inline structure {

/// Packing fraction in bins: the volume of spheres in a bin over the volume of the bin.
struct Profile {
  std::vector<double> edges;    // [n_bins + 1], ascending
  std::vector<double> volumes;  // [n_bins], of the container, diameters cubed
  std::vector<double> values;   // [n_bins]

  std::size_t size() const { return values.size(); }
  double middle(std::size_t bin) const { return 0.5 * (edges[bin] + edges[bin + 1]); }
};

/// Edges from `low` by steps of `width` to `high`: the last bin is what is left, if not less than
/// 1e-9 of a step.
std::vector<double> even_edges(double low, double high, double width);

/// Heights up to the first multiple of `width` at which the packing ends: all bins are whole.
std::vector<double> height_edges(const Packing& packing, double width);

/// Where Philippe & Bideau's transverse profiles are measured: from 4 R to 0.8 x 2<Z>.
HeightWindow transverse_window(const Packing& packing);

/// Phi(z). Exact.
Profile vertical_profile(const Packing& packing, std::span<const double> edges);

/// Phi at heights without depth: the area fraction of the plane cuts, [n_heights].
std::vector<double> vertical_cuts(const Packing& packing, std::span<const double> heights);

enum class Axis { x, y };

/// Phi(x) or Phi(y) in a box, between two heights. `edges` in [0, width]. Exact.
Profile transverse_profile(const Packing& packing, Axis axis, std::span<const double> edges,
                           HeightWindow window);

/// The mean of Phi(x) and Phi(y). Requires a square footprint.
Profile mean_transverse_profile(const Packing& packing, std::span<const double> edges,
                                HeightWindow window);

/// Area fractions of vertical plane cuts at places in [0, width], between two heights, [n_places].
std::vector<double> transverse_cuts(const Packing& packing, Axis axis,
                                    std::span<const double> places, HeightWindow window);

/// Phi against the distance to the nearest wall, in a walled box between two heights. `edges` in
/// [0, half the smaller width]; bins are square frames. Exact.
Profile wall_profile(const Packing& packing, std::span<const double> edges, HeightWindow window);

/// Phi against the distance from the axis of a cylinder, between two heights. `edges` in [0,
/// diameter / 2]; bins are rings. Each sphere is shared out among them to 1e-9, its whole exactly.
Profile radial_profile(const Packing& packing, std::span<const double> edges, HeightWindow window);

/// The transverse profile within `reach` of a wall, and beyond: Philippe & Bideau 2001, fig. 7, of
/// which d Phi are the changes since the start.
struct LateralCentral {
  double lateral = 0, central = 0;
};

/// In a walled box the mean of Phi(x) and Phi(y), in a cylinder Phi(r). Requires more than 2
/// `reach` from wall to wall. The default is 7 R.
LateralCentral lateral_and_central(const Packing& packing, HeightWindow window,
                                   double reach = 7 * sphere_radius);

}  // namespace jostle::inline structure
