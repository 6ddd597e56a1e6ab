#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/options/command.hpp"
#include "cli/terminal/shown_tables.hpp"
#include "config/scene.hpp"
#include "study/bad_input.hpp"

namespace jostle::inline cli {

/// All that `jostle analyse` is asked for.
struct AnalyseArguments {
  std::vector<std::string> inputs, observables;
  std::string point;
  TableOutput output;
  int threads = 0;
  // For single analyses.
  std::uint64_t last = 0, segment = 0;
  std::string window = "hann", detrend = "mean", band;
  std::vector<std::uint64_t> waiting_times, lags;
  std::string quantity = "value", against;
  std::optional<double> reference, spheres, threshold;
  std::uint64_t hold = OrderingSettings{}.hold;
  std::string equilibrium;
};

/// The options of the kinds of analyses: each belongs to its kind, and is accepted before and after
/// the kind's name.
class AnalysisKinds {
 public:
  AnalysisKinds(Command command, std::shared_ptr<AnalyseArguments> arguments)
      : command_(command), arguments_(std::move(arguments)) {}

  /// `run` is called once the whole command line has been read.
  Command add(const char* name, const char* description,
              std::function<void(AnalyseArguments&)> run) {
    Command kind = add_of_bed(name, description, [run = std::move(run)](AnalyseArguments& given) {
      if (given.observables.empty()) {
        throw BadInput("--observable is required: the columns of the results to analyse");
      }
      run(given);
    });
    add_option(kind, "--observable", arguments_->observables,
               "Columns of the results, separated by commas",
               [](Option option) { option.separated_by(','); });
    return kind;
  }

  /// One that is not of an observable.
  Command add_of_bed(const char* name, const char* description,
                     std::function<void(AnalyseArguments&)> run) {
    Command kind = command_.add_command(name, description);
    kind.fall_through();
    kind.run([command = command_, arguments = arguments_, kind, run = std::move(run)] {
      require_options_of(command, kind);
      run(*arguments);
    });
    return kind;
  }

  /// `restrict` adds checks to the option at either place.
  template <class T>
  void add_option(Command kind, const std::string& name, T& value, const char* description,
                  const std::function<void(Option)>& restrict = {}) {
    const Option option = kind.add_option(name, value, description);
    if (restrict) restrict(option);
    if (command_.has_option(name)) return;
    const Option leading_option = command_.add_hidden_option(name, value);
    if (restrict) restrict(leading_option);
  }

  void add_last(Command kind, const char* description) {
    add_option(kind, "--last", arguments_->last, description,
               [](Option option) { option.whole_from(1); });
  }

 private:
  /// An option of another kind before the name of this one.
  static void require_options_of(const Command& command, const Command& kind) {
    for (const std::string& name : command.hidden_options_given()) {
      if (!kind.has_option(name)) {
        throw BadInput(fmt::format("{} has no option {}; jostle analyse {} --help lists them",
                                   kind.name(), name, kind.name()));
      }
      if (kind.count(name) > 0) {
        throw BadInput(fmt::format("{} is there twice, before and after {}", name, kind.name()));
      }
    }
  }

  Command command_;
  std::shared_ptr<AnalyseArguments> arguments_;
};

}  // namespace jostle::inline cli
