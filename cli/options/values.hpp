#pragma once

#include <string>

#include "study/tables/fit_source.hpp"

namespace jostle::inline cli {

/// "1:4000", ":4000", "1:". Throws BadInput naming the option.
FitRange read_range(const std::string& option, const std::string& text);

}  // namespace jostle::inline cli
