#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/terminal/results_input.hpp"
#include "fitting/curve.hpp"
#include "results/study.hpp"

namespace jostle {

/// A curve to fit, and where it comes from.
struct FitSource {
  std::string title;              // for people
  std::string observable, label;  // of a results file
  std::optional<std::uint32_t> point;
  Curve curve;  // with its realizations, where there are two or more
};

/// A range of t, both ends included.
struct FitRange {
  double first, last;
};

/// "1:4000", ":4000", "1:". Throws BadInput naming the option.
FitRange read_range(const std::string& option, const std::string& text);

/// The mean of an observable over realizations against taps, with the realizations behind it, for
/// one sweep point (its number, or "pointer=value" as in the scene's sweep) or, where `point` is
/// empty, for all. Realizations that failed are left out; taps that not all others have reached
/// too. Throws BadInput naming what there is, ResultsError for the file.
std::vector<FitSource> results_curves(const std::string& path, const std::string& observable,
                                      const std::string& point, const FitRange& range,
                                      Live live = Live::no);

}  // namespace jostle
