#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fitting/curve.hpp"
#include "fitting/report.hpp"
#include "results/file/results_file.hpp"

namespace jostle::inline study {

/// A curve to fit, and where it comes from.
struct FitSource {
  std::string title;              // for people
  std::string observable, label;  // label of a results file
  std::optional<std::uint32_t> point;
  Curve curve;                          // with its realizations, where there are two or more
  std::vector<std::string> notes = {};  // on how a measured curve was read, a sentence each
  CurveUnits units = {};                // units in the heading of a measured curve
};

/// A range of t, both ends included.
struct FitRange {
  double first, last;
};

/// The mean of an observable over realizations against taps, with the realizations behind it, for
/// each of the sweep points. Realizations that failed are left out; taps that not all others have
/// reached too. Throws BadArgument naming the observables there are, ResultsError for the file.
std::vector<FitSource> results_curves(const ResultsFile& file,
                                      std::span<const std::uint32_t> points,
                                      const std::string& observable, const FitRange& range);

}  // namespace jostle::inline study
