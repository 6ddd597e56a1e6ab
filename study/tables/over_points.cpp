#include "study/tables/over_points.hpp"

#include <fmt/format.h>

#include "study/bad_input.hpp"

namespace jostle::inline study {

std::string of_chosen_points(const ResultsFile& file, std::span<const std::uint32_t> points) {
  const std::size_t all = file.study().points.size();
  if (points.size() >= all) return {};
  return fmt::format("; a choice of sweep points leaves {} of the file's {}: take all",
                     points.size(), all);
}

void require_taps(const ResultsFile& file, std::uint32_t point, std::size_t n_realizations) {
  if (n_realizations > 0) return;
  const std::string& label = file.study().points[point].label;
  throw BadInput(fmt::format("no realization has taps{}", label.empty() ? "" : " at " + label));
}

}  // namespace jostle::inline study
