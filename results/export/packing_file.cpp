#include "results/export/packing_file.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "engine/bed/boundary.hpp"
#include "results/disk/error.hpp"
#include "results/export/extended_xyz.hpp"
#include "results/file/results_file.hpp"

namespace jostle::inline results {
namespace {

Packing read_snapshot(const std::string& path, const PackingSelector& selector) {
  const ResultsFile file(path);
  const Study& study = file.study();
  if (selector.point >= study.points.size())
    throw ResultsError(
        path, fmt::format("has no sweep point {}: it has {}", selector.point, study.points.size()));
  if (selector.realization >= study.realizations)
    throw ResultsError(path, fmt::format("has no realization {}: it has {}", selector.realization,
                                         study.realizations));
  const auto records = file.positions({selector.point, selector.realization});
  std::string kept;
  for (auto record = records.rbegin(); record != records.rend(); ++record) {
    if (!selector.tap || *selector.tap == record->tap)
      return {study.points[selector.point].container, record->centres,
              file.sizes({selector.point, selector.realization})};
    kept = fmt::format("{}{}{}", record->tap, kept.empty() ? "" : ", ", kept);
  }
  throw ResultsError(
      path, fmt::format("holds no positions of sweep point {}, realization {}{}; kept taps: {}",
                        selector.point, selector.realization,
                        selector.tap ? fmt::format(", tap {}", *selector.tap) : "",
                        kept.empty() ? "none" : kept));
}

}  // namespace

Packing read_packing(const std::string& path, const PackingSelector& selector) {
  if (path.ends_with(".xyz") || path.ends_with(".extxyz"))
    return read_extended_xyz(path, selector.tap);
  return read_snapshot(path, selector);
}

Packing wrapped_inside(const Packing& packing) {
  Packing moved = packing;
  const Boundary boundary(packing.container);
  for (std::size_t i = 0; i < moved.centres.size(); ++i) {
    Vec3& r = moved.centres[i];
    r = into_periods(boundary, r);
    const bool is_inside = r.x >= 0 && r.x <= boundary.width_x && r.y >= 0 &&
                           r.y <= boundary.width_y && r.z >= 0 && r.z <= boundary.height &&
                           boundary_depth(boundary, r) <= sphere_radius;
    if (!is_inside) {
      throw std::invalid_argument(fmt::format(
          "sphere {} lies outside the container, at {}, {}, {}; check that lengths are in "
          "diameters and that the packing was made in this container",
          i, r.x, r.y, r.z));
    }
  }
  return moved;
}

}  // namespace jostle::inline results
