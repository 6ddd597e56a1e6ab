#include "ensemble/fitting_report.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>

#include "engine/bed/boundary.hpp"
#include "structure/density/profiles.hpp"
#include "structure/observables.hpp"

namespace jostle::inline ensemble {

namespace {

double corrected_fraction(const Packing& packing) {
  return Observer({CorrectedFraction{}}, packing)(packing).front();
}

double central_fraction(const Container& box, const std::vector<Vec3>& centres,
                        HeightWindow window) {
  if (!(window.low < window.high)) return std::numeric_limits<double>::quiet_NaN();
  const Boundary boundary(box);
  double width = std::numeric_limits<double>::infinity();  // between walls
  if (boundary.tube || boundary.planes_x()) width = std::min(width, boundary.width_x);
  if (boundary.tube || boundary.planes_y()) width = std::min(width, boundary.width_y);
  const std::array<double, 2> edges{std::min(7 * sphere_radius, 0.25 * width), 0.5 * width};
  return wall_profile({box, centres}, edges, window).values.front();
}

}  // namespace

FittingReport fitting_report(const Packing& poured, const Packing& fitted) {
  assert(poured.centres.size() == fitted.centres.size());
  FittingReport report;
  for (std::size_t i = 0; i < poured.centres.size(); ++i) {
    if (poured.centres[i] == fitted.centres[i]) continue;
    ++report.spheres_moved;
    report.mean_rise += fitted.centres[i].z - poured.centres[i].z;
  }
  if (report.spheres_moved > 0) report.mean_rise /= report.spheres_moved;
  report.corrected_fraction_before = corrected_fraction(poured);
  report.corrected_fraction_after = corrected_fraction(fitted);
  const HeightWindow window = transverse_window(poured);
  report.central_fraction_before = central_fraction(fitted.container, poured.centres, window);
  report.central_fraction_after = central_fraction(fitted.container, fitted.centres, window);
  return report;
}

}  // namespace jostle::inline ensemble
