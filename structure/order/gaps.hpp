#pragma once

#include <span>
#include <vector>

#include "engine/bed/packing.hpp"
#include "structure/order/neighbours.hpp"

// Gaps between near neighbours, contacts and rattlers. Lengths in diameters.
namespace jostle::inline structure {

/// Contacts of a sphere within a tolerance, without rattlers.
struct Backbone {
  std::vector<bool> rattler;  // [n]
  std::vector<unsigned>
      contacts;  // contacts of the other spheres with each other, floor and walls; [n]
};

/// Two spheres touch where their centres are at most 1 + `tolerance` apart, in sums of their radii;
/// a sphere and the floor or a wall where the gap is at most `tolerance` of the sphere's diameter.
/// A sphere with fewer than `least` contacts is a rattler, supports nothing and is removed, until
/// none is left (Donev, Torquato & Stillinger 2005, doi:10.1103/PhysRevE.71.011105). `near`:
/// neighbours_within_contacts(packing, at least 1 + tolerance).
Backbone backbone(const Packing& packing, const NeighbourTable& near, double tolerance,
                  unsigned least);

/// Least contacts that hold a sphere: 3 with weight, which three supports below it balance; 4 where
/// there is none, for then forces cancel only around a sphere that contacts enclose.
unsigned least_contacts_of(const Container& container);

/// The exponent gamma of a g(1 + h) that falls as h^-gamma between two limits, 0 < low < high, of
/// gaps h: their number falls as h^-gamma (1 + h)^2, the shell's area, and gamma is that of maximum
/// likelihood of those within, where the mean of ln h is the one observed. NaN for fewer than ten,
/// or where all have one size. Gaps need no order. `weights`: how often each counts, [n_gaps];
/// empty: once.
double gap_exponent(std::span<const double> gaps, double low, double high,
                    std::span<const double> weights = {});

}  // namespace jostle::inline structure
