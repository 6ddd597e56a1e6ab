#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "cli/analyse_run.hpp"
#include "cli/arguments.hpp"
#include "cli/available_cpus.hpp"
#include "cli/commands.hpp"
#include "cli/fit_source.hpp"
#include "cli/keep_tables.hpp"
#include "cli/output_file.hpp"
#include "cli/provenance.hpp"
#include "cli/results_input.hpp"
#include "cli/scene_file.hpp"
#include "cli/sweep_analysis.hpp"
#include "cli/table_output.hpp"

namespace jostle {

namespace {

struct AnalyseArguments {
  std::vector<std::string> inputs, observables;
  std::string point, csv;
  bool json = false, not_stored = false, force = false;
  int threads = 0;
  // Of single analyses.
  std::uint64_t last = 0, segment = 0;
  std::string window = "hann", detrend = "mean", band;
  std::vector<std::uint64_t> waiting_times, lags;
  std::string quantity = "value", against;
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
    if (arguments_.inputs.size() > 1 && !arguments_.json) fmt::print("{}\n\n", input);
    for (const Table& table : tables) {
      any_ = any_ || is_made(table);
      if (arguments_.json) {
        listed_.push_back(table_json(table));
        listed_.back()["file"] = input;
      } else {
        fmt::print("{}\n", table_text(table, Detail::full));
      }
      if (!arguments_.csv.empty()) csv_ += fmt::format("# {}\n{}", input, table_csv(table));
    }
  }

  /// Returns the exit code.
  int end(const Provenance& by) const {
    if (arguments_.json) {
      const nlohmann::json object = {{"tables", listed_}, {"provenance", provenance_json(by)}};
      std::fputs((object.dump(2) + "\n").c_str(), stdout);
    }
    if (!arguments_.csv.empty()) write_text(arguments_.csv, csv_);
    return any_ ? exit_ok : exit_bad_input;
  }

 private:
  const AnalyseArguments& arguments_;
  nlohmann::json listed_ = nlohmann::json::array();
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
      const ResultsFile file = open_results(input);
      tables = analyse(file, chosen_points(file.study(), arguments.point), analyses, threads);
    }
    output.show(tables, input);
    if (!arguments.not_stored) keep_tables(input, "analysis", tables, by);
  }
  return output.end(by);
}

/// Copies of a file hold the same run.
void require_different_runs(const std::vector<ResultsFile>& files) {
  for (std::size_t i = 0; i < files.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (files[i].run_id() != files[j].run_id()) continue;
      throw BadInput(fmt::format("{} and {} hold the same run, which counts once", files[j].path(),
                                 files[i].path()));
    }
  }
}

/// All files together; stored where they are one.
int run_sweep(const AnalyseArguments& arguments) {
  require_files(arguments);
  const Provenance by = provenance_of_this_run("");
  SweepSettings settings{.quantity = arguments.quantity, .against = arguments.against};
  if (arguments.last > 0) settings.last = arguments.last;
  std::vector<Table> tables;
  {
    std::vector<ResultsFile> files;
    for (const std::string& input : arguments.inputs) files.push_back(open_results(input));
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
  if (!arguments.not_stored && arguments.inputs.size() == 1) {
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
        return fmt::format("{}: there is no such file, and no such analysis; there are {}", text,
                           "steady, spectrum, ageing, hysteresis, sweep");
      },
      "FILE");
}

/// At every place that takes one.
CLI::Option* add_last(CLI::App& kind, AnalyseArguments& arguments, const char* description) {
  return kind.add_option("--last", arguments.last, description)->check(whole_from(1));
}

CLI::App* add_kind(CLI::App& command, const char* name, const char* description,
                   AnalyseArguments& arguments) {
  auto* kind = command.add_subcommand(name, description);
  kind->fallthrough();
  kind->add_option("--observable", arguments.observables, "Which columns of the results")
      ->required();
  return kind;
}

void add_steady(CLI::App& command, const std::shared_ptr<AnalyseArguments>& arguments, int& code) {
  auto* kind =
      add_kind(command, "steady", "Value, deviation and memory of the last taps", *arguments);
  add_last(*kind, *arguments, "Taps at the end (default: a quarter)");
  kind->callback([arguments, &code] {
    Analyses analyses;
    analyses.steady = requests(*arguments, steady_settings(*arguments));
    code = run_analyses(*arguments, analyses);
  });
}

void add_spectrum(CLI::App& command, const std::shared_ptr<AnalyseArguments>& arguments,
                  int& code) {
  auto* kind =
      add_kind(command, "spectrum", "Power spectrum of the last taps, and its slope", *arguments);
  add_last(*kind, *arguments, "Taps at the end (default: half of them)");
  kind->add_option("--segment", arguments->segment,
                   "Taps of a segment of Welch's average (default: about a quarter of them)")
      ->check(CLI::Range(16, 1000000000));
  kind->add_option("--window", arguments->window, "hann (default) or boxcar")
      ->check(CLI::IsMember({"hann", "boxcar"}));
  kind->add_option("--detrend", arguments->detrend, "Of segments: mean (default), linear or none")
      ->check(CLI::IsMember({"none", "mean", "linear"}));
  kind->add_option("--band", arguments->band,
                   "LOWEST:HIGHEST frequency of the slope, in 1/taps (default: all)");
  kind->callback([arguments, &code] {
    Analyses analyses;
    analyses.spectrum = requests(*arguments, spectrum_settings(*arguments));
    code = run_analyses(*arguments, analyses);
  });
}

void add_ageing(CLI::App& command, const std::shared_ptr<AnalyseArguments>& arguments, int& code) {
  auto* kind = add_kind(command, "ageing", "A(t, t_W), C(t, t_W), fits of eq. 6, their collapse",
                        *arguments);
  kind->add_option("--waiting-times", arguments->waiting_times,
                   "Taps t_W, separated by commas (default: 0 and two a decade)")
      ->delimiter(',');
  kind->add_option("--lags", arguments->lags, "Taps t, likewise (default: ten a decade)")
      ->delimiter(',')
      ->check(CLI::Range(1, 1000000000));
  kind->callback([arguments, &code] {
    const AgeingSettings settings{ascending("--waiting-times", arguments->waiting_times),
                                  ascending("--lags", arguments->lags)};
    Analyses analyses;
    analyses.ageing = requests(*arguments, settings);
    code = run_analyses(*arguments, analyses);
  });
}

void add_hysteresis(CLI::App& command, const std::shared_ptr<AnalyseArguments>& arguments,
                    int& code) {
  auto* kind =
      add_kind(command, "hysteresis",
               "Steady value of every step of a protocol, branches, areas of loops", *arguments);
  add_last(*kind, *arguments, "Taps at the end of each step (default: a quarter of the shortest)");
  kind->callback([arguments, &code] {
    HysteresisSettings settings;
    if (arguments->last > 0) settings.last = arguments->last;
    Analyses analyses;
    analyses.hysteresis = requests(*arguments, settings);
    code = run_analyses(*arguments, analyses);
  });
}

void add_sweep(CLI::App& command, const std::shared_ptr<AnalyseArguments>& arguments, int& code) {
  auto* kind =
      add_kind(command, "sweep",
               "A quantity against the swept value, its maximum; all files together", *arguments);
  kind->add_option("--quantity", arguments->quantity,
                   "value: mean of the last taps (default); or what is kept of an analysis or a "
                   "fit: steady/sigma, kww/rho_inf");
  kind->add_option("--against", arguments->against,
                   "JSON pointer into the scene (default: the first of the sweep)");
  add_last(*kind, *arguments, "Taps at the end (default: a quarter)");
  kind->callback([arguments, &code] { code = run_sweep(*arguments); });
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
  command->add_option("--threads", a.threads, "Threads (default: the CPUs this process may use)")
      ->check(CLI::Range(1, 4096))
      ->envname("JOSTLE_THREADS");
  command->require_subcommand(1);
  add_steady(*command, arguments, code);
  add_spectrum(*command, arguments, code);
  add_ageing(*command, arguments, code);
  add_hysteresis(*command, arguments, code);
  add_sweep(*command, arguments, code);
  command->footer(
      "Examples:\n"
      "  jostle analyse quickstart.h5 steady --observable mean_height --last 1000\n"
      "  jostle analyse *.h5 spectrum --observable mean_height --band 0.001:0.1 --json\n"
      "  jostle analyse fig5.h5 ageing --observable mean_height --waiting-times 10,100,1000\n"
      "  jostle analyse fig4.h5 hysteresis --observable bulk_fraction\n"
      "  jostle analyse bell.h5 sweep --observable bulk_fraction --last 1000\n"
      "\n"
      "Tables are kept in the file they come from, under /analysis; what they mean:\n"
      "docs/analysis.md. Exit code 2 where no analysis was possible.");
}

}  // namespace jostle
