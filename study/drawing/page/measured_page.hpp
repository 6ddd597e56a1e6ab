#pragma once

#include <span>
#include <string>

#include "study/tables/fits.hpp"

namespace jostle::inline study {

/// A figure of the catalogue as it was drawn.
struct PageFigure {
  std::string svg, caption;
};

/// One HTML page that shows a measured curve with its fits: how it was read, the figures, the
/// parameters of each law with their 95 % intervals, and remarks. It needs no network and no other
/// file, and runs nothing.
std::string measured_page(const FittedCurve& fitted, std::span<const PageFigure> figures,
                          const Provenance& provenance);

}  // namespace jostle::inline study
