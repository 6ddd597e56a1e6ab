#include "cli/options/fit_arguments.hpp"

#include <fmt/format.h>

#include "study/bad_input.hpp"

namespace jostle::inline cli {

void refuse_options_of_text(const FitArguments& arguments) {
  if (arguments.realizations || arguments.gaps_asked_for) {
    throw BadInput(fmt::format(
        "{} applies only to the columns of a text file; a results file stores its own realizations",
        arguments.realizations ? "--realizations" : "--gaps"));
  }
  if (arguments.independent) {
    throw BadInput(
        "--independent applies only to rows of a text file; taps of a run are correlated");
  }
  if (arguments.measured.is_wanted()) {
    throw BadInput(
        fmt::format("--figures and --page apply only to a measured curve; jostle report {} draws "
                    "the stored fits of a run",
                    arguments.input));
  }
}

void refuse_options_of_results(const FitArguments& arguments) {
  if (!arguments.observable.empty() || !arguments.point.empty()) {
    throw BadInput(fmt::format(
        "{}: not a results file, but a text file, which has one curve: leave {} out",
        arguments.input, arguments.observable.empty() ? "--sweep-point" : "--observable"));
  }
  if (arguments.resampling_asked_for && !arguments.realizations)
    throw BadInput(fmt::format("{}: --resample requires --realizations", arguments.input));
  if (arguments.not_stored) {
    throw BadInput(fmt::format(
        "{}: --no-store applies only to results files; fits of a text file are never stored",
        arguments.input));
  }
  if (arguments.live == Live::yes)
    throw BadInput(fmt::format("{}: --live applies only to results files", arguments.input));
  if (arguments.gaps_asked_for && !arguments.realizations) {
    throw BadInput("--gaps applies only to columns of realizations: add --realizations");
  }
  if (arguments.independent && arguments.realizations) {
    throw BadInput("--independent applies only to a single curve: omit it with --realizations");
  }
}

}  // namespace jostle::inline cli
