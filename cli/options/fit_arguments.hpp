#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cli/files/live_input.hpp"
#include "cli/files/waiting.hpp"
#include "cli/reports/measured_output.hpp"
#include "cli/tables/layout.hpp"
#include "study/tables/laws/own_law.hpp"

namespace jostle::inline cli {

/// The command line of `jostle fit`.
struct FitArguments {
  std::string input, observable, point, range, csv;
  std::vector<std::string> models, fixed, start, bounds;  // start, bounds: for an own law
  OwnLaw law;
  std::string resample = "none";
  std::uint32_t count = 1000;
  std::uint64_t seed = 1;
  int threads = 0;
  bool json = false, force = false, not_stored = false;
  MeasuredOutput measured;  // curves of a text file
  Layout layout;
  bool realizations = false;  // columns of a curve file
  std::string gaps = "use-others";
  bool gaps_asked_for = false, independent = false;
  Live live = Live::no;
  Patience patience;
  bool resampling_asked_for = false;
};

/// Throws BadInput for options that have no sense with a results file.
void refuse_options_of_text(const FitArguments& arguments);
/// Throws BadInput for options that have no sense with a text file, or with this one.
void refuse_options_of_results(const FitArguments& arguments);

}  // namespace jostle::inline cli
