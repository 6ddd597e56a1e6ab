#include "study/drawing/drawn/study_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "engine/bed/container.hpp"
#include "ensemble/statistics/counted.hpp"
#include "ensemble/statistics/finite_text.hpp"

namespace jostle::inline study {
namespace {

/// "four walls, 16 x 16 diameters".
std::string words(const Container& container) {
  const Vec3 size = extent(container);
  std::string title =
      std::visit([](const auto& box) { return std::string(box.description.title); }, container);
  title.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(title.front())));
  if (has_one_width(container)) return finite_text("{}, {} diameters wide", title, size.x);
  if (size.z > 0) return finite_text("{}, {} x {} x {} diameters", title, size.x, size.y, size.z);
  return finite_text("{}, {} x {} diameters", title, size.x, size.y);
}

}  // namespace

std::string bed_words(const StudyPoint& point) {
  return fmt::format("{} in {}", counted(point.n_spheres, "sphere"), words(point.container));
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
