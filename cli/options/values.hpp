#pragma once

#include <string>
#include <utility>
#include <vector>

#include "results/export/export.hpp"
#include "study/tables/fit_source.hpp"

namespace jostle::inline cli {

/// "1:4000", ":4000", "1:". Throws BadInput naming the option and the range with its prefix
/// ("tau=").
FitRange read_range(const std::string& option, const std::string& text,
                    const std::string& prefix = "");

using NamedNumber = std::pair<std::string, double>;

/// Texts "NAME=NUMBER", in their order. Throws BadInput naming the option.
std::vector<NamedNumber> named_numbers(const std::string& option,
                                       const std::vector<std::string>& texts);

/// Numbers of taps, or "all". Throws BadInput naming the option.
KeptTaps kept_taps(const std::string& option, const std::vector<std::string>& words);

}  // namespace jostle::inline cli
