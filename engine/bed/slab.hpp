#pragma once

#include <span>

#include "engine/bed/packing.hpp"
#include "engine/bed/window.hpp"

// Packing fractions in closed form: a plane cuts a sphere into segments of known volume.
namespace jostle::inline engine {

/// Volume of the part of a sphere centred at height z in [low, high], diameters cubed.
/// Requires low <= high and diameter > 0.
double sphere_volume_in_slab(double z, double low, double high, double diameter = 1);

/// Packing fraction of the container between two heights: volume of spheres / volume of the slab.
/// Exact but for rounding. For a window without depth, as the quantiles of a single layer on the
/// floor give, it is the area fraction of the plane cut there (and so below 1e-5 diameters, to
/// 1e-10). Requires window.low <= window.high, and in a fully periodic box a window inside [0,
/// height]: spheres that reach through its ends count on both sides.
double solids_fraction(const Packing& packing, HeightWindow window);

/// Mean of the packing fractions of the windows [low + s, high + s], s uniform from -taper/2 to
/// taper/2, exact but for rounding: as if both edges rose and fell linearly over `taper` diameters.
/// A taper of one layer spacing takes every layer of a crystal wholly or not at all, wherever
/// the edges lie. 0: solids_fraction. Heights below the floor and above the bed count as empty.
/// Requires low <= high, taper >= 0, and for a taper a container with a floor.
double tapered_solids_fraction(const Packing& packing, HeightWindow window, double taper);

/// The window in heights: a height window is itself; a quantile window is taken from the heights
/// of the centres of `packing` (linear interpolation between order statistics, numpy's default).
/// In a mixture a centre counts by the volume of its sphere: half of each sphere's volume is
/// counted below its centre, and these fractions are stretched so that the lowest centre is at 0
/// and the highest at 1.
HeightWindow resolve(const Window& window, const Packing& packing);

}  // namespace jostle::inline engine
