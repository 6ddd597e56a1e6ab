#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>

#include "cli/commands/arguments.hpp"
#include "cli/commands/commands.hpp"
#include "cli/terminal/keep_tables.hpp"
#include "cli/terminal/live_input.hpp"
#include "cli/terminal/output_file.hpp"
#include "cli/terminal/standard_streams.hpp"
#include "cli/terminal/table_output.hpp"
#include "config/json/json_text.hpp"
#include "config/json/suggestion.hpp"
#include "study/available_cpus.hpp"
#include "study/provenance.hpp"
#include "study/tables/analyse.hpp"
#include "study/tables/sweep.hpp"

namespace jostle {

namespace {

struct AnalyseArguments {
  std::vector<std::string> inputs, observables;
  std::string point, csv;
  bool json = false, not_stored = false, force = false;
  Live live = Live::no;
  int threads = 0;
  // Of single analyses.
  std::uint64_t last = 0, segment = 0;
  std::string window = "hann", detrend = "mean", band;
  std::vector<std::uint64_t> waiting_times, lags;
  std::string quantity = "value", against;
  std::optional<double> reference;
};

SpectrumSettings spectrum_settings(const AnalyseArguments& arguments) {
  SpectrumSettings settings;
  if (arguments.last > 0) settings.last = arguments.last;
  if (arguments.segment > 0) settings.segment = arguments.segment;
  settings.window = arguments.window == "hann" ? Taper::hann : Taper::boxcar;
  settings.detrending = arguments.detrend == "none"   ? Detrending::none
                        : arguments.detrend == "mean" ? Detrending::mean
                                                      : Detrending::linear;
  if (!arguments.band.empty()) {
    const FitRange range = read_range("--band", arguments.band);
    settings.band = Band{std::max(range.first, 0.0), std::min(range.last, 0.5)};
    if (!(settings.band->lowest < settings.band->highest)) {
      throw BadInput(fmt::format("--band {}: the lower frequency first, between 0 and 0.5 a tap",
                                 arguments.band));
    }
  }
  return settings;
}

SteadySettings steady_settings(const AnalyseArguments& arguments) {
  SteadySettings settings;
  if (arguments.last > 0) settings.last = arguments.last;
  return settings;
}

template <class Settings>
std::vector<AnalysisRequest<Settings>> requests(const AnalyseArguments& arguments,
                                                const Settings& settings) {
  std::vector<AnalysisRequest<Settings>> all;
  for (const std::string& observable : arguments.observables) all.push_back({observable, settings});
  return all;
}

/// Prints tables and gathers what is written at the end.
class Output {
 public:
  explicit Output(const AnalyseArguments& arguments) : arguments_(arguments) {}

  void show(const std::vector<Table>& tables, const std::string& input) {
    if (arguments_.inputs.size() > 1 && !arguments_.json) print(fmt::format("{}\n\n", input));
    for (const Table& table : tables) {
      any_ = any_ || is_made(table);
      if (arguments_.json) {
        Json listed = table_json(table);
        listed["file"] = input;
        listed_.push_back(std::move(listed));
      } else {
        print(fmt::format("{}\n", table_text(table, Detail::full)));
      }
      if (!arguments_.csv.empty()) csv_ += fmt::format("# {}\n{}", input, table_csv(table));
    }
  }

  /// Returns the exit code.
  int end(const Provenance& by) const {
    if (arguments_.json) {
      const Json object = {{"tables", listed_}, {"provenance", provenance_json(by)}};
      print_json(object);
    }
    if (!arguments_.csv.empty()) write_text(arguments_.csv, csv_);
    return any_ ? exit_ok : exit_bad_input;
  }

 private:
  const AnalyseArguments& arguments_;
  Json listed_ = Json::array();
  std::string csv_;
  bool any_ = false;
};

/// Of what is read and what is written.
void require_files(const AnalyseArguments& arguments) {
  require_text_output("--csv", arguments.csv, arguments.inputs, arguments.force);
  for (const std::string& input : arguments.inputs) {
    if (!is_results_file(input)) throw BadInput(fmt::format("{}: not a results file", input));
  }
  require_different(arguments.inputs);
}

/// All files, each with its tables stored in itself.
int run_analyses(const AnalyseArguments& arguments, const Analyses& analyses) {
  require_files(arguments);
  const Provenance by = provenance_of_this_run("");
  const int threads = arguments.threads > 0 ? arguments.threads : available_cpus();
  Output output(arguments);
  for (const std::string& input : arguments.inputs) {
    std::vector<Table> tables;
    {
      const ResultsFile file = open_to_read(input, arguments.live);
      tables = analyse(file, chosen_points(file.study(), arguments.point), analyses, threads);
    }
    output.show(tables, input);
    if (!arguments.not_stored && arguments.live == Live::no)
      keep_tables(input, "analysis", tables, by);
  }
  return output.end(by);
}

/// All files together; stored where they are one.
int run_sweep(const AnalyseArguments& arguments) {
  require_files(arguments);
  const Provenance by = provenance_of_this_run("");
  SweepSettings settings{.quantity = arguments.quantity,
                         .against = arguments.against,
                         .reference = arguments.reference};
  if (arguments.last > 0) settings.last = arguments.last;
  std::vector<Table> tables;
  {
    std::vector<ResultsFile> files;
    for (const std::string& input : arguments.inputs)
      files.push_back(open_to_read(input, arguments.live));
    require_different_runs(files);
    std::vector<const ResultsFile*> all;
    for (const ResultsFile& file : files) all.push_back(&file);
    tables = sweep_tables(all, {}, requests(arguments, settings));
  }
  Output output(arguments);
  std::string names;
  for (const std::string& input : arguments.inputs) {
    names.append(names.empty() ? "" : ", ").append(input);
  }
  output.show(tables, names);
  if (!arguments.not_stored && arguments.live == Live::no && arguments.inputs.size() == 1) {
    keep_tables(arguments.inputs.front(), "analysis", tables, by);
  }
  return output.end(by);
}

/// Refuses a tap that is there twice.
std::vector<std::uint64_t> ascending(const char* option, std::vector<std::uint64_t> taps) {
  std::ranges::sort(taps);
  const auto twice = std::ranges::adjacent_find(taps);
  if (twice == taps.end()) return taps;
  throw BadInput(fmt::format("{}: {} is there twice", option, *twice));
}

/// The names of kinds stand among those of files.
CLI::Validator existing_file() {
  return CLI::Validator(
      [](const std::string& text) -> std::string {
        if (CLI::ExistingFile(std::string(text)).empty()) return {};
        const std::vector<std::string> kinds{"steady", "spectrum", "ageing", "hysteresis", "sweep"};
        return fmt::format("{}: there is no such file, and no such analysis; there are {}.{}", text,
                           joined(kinds, ", "), did_you_mean(text, kinds));
      },
      "FILE");
}

/// The options of the kinds of analyses: each belongs to its kind, and stands before the kind's
/// name as well as behind it.
class Kinds {
 public:
  Kinds(CLI::App& command, std::shared_ptr<AnalyseArguments> arguments)
      : command_(command), arguments_(std::move(arguments)) {}

  /// `run` is called once the whole command line has been read.
  CLI::App& add(const char* name, const char* description,
                std::function<void(AnalyseArguments&)> run) {
    auto* kind = command_.add_subcommand(name, description);
    kind->fallthrough();
    add_option(*kind, "--observable", arguments_->observables, "Which columns of the results");
    kind->callback([&command = command_, arguments = arguments_, kind, run = std::move(run)] {
      require_options_of(command, *kind);
      if (arguments->observables.empty()) {
        throw BadInput("--observable is required: the columns of the results to analyse");
      }
      run(*arguments);
    });
    return *kind;
  }

  /// `restrict` adds checks to the option at either place.
  template <class T>
  void add_option(CLI::App& kind, const std::string& name, T& value, const char* description,
                  const std::function<void(CLI::Option&)>& restrict = {}) {
    auto* option = kind.add_option(name, value, description);
    if (restrict) restrict(*option);
    if (command_.get_option_no_throw(name)) return;
    auto* before = command_.add_option(name, value)->group("");  // hidden
    if (restrict) restrict(*before);
  }

  void add_last(CLI::App& kind, const char* description) {
    add_option(kind, "--last", arguments_->last, description,
               [](CLI::Option& option) { option.check(whole_from(1)); });
  }

 private:
  /// An option of another kind before the name of this one.
  static void require_options_of(const CLI::App& command, const CLI::App& kind) {
    for (const CLI::Option* option : command.get_options()) {
      if (option->count() == 0 || !option->get_group().empty()) continue;
      const std::string name = "--" + option->get_single_name();
      const auto* own = kind.get_option_no_throw(name);
      if (!own) {
        throw BadInput(fmt::format("{} has no option {}; jostle analyse {} --help lists them",
                                   kind.get_name(), name, kind.get_name()));
      }
      if (own->count() > 0) {
        throw BadInput(
            fmt::format("{} is there twice, before and after {}", name, kind.get_name()));
      }
    }
  }

  CLI::App& command_;
  std::shared_ptr<AnalyseArguments> arguments_;
};

void add_steady(Kinds& kinds, int& code) {
  CLI::App& kind = kinds.add("steady", "Value, deviation and memory of the last taps",
                             [&code](AnalyseArguments& arguments) {
                               Analyses analyses;
                               analyses.steady = requests(arguments, steady_settings(arguments));
                               code = run_analyses(arguments, analyses);
                             });
  kinds.add_last(kind, "Taps at the end (default: a quarter)");
}

void add_spectrum(Kinds& kinds, AnalyseArguments& a, int& code) {
  CLI::App& kind = kinds.add("spectrum", "Power spectrum of the last taps, and its slope",
                             [&code](AnalyseArguments& arguments) {
                               Analyses analyses;
                               analyses.spectrum =
                                   requests(arguments, spectrum_settings(arguments));
                               code = run_analyses(arguments, analyses);
                             });
  kinds.add_last(kind, "Taps at the end (default: half of them)");
  kinds.add_option(kind, "--segment", a.segment,
                   "Taps of a segment of Welch's average (default: about a quarter of them)",
                   [](CLI::Option& option) { option.check(CLI::Range(16, 1000000000)); });
  kinds.add_option(kind, "--window", a.window, "hann (default) or boxcar", [](CLI::Option& option) {
    option.check(CLI::IsMember({"hann", "boxcar"}));
  });
  kinds.add_option(kind, "--detrend", a.detrend, "Of segments: mean (default), linear or none",
                   [](CLI::Option& option) {
                     option.check(CLI::IsMember({"none", "mean", "linear"}));
                   });
  kinds.add_option(kind, "--band", a.band,
                   "LOWEST:HIGHEST frequency of the slope, in 1/taps (default: all)");
}

void add_ageing(Kinds& kinds, AnalyseArguments& a, int& code) {
  CLI::App& kind = kinds.add("ageing", "A(t, t_W), C(t, t_W), fits of eq. 6, their collapse",
                             [&code](AnalyseArguments& arguments) {
                               const AgeingSettings settings{
                                   ascending("--waiting-times", arguments.waiting_times),
                                   ascending("--lags", arguments.lags)};
                               Analyses analyses;
                               analyses.ageing = requests(arguments, settings);
                               code = run_analyses(arguments, analyses);
                             });
  kinds.add_option(kind, "--waiting-times", a.waiting_times,
                   "Taps t_W, separated by commas (default: 0 and two a decade)",
                   [](CLI::Option& option) { option.delimiter(','); });
  kinds.add_option(
      kind, "--lags", a.lags, "Taps t, likewise (default: ten a decade)",
      [](CLI::Option& option) { option.delimiter(',')->check(CLI::Range(1, 1000000000)); });
}

void add_hysteresis(Kinds& kinds, int& code) {
  CLI::App& kind =
      kinds.add("hysteresis", "Steady value of every step of a protocol, branches, areas of loops",
                [&code](AnalyseArguments& arguments) {
                  HysteresisSettings settings;
                  if (arguments.last > 0) settings.last = arguments.last;
                  Analyses analyses;
                  analyses.hysteresis = requests(arguments, settings);
                  code = run_analyses(arguments, analyses);
                });
  kinds.add_last(kind, "Taps at the end of each step (default: a quarter of the shortest)");
}

void add_sweep(Kinds& kinds, AnalyseArguments& a, int& code) {
  CLI::App& kind = kinds.add(
      "sweep", "A quantity against the swept value, its maximum, differences; all files together",
      [&code](AnalyseArguments& arguments) { code = run_sweep(arguments); });
  kinds.add_option(kind, "--quantity", a.quantity,
                   "value: mean of the last taps (default); or what is kept of an analysis or a "
                   "fit: steady/sigma, kww/rho_inf");
  kinds.add_option(kind, "--against", a.against,
                   "JSON pointer into the scene (default: the first of the sweep)");
  kinds.add_option(kind, "--reference", a.reference,
                   "Point on the axis that all others are compared with (default: neighbours)");
  kinds.add_last(kind, "Taps at the end (default: a quarter)");
}

}  // namespace

void add_analyse(CLI::App& app, int& code) {
  auto* command = app.add_subcommand(
      "analyse", "Steady states, spectra, ageing, hysteresis and sweeps of results");
  auto arguments = std::make_shared<AnalyseArguments>();
  AnalyseArguments& a = *arguments;
  command->add_option("input", a.inputs, "Results, one file or several")
      ->required()
      ->check(existing_file());
  command->add_option("--sweep-point", a.point,
                      "Its number, or POINTER=VALUE of the sweep (default: every point)");
  command->add_flag("--json", a.json, "Print JSON, for programs");
  command->add_option("--csv", a.csv, "Also write the tables to this file")->check(file_to_write());
  command->add_flag("--force", a.force, "Replace the file of --csv if it exists");
  command->add_flag("--no-store", a.not_stored, "Leave the results files as they are");
  add_live(*command, a.live);
  command->add_option("--threads", a.threads, "Threads (default: the CPUs this process may use)")
      ->check(CLI::Range(1, 4096))
      ->envname("JOSTLE_THREADS");
  command->require_subcommand(1);
  Kinds kinds(*command, arguments);
  add_steady(kinds, code);
  add_spectrum(kinds, a, code);
  add_ageing(kinds, a, code);
  add_hysteresis(kinds, code);
  add_sweep(kinds, a, code);
  command->footer(
      "Examples:\n"
      "  jostle analyse quickstart.h5 steady --observable mean_height --last 50\n"
      "  jostle analyse *.h5 spectrum --observable mean_height --band 0.001:0.1 --json\n"
      "  jostle analyse fig5.h5 ageing --observable mean_height --waiting-times 10,100,1000\n"
      "  jostle analyse fig4.h5 hysteresis --observable bulk_fraction\n"
      "  jostle analyse bell.h5 sweep --observable bulk_fraction --last 1000\n"
      "\n"
      "Tables are kept in the file they come from, under /analysis; what they mean:\n"
      "docs/analysis.md. Exit code 2 where no analysis was possible.");
}

}  // namespace jostle
