#include "study/tables/over_points.hpp"

#include <fmt/format.h>

namespace jostle::inline study {

std::string of_chosen_points(const ResultsFile& file, std::span<const std::uint32_t> points) {
  const std::size_t all = file.study().points.size();
  if (points.size() >= all) return {};
  return fmt::format("; a choice of sweep points leaves {} of the file's {}: take all",
                     points.size(), all);
}

}  // namespace jostle::inline study
