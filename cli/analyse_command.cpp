#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "cli/analyse_run.hpp"
#include "cli/commands.hpp"
#include "cli/fit_source.hpp"
#include "cli/keep_tables.hpp"
#include "cli/provenance.hpp"
#include "cli/scene_file.hpp"
#include "cli/table_output.hpp"

namespace jostle {

namespace {

struct AnalyseArguments {
  std::vector<std::string> inputs, observables;
  std::string point, csv;
  bool json = false, not_stored = false;
  // Of single analyses.
  std::uint64_t last = 0, segment = 0;
  std::string window = "hann", detrend = "mean", band;
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

/// All files, each with its tables stored in itself.
int run_analyses(const AnalyseArguments& arguments, const Analyses& analyses) {
  const Provenance by = provenance_of_this_run("");
  auto listed = nlohmann::json::array();
  std::string csv;
  bool any = false;
  for (const std::string& input : arguments.inputs) {
    if (!is_results_file(input)) throw BadInput(fmt::format("{}: not a results file", input));
    std::vector<Table> tables;
    {
      const ResultsFile file(input);
      tables = analyse(file, chosen_points(file.study(), arguments.point), analyses);
    }
    if (arguments.inputs.size() > 1 && !arguments.json) fmt::print("{}\n\n", input);
    for (const Table& table : tables) {
      any = any || is_made(table);
      if (arguments.json) {
        listed.push_back(table_json(table));
        listed.back()["file"] = input;
      } else {
        fmt::print("{}\n", table_text(table, Detail::full));
      }
      if (!arguments.csv.empty()) csv += fmt::format("# {}\n{}", input, table_csv(table));
    }
    if (!arguments.not_stored) keep_tables(input, "analysis", tables, by);
  }
  if (arguments.json) {
    const nlohmann::json object = {{"tables", listed}, {"provenance", provenance_json(by)}};
    std::fputs((object.dump(2) + "\n").c_str(), stdout);
  }
  if (!arguments.csv.empty()) write_text(arguments.csv, csv);
  return any ? exit_ok : exit_bad_input;
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
  kind->add_option("--last", arguments->last, "Taps at the end (default: a quarter)");
  kind->callback([arguments, &code] {
    code = run_analyses(
        *arguments, {.steady = requests(*arguments, steady_settings(*arguments)), .spectrum = {}});
  });
}

void add_spectrum(CLI::App& command, const std::shared_ptr<AnalyseArguments>& arguments,
                  int& code) {
  auto* kind =
      add_kind(command, "spectrum", "Power spectrum of the last taps, and its slope", *arguments);
  kind->add_option("--last", arguments->last, "Taps at the end (default: half of them)");
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
    code = run_analyses(
        *arguments,
        {.steady = {}, .spectrum = requests(*arguments, spectrum_settings(*arguments))});
  });
}

}  // namespace

void add_analyse(CLI::App& app, int& code) {
  auto* command = app.add_subcommand("analyse", "Steady states and spectra of results");
  auto arguments = std::make_shared<AnalyseArguments>();
  AnalyseArguments& a = *arguments;
  command->add_option("input", a.inputs, "Results, one file or several")
      ->required()
      ->check(CLI::ExistingFile);
  command->add_option("--sweep-point", a.point,
                      "Its number, or POINTER=VALUE of the sweep (default: every point)");
  command->add_flag("--json", a.json, "Print JSON, for programs");
  command->add_option("--csv", a.csv, "Also write the tables to this file");
  command->add_flag("--no-store", a.not_stored, "Leave the results files as they are");
  command->require_subcommand(1);
  add_steady(*command, arguments, code);
  add_spectrum(*command, arguments, code);
  command->footer(
      "Examples:\n"
      "  jostle analyse quickstart.h5 steady --observable mean_height --last 1000\n"
      "  jostle analyse *.h5 spectrum --observable mean_height --band 0.001:0.1 --json\n"
      "\n"
      "Tables are kept in the file they come from, under /analysis; what they mean:\n"
      "docs/analysis.md. Exit code 2 where no analysis was possible.");
}

}  // namespace jostle
