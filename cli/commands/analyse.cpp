#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "cli/commands/analyse_kinds.hpp"
#include "cli/commands/commands.hpp"
#include "cli/files/keep_tables.hpp"
#include "cli/files/live_input.hpp"
#include "cli/files/output_file.hpp"
#include "cli/options/values.hpp"
#include "cli/terminal/shown_tables.hpp"
#include "config/json/json_text.hpp"
#include "config/json/suggestion.hpp"
#include "study/available_cpus.hpp"
#include "study/provenance.hpp"
#include "study/tables/analyse.hpp"
#include "study/tables/motion.hpp"
#include "study/tables/points/sweep.hpp"

namespace jostle::inline cli {

namespace {

/// Below the help of one kind: an example, and a reference to the rest of its command line.
void add_example(Command kind, const std::string& example) {
  kind.footer("Example:\n  " + example +
              "\n\nFiles come before the analysis. Common options may come before or after it: "
              "jostle analyse --help.");
}

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
    const auto is_frequency = [](double end) {
      return !std::isfinite(end) || (end >= 0 && end <= 0.5);
    };
    if (!is_frequency(range.first) || !is_frequency(range.last)) {
      throw BadInput(
          fmt::format("--band {}: frequencies are from 0 to 0.5 per tap: keep both ends between",
                      arguments.band));
    }
    settings.band = Band{std::max(range.first, 0.0), std::min(range.last, 0.5)};
    if (!(settings.band->lowest < settings.band->highest)) {
      throw BadInput(fmt::format("--band {}: the lower frequency first, between 0 and 0.5 per tap",
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

/// For files that are read and written.
void require_files(const AnalyseArguments& arguments) {
  require_text_output("--csv", arguments.output.csv, arguments.inputs, arguments.output.force);
  for (const std::string& input : arguments.inputs) {
    if (!is_results_file(input)) reject_input(input, "not a results file");
  }
  require_different(arguments.inputs);
}

using TablesOf =
    std::function<std::vector<Table>(const ResultsFile&, std::span<const std::uint32_t>)>;

/// All files, each with its tables stored in itself.
int run_each(const AnalyseArguments& arguments, const TablesOf& tables_of) {
  require_files(arguments);
  const Provenance provenance = provenance_of_this_run("");
  ShownTables shown(arguments.output);
  for (const std::string& input : arguments.inputs) {
    std::vector<Table> tables;
    DataVersion made;
    {
      const ResultsFile file = open_to_read(input, arguments.output.live);
      made = file.data_version();
      tables = tables_of(file, chosen_points(file.study(), arguments.point));
    }
    if (arguments.inputs.size() > 1) shown.heading(input);
    shown.show(tables, input);
    shown.keep(input, "analysis", tables, provenance, made);
  }
  return shown.end(provenance);
}

int run_analyses(const AnalyseArguments& arguments, const Analyses& analyses) {
  const int threads = arguments.threads > 0 ? arguments.threads : available_cpus();
  return run_each(arguments, [&](const ResultsFile& file, std::span<const std::uint32_t> points) {
    return analyse(file, points, analyses, threads);
  });
}

/// All files together; stored where they are one.
int run_sweep(const AnalyseArguments& arguments) {
  require_files(arguments);
  if (!arguments.point.empty())
    throw BadInput("--sweep-point: a sweep compares all points of its files; leave it out");
  const Provenance provenance = provenance_of_this_run("");
  SweepSettings settings{.quantity = arguments.quantity,
                         .against = arguments.against,
                         .reference = arguments.reference};
  if (arguments.last > 0) settings.last = arguments.last;
  std::vector<Table> tables;
  DataVersion made;
  {
    std::vector<ResultsFile> files;
    for (const std::string& input : arguments.inputs)
      files.push_back(open_to_read(input, arguments.output.live));
    require_different_runs(files);
    made = files.front().data_version();
    std::vector<const ResultsFile*> all;
    for (const ResultsFile& file : files) all.push_back(&file);
    tables = sweep_tables(all, {}, requests(arguments, settings));
  }
  ShownTables shown(arguments.output);
  std::string names;
  for (const std::string& input : arguments.inputs) {
    names.append(names.empty() ? "" : ", ").append(input);
  }
  if (arguments.inputs.size() > 1) shown.heading(names);
  shown.show(tables, names);
  if (arguments.inputs.size() == 1)
    shown.keep(arguments.inputs.front(), "analysis", tables, provenance, made);
  return shown.end(provenance);
}

/// Refuses a tap that is there twice.
std::vector<std::uint64_t> ascending(const char* option, std::vector<std::uint64_t> taps) {
  std::ranges::sort(taps);
  const auto twice = std::ranges::adjacent_find(taps);
  if (twice == taps.end()) return taps;
  throw BadInput(fmt::format("{}: {} is there twice", option, *twice));
}

/// Describes the fault of a word that may name a file or a kind; nothing if it is a file.
std::string file_or_kind_fault(const std::string& text) {
  const std::vector<std::string> kinds{"steady",   "spectrum", "ageing",  "hysteresis", "motion",
                                       "ordering", "sweep",    "volumes", "memory"};
  const bool is_kind = std::ranges::find(kinds, text) != kinds.end();
  std::error_code unreadable;
  const std::filesystem::file_status status = std::filesystem::status(text, unreadable);
  const bool is_folder = std::filesystem::is_directory(status);
  // Rejected where it is opened: a folder, or a file that is missing or of another kind.
  if (text.ends_with(".h5") || (is_folder && !is_kind)) return {};
  if (std::filesystem::exists(status) && !is_folder) return {};
  if (is_kind)
    return fmt::format("{0} is an analysis, and follows the files: jostle analyse FILE {0}", text);
  return fmt::format("{} is neither a file nor an analysis; the analyses are {}.{}", text,
                     joined(kinds, ", "), did_you_mean(text, kinds));
}

void add_steady(AnalysisKinds& kinds, int& code) {
  Command kind =
      kinds.add("steady", "Mean, standard deviation and autocorrelation time of the last taps",
                [&code](AnalyseArguments& arguments) {
                  Analyses analyses;
                  analyses.steady = requests(arguments, steady_settings(arguments));
                  code = run_analyses(arguments, analyses);
                });
  kinds.add_last(kind, "Taps at the end (default: a quarter)");
  add_example(kind, "jostle analyse quickstart.h5 steady --observable mean_height --last 50");
}

void add_spectrum(AnalysisKinds& kinds, AnalyseArguments& a, int& code) {
  Command kind = kinds.add("spectrum", "Power spectrum of the last taps, and its slope",
                           [&code](AnalyseArguments& arguments) {
                             Analyses analyses;
                             analyses.spectrum = requests(arguments, spectrum_settings(arguments));
                             code = run_analyses(arguments, analyses);
                           });
  kinds.add_last(kind, "Taps at the end (default: half of them)");
  kinds.add_option(kind, "--segment", a.segment,
                   "Taps of a segment of Welch's average (default: about a quarter of them)",
                   [](Option option) { option.limit(16, 1000000000); });
  kinds.add_option(kind, "--window", a.window, "hann (default) or boxcar", [](Option option) {
    option.one_of({"hann", "boxcar"});
  });
  kinds.add_option(kind, "--detrend", a.detrend,
                   "Trend removed from segments: mean (default), linear or none",
                   [](Option option) {
                     option.one_of({"none", "mean", "linear"});
                   });
  kinds.add_option(kind, "--band", a.band,
                   "LOWEST:HIGHEST frequency of the slope, in 1/taps (default: all)");
  add_example(kind, "jostle analyse fig3.h5 spectrum --observable mean_height --band 0.001:0.1");
}

void add_ageing(AnalysisKinds& kinds, AnalyseArguments& a, int& code) {
  Command kind = kinds.add("ageing", "A(t, t_W), V and C, fits of eq. 6, collapse of ages",
                           [&code](AnalyseArguments& arguments) {
                             const AgeingSettings settings{
                                 ascending("--waiting-times", arguments.waiting_times),
                                 ascending("--lags", arguments.lags)};
                             Analyses analyses;
                             analyses.ageing = requests(arguments, settings);
                             code = run_analyses(arguments, analyses);
                           });
  kinds.add_option(kind, "--waiting-times", a.waiting_times,
                   "Taps t_W, separated by commas (default: 0 and two per decade)",
                   [](Option option) { option.separated_by(','); });
  kinds.add_option(kind, "--lags", a.lags,
                   "Lags t in taps, separated by commas (default: ten per decade)",
                   [](Option option) { option.separated_by(',').limit(1, 1000000000); });
  add_example(kind, "jostle analyse fig5.h5 ageing --observable mean_height --waiting-times 10,99");
}

void add_hysteresis(AnalysisKinds& kinds, int& code) {
  Command kind =
      kinds.add("hysteresis", "Steady value of every step of a protocol, branches, areas of loops",
                [&code](AnalyseArguments& arguments) {
                  HysteresisSettings settings;
                  if (arguments.last > 0) settings.last = arguments.last;
                  Analyses analyses;
                  analyses.hysteresis = requests(arguments, settings);
                  code = run_analyses(arguments, analyses);
                });
  kinds.add_last(kind, "Taps at the end of each step (default: a quarter of the shortest)");
  add_example(kind, "jostle analyse fig4.h5 hysteresis --observable bulk_fraction");
}

void add_motion(AnalysisKinds& kinds, int& code) {
  Command kind = kinds.add_of_bed(
      "motion", "How far spheres moved: displacements, overlaps and chi_4, layers",
      [&code](AnalyseArguments& arguments) { code = run_each(arguments, motion_of); });
  add_example(kind, "jostle analyse motion.h5 motion");
}

void add_ordering(AnalysisKinds& kinds, AnalyseArguments& a, int& code) {
  Command kind = kinds.add(
      "ordering", "Time to order, its law, growth; which point orders first, which ends highest",
      [&code](AnalyseArguments& arguments) {
        if (!arguments.threshold) {
          throw BadInput("--threshold is required: the value from which a packing is ordered");
        }
        if (!(std::abs(*arguments.threshold) <= 1e9)) {
          throw BadInput("--threshold is a number from -1e9 to 1e9, in units of the observable");
        }
        OrderingSettings settings{.threshold = *arguments.threshold,
                                  .hold = arguments.hold,
                                  .equilibrium = arguments.equilibrium};
        if (arguments.last > 0) settings.last = arguments.last;
        Analyses analyses;
        analyses.ordering = requests(arguments, settings);
        code = run_analyses(arguments, analyses);
      });
  kinds.add_option(kind, "--threshold", a.threshold,
                   "The value of the observable from which a packing counts as ordered");
  kinds.add_option(kind, "--hold", a.hold,
                   "Consecutive taps at or above the threshold (default: 10)",
                   [](Option option) { option.limit(1, 1000000000); });
  kinds.add_option(kind, "--equilibrium", a.equilibrium,
                   "The observable whose last taps are compared (default: that of --observable)");
  kinds.add_last(kind, "Taps at the end that are compared (default: a quarter)");
  add_example(kind, "jostle analyse lifts.h5 ordering --observable grown_layers --threshold 5");
}

void add_sweep(AnalysisKinds& kinds, AnalyseArguments& a, int& code) {
  Command kind = kinds.add(
      "sweep", "A quantity against the swept value, its maximum, differences; all files together",
      [&code](AnalyseArguments& arguments) { code = run_sweep(arguments); });
  kinds.add_option(kind, "--quantity", a.quantity,
                   "value: mean of the last taps (default); or what is kept of an analysis or a "
                   "fit: steady/sigma, kww/rho_inf");
  kinds.add_option(kind, "--against", a.against,
                   "Swept value: its name, or JSON pointer into the scene (default: the first)");
  kinds.add_option(kind, "--reference", a.reference,
                   "Point on the axis that all others are compared with (default: neighbours)");
  kinds.add_last(kind, "Taps at the end (default: a quarter)");
  add_example(kind, "jostle analyse bell.h5 sweep --observable bulk_fraction --last 1000");
}

void add_volumes(AnalysisKinds& kinds, AnalyseArguments& a, int& code) {
  Command kind = kinds.add(
      "volumes", "Variance of steady states over strengths, compactivity by two estimators",
      [&code](AnalyseArguments& arguments) {
        VolumesSettings settings{.against = arguments.against, .spheres = arguments.spheres};
        if (arguments.last > 0) settings.last = arguments.last;
        if (settings.spheres && !(*settings.spheres > 0))
          throw BadInput(fmt::format("--spheres {}: a number above 0", *settings.spheres));
        Analyses analyses;
        analyses.volumes = requests(arguments, settings);
        code = run_analyses(arguments, analyses);
      });
  kinds.add_last(kind, "Taps at the end (default: a quarter)");
  kinds.add_option(kind, "--against", a.against,
                   "Swept value: its name, or JSON pointer into the scene (default: the first)");
  kinds.add_option(kind, "--spheres", a.spheres,
                   "Spheres of the volume (default: those of the observable's window)");
  add_example(kind, "jostle analyse bell.h5 volumes --observable mean_height --last 1000");
}

void add_memory(AnalysisKinds& kinds, AnalyseArguments& a, int& code) {
  Command kind = kinds.add(
      "memory", "Dependence of the evolution after a common value on the history",
      [&code](AnalyseArguments& arguments) {
        Analyses analyses;
        analyses.memory = requests(arguments, MemorySettings{ascending("--lags", arguments.lags)});
        code = run_analyses(arguments, analyses);
      });
  kinds.add_option(kind, "--lags", a.lags,
                   "Last taps of windows after the switch, separated by commas (default: 1, 3, "
                   "10, 30, ...)",
                   [](Option option) { option.separated_by(',').limit(1, 1000000000); });
  add_example(kind, "jostle analyse memory.h5 memory --observable corrected_fraction");
}

}  // namespace

void add_analyse(Command& app, int& code) {
  Command command = app.add_command(
      "analyse",
      "Steady states, spectra, ageing, hysteresis, motion, ordering, sweeps, volumes, memory");
  auto arguments = std::make_shared<AnalyseArguments>();
  AnalyseArguments& a = *arguments;
  command.add_option("input", a.inputs, "Results, one file or several")
      .required()
      .check(file_or_kind_fault, "FILE")
      .offers_files({"h5"});
  command.add_option("--sweep-point", a.point,
                     "Sweep point: its number, VALUE or NAME=VALUE (default: every point)");
  add_table_output(command, a.output);
  command.add_threads(a.threads);
  command.require_command();
  AnalysisKinds kinds(command, arguments);
  add_steady(kinds, code);
  add_spectrum(kinds, a, code);
  add_ageing(kinds, a, code);
  add_hysteresis(kinds, code);
  add_motion(kinds, code);
  add_ordering(kinds, a, code);
  add_sweep(kinds, a, code);
  add_volumes(kinds, a, code);
  add_memory(kinds, a, code);
  command.footer(
      "Examples:\n"
      "  jostle analyse quickstart.h5 steady --observable mean_height --last 50\n"
      "  jostle analyse *.h5 spectrum --observable mean_height --band 0.001:0.1 --json\n"
      "  jostle analyse fig5.h5 ageing --observable mean_height --waiting-times 10,99\n"
      "  jostle analyse fig4.h5 hysteresis --observable bulk_fraction\n"
      "  jostle analyse motion.h5 motion\n"
      "  jostle analyse bell.h5 volumes --observable mean_height --last 1000\n"
      "  jostle analyse memory.h5 memory --observable corrected_fraction\n"
      "  jostle analyse lifts.h5 ordering --observable grown_layers --threshold 5\n"
      "  jostle analyse bell.h5 sweep --observable bulk_fraction --last 1000\n"
      "\n"
      "The options of an analysis: jostle analyse FILE steady --help. Tables are kept in the file\n"
      "they come from, under /analysis; docs/reference/analyses.md explains them. Exit code 2\n"
      "means that no analysis was possible.");
}

}  // namespace jostle::inline cli
