#include "study/drawing/drawn/study_words.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ensemble/statistics/counted.hpp"
#include "ensemble/statistics/finite_text.hpp"

namespace jostle::inline study {
namespace {

std::string words(const PeriodicBox& box) {
  return finite_text("periodic sides, {} x {} diameters", box.width_x, box.width_y);
}
std::string words(const WalledBox& box) {
  return finite_text("four walls, {} x {} diameters", box.width_x, box.width_y);
}
std::string words(const Cylinder& tube) {
  return finite_text("a cylinder, {} diameters wide", tube.diameter);
}
std::string words(const FullyPeriodicBox& box) {
  return finite_text("a fully periodic box, {} x {} x {} diameters", box.width_x, box.width_y,
                     box.height);
}

}  // namespace

std::string bed_words(const StudyPoint& point) {
  return fmt::format("{} in {}", counted(point.n_spheres, "sphere"),
                     std::visit([](const auto& one) { return words(one); }, point.container));
}

std::string study_words(const Study& study) {
  if (study.points.empty()) return {};
  const StudyPoint& first = study.points.front();
  const bool one_bed = std::ranges::all_of(study.points, [&](const StudyPoint& point) {
    return point.n_spheres == first.n_spheres && point.container == first.container;
  });
  const std::string per_point = study.points.size() > 1 ? " per sweep point" : "";
  return fmt::format("{}; {}{}", one_bed ? bed_words(first) : "beds that differ with the sweep",
                     counted(study.realizations, "realization"), per_point);
}

}  // namespace jostle::inline study
