#pragma once

#include "engine/bed/packing.hpp"

namespace jostle::inline ensemble {

/// Record of the fit of a periodic pour between walls (FittedPour), and its effect on the bed.
struct FittingReport {
  double spheres_moved = 0;
  double mean_rise = 0;  // mean rise of the moved spheres, diameters; 0 where none moved
  /// <Phi_c> of the periodic pour and of the fitted one: CorrectedFraction.
  double corrected_fraction_before = 0, corrected_fraction_after = 0;
  /// Packing fraction away from the walls, by 7 R or, if that is less, a quarter of the smaller
  /// width, between the heights of transverse_window() of the periodic pour. NaN of a bed too
  /// shallow for it.
  double central_fraction_before = 0, central_fraction_after = 0;
  bool operator==(const FittingReport&) const = default;
};

/// Compares the pour with periodic sides with the same spheres between walls, index by index.
FittingReport fitting_report(const Packing& poured, const Packing& fitted);

/// The fields above as they are stored, in order.
struct FittingColumn {
  const char *name, *units, *long_name;
  double FittingReport::*field;
};
inline constexpr FittingColumn fitting_columns[] = {
    {"spheres_moved", "1", "spheres that straddled a wall and were poured again",
     &FittingReport::spheres_moved},
    {"mean_rise", "diameter", "mean rise of these spheres", &FittingReport::mean_rise},
    {"corrected_fraction_before", "1", "<Phi_c> of the periodic pour",
     &FittingReport::corrected_fraction_before},
    {"corrected_fraction_after", "1", "<Phi_c> once fitted between walls",
     &FittingReport::corrected_fraction_after},
    {"central_fraction_before", "1", "solids fraction away from the walls, of the periodic pour",
     &FittingReport::central_fraction_before},
    {"central_fraction_after", "1", "solids fraction away from the walls, once fitted",
     &FittingReport::central_fraction_after}};

}  // namespace jostle::inline ensemble
