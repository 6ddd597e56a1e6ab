#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include "cli/commands/arguments.hpp"
#include "cli/commands/commands.hpp"
#include "cli/terminal/cost_report.hpp"
#include "cli/terminal/failure.hpp"
#include "cli/terminal/keep_tables.hpp"
#include "cli/terminal/output_file.hpp"
#include "cli/terminal/progress_display.hpp"
#include "cli/terminal/results_input.hpp"
#include "cli/terminal/standard_streams.hpp"
#include "cli/terminal/stop_request.hpp"
#include "cli/terminal/table_output.hpp"
#include "config/grids.hpp"
#include "config/json/json_text.hpp"
#include "config/json/suggestion.hpp"
#include "config/sweep.hpp"
#include "ensemble/run.hpp"
#include "results/live_run.hpp"
#include "results/run_store.hpp"
#include "study/available_cpus.hpp"
#include "study/cost/rounds.hpp"
#include "study/provenance.hpp"
#include "study/scene_file.hpp"
#include "study/tables/fit_source.hpp"

namespace jostle {
namespace {

constexpr std::uint32_t fewest_rounds = 2;  // an error needs two
constexpr std::uint64_t default_taps = 10;

struct CostArguments {
  std::string scene, output, observable, point, csv, figure;
  double target = 0;
  Seconds budget{600};
  std::uint32_t rounds = 0;  // 0: as many as the budget allows
  std::uint64_t taps = 0;
  int threads = 0;
  bool resume = false, force = false, no_progress = false;
};

/// The scene at the chosen point of its sweep.
Scene scene_at_point(const LoadedScene& loaded, const std::string& wanted) {
  const std::uint32_t point = wanted.empty() ? 0 : chosen_points(study_of(loaded), wanted).front();
  std::vector<Fault> faults;
  Scene scene =
      scene_at(resolved(loaded.scene), sweep_points(loaded.scene.sweep).at(point), faults);
  if (total_taps(scene.protocol) == 0) {
    throw BadInput("/protocol: there is no tap whose relaxation could cost anything");
  }
  if (scene.observables.empty()) throw BadInput("/observe: there is nothing to be accurate in");
  if (std::holds_alternative<FullyPeriodicBox>(scene.container)) {
    throw BadInput("/container: a fluid without gravity does not relax, so nothing is incomplete");
  }
  return scene;
}

std::string observable_name(const Scene& scene, const std::string& wanted) {
  std::string found;
  std::vector<std::string> names;
  for (const Observable& observable : scene.observables) {
    const std::string name = label(observable).name;
    names.push_back(name);
    if (name == (wanted.empty() ? "bottom_fraction" : wanted)) found = name;
  }
  if (!found.empty()) return found;
  if (wanted.empty()) return label(scene.observables.front()).name;
  throw BadInput(fmt::format("--observable {}: the scene observes {}.{}", wanted,
                             joined(names, ", "), did_you_mean(wanted, names)));
}

std::unique_ptr<RunStore> open_store(const CostArguments& arguments, const LoadedScene& pilot,
                                     Study& study, const std::string& output,
                                     const Provenance& by) {
  const bool exists = std::filesystem::exists(output);
  if (!exists || (arguments.force && !arguments.resume)) {
    require_results_or_empty(output);
    return RunStore::create(output, study, Shard{}, by, arguments.force);
  }
  if (!arguments.resume) {
    throw BadInput(
        fmt::format("{} exists and is kept. Go on with it with --resume, write elsewhere with -o "
                    "FILE, or replace it with --force.",
                    output));
  }
  const ResultsFile file(output);
  const auto faults = resume_faults(stored_scene(file), Json::parse(pilot.resolved));
  if (!faults.empty()) {
    throw BadInput(
        fmt::format("{} holds the pilot of another scene:\n{}", output, fault_lines(faults)));
  }
  study.realizations = std::max(study.realizations, file.study().realizations);
  return RunStore::resume(output, study, Shard{}, by);
}

/// Nothing that is written may replace what is read, nor one another.
void require_outputs(const CostArguments& arguments, const LoadedScene& pilot,
                     const std::string& output) {
  std::vector<std::string> taken = pilot.files;
  require_replaceable(output, pilot.scene.name + ".h5");
  require_not_read("-o", output, taken);
  taken.push_back(output);
  require_text_output("--csv", arguments.csv, taken, arguments.force);
  if (!arguments.csv.empty()) taken.push_back(arguments.csv);
  require_text_output("--figure", arguments.figure, taken, arguments.force);
}

/// Runs whole rounds: one realization of every rung. The longest first, so that threads end
/// together.
class Rounds {
 public:
  Rounds(const CostArguments& arguments, const LoadedScene& pilot, const Study& study,
         RunStore& store, const std::string& output, std::size_t longest)
      : arguments_(arguments),
        pilot_(pilot),
        study_(study),
        store_(store),
        output_(output),
        longest_(longest),
        worked_before_(run_status(output).realizations) {}

  /// Whether they were completed, not stopped. None is added where all so far failed.
  bool run(int threads) {
    while (complete(threads)) {
      const std::uint32_t wanted =
          arguments_.rounds > 0 ? arguments_.rounds : affordable(study_.realizations);
      if (wanted <= study_.realizations || (failed_ > 0 && computed_ == 0)) return true;
      study_.realizations = wanted;
      store_.extend(wanted);
    }
    return false;
  }
  std::string stopped_by() const { return stop_.reason(); }

 private:
  std::uint32_t affordable(std::uint32_t done) const {
    const Seconds spent = std::chrono::steady_clock::now() - began_;
    return affordable_rounds(done, arguments_.budget, spent,
                             rounds_done(worked_before_, ResultsFile(output_).realizations()));
  }

  bool complete(int threads) {
    std::vector<RealizationId> pending = store_.pending();
    std::ranges::stable_sort(pending, [&](RealizationId a, RealizationId b) {
      return (a.point == longest_) > (b.point == longest_);
    });
    WorkAhead ahead{.realizations = pending.size() + progress_.realizations_done,
                    .taps = progress_.taps_done};
    for (const RealizationId& id : pending) ahead.taps += study_.points[id.point].taps;
    RunSummary summary;
    {
      const ProgressDisplay display(
          progress_, ahead, arguments_.no_progress ? ProgressStyle::none : ProgressStyle::plain);
      summary = run_ensemble(pilot_.plans, pending, {.threads = threads, .stop = &stop_.flag()},
                             store_, progress_);
    }
    store_.finish();
    computed_ += summary.done;
    failed_ += summary.failed;
    return summary.done + summary.failed == pending.size();
  }

  const CostArguments& arguments_;
  const LoadedScene& pilot_;
  Study study_;
  RunStore& store_;
  std::string output_;
  std::size_t longest_;
  std::vector<RealizationSummary> worked_before_;  // by earlier processes
  StopRequest stop_;
  Progress progress_;
  std::uint64_t computed_ = 0, failed_ = 0;  // realizations
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
};

void write_reports(const CostArguments& arguments, const CostStudy& study, const Scene& scene,
                   const std::string& output, const std::string& observable, const Provenance& by) {
  const auto cost = std::ranges::find_if(study.observables(), [&](const CostOfObservable& one) {
    return one.label.name == observable;
  });
  const std::optional<double> target =
      arguments.target > 0 ? std::optional(arguments.target) : std::nullopt;
  print(cost_text(study, *cost, scene.realizations, target));
  const std::vector<Table> tables = study.tables(scene.realizations);
  if (!arguments.csv.empty()) {
    std::string csv;
    for (const Table& table : tables) csv += table_csv(table);
    write_text(arguments.csv, csv);
  }
  if (!arguments.figure.empty()) {
    const std::string image =
        std::filesystem::path(arguments.figure).replace_extension(".svg").string();
    write_text(arguments.figure, cost_figure(study, *cost, scene.realizations, image));
    print(fmt::format("gnuplot {} draws {}\n", arguments.figure, image));
  }
  keep_tables(output, "analysis", tables, by);
}

int run_cost(const CostArguments& arguments) {
  outlive_readers();
  const LoadedScene loaded = load_scene(arguments.scene);
  const Scene scene = scene_at_point(loaded, arguments.point);
  const std::string observable = observable_name(scene, arguments.observable);
  const std::uint64_t taps = total_taps(scene.protocol);
  const std::vector<Rung> rungs = ladder(scene);
  Scene pilot_scene = ladder_scene(
      scene, rungs, std::min(taps, arguments.taps > 0 ? arguments.taps : default_taps));
  const LoadedScene pilot = load_derived(pilot_scene, arguments.scene);
  const int threads = arguments.threads > 0 ? arguments.threads : available_cpus();
  const Provenance by = provenance_of_this_run(fmt::to_string(threads));
  const std::string output = arguments.output.empty() ? pilot.scene.name + ".h5" : arguments.output;
  require_outputs(arguments, pilot, output);
  Study study = study_of(pilot);
  study.realizations = fewest_rounds;
  if (arguments.rounds > 0) study.realizations = std::min(study.realizations, arguments.rounds);
  try {
    auto store = open_store(arguments, pilot, study, output, by);
    Rounds rounds(arguments, pilot, study, *store, output, most_complete(rungs).last);
    if (!rounds.run(threads)) {
      print_to_standard_error(fmt::format("jostle: stopped by {}; --resume goes on with {}\n",
                                          rounds.stopped_by(), output));
      return exit_stopped;
    }
    store.reset();
    std::optional<CostStudy> found;
    found.emplace(ResultsFile(output), rungs, other_windows(scene), taps);
    write_reports(arguments, *found, scene, output, observable, by);
    if (!found->failed().empty()) return exit_failed_realizations;
  } catch (const BadInput&) {
    throw;
  } catch (const std::exception& error) {
    print_to_standard_error(
        fmt::format("jostle: {}\njostle: what was checkpointed is kept; once this is mended, "
                    "--resume goes on with {}\n",
                    failure_text(error), output));
    return exit_broken_surroundings;
  }
  return exit_ok;
}

void add_duration(CLI::App& command, CostArguments& arguments) {
  command.add_option_function<std::string>(
      "--budget",
      [&arguments](const std::string& text) {
        const auto duration = parse_duration(text);
        if (!duration) {
          throw CLI::ValidationError("--budget",
                                     fmt::format("\"{}\" is not a duration, as 10m", text));
        }
        arguments.budget = *duration;
      },
      "How long to run, in whole rounds, at least two (default: 10m)");
}

}  // namespace

void add_cost(CLI::App& app, int& code) {
  auto* command = app.add_subcommand("cost", "What a scene's accuracy costs in time");
  auto arguments = std::make_shared<CostArguments>();
  CostArguments& a = *arguments;
  command->add_option("scene", a.scene, "The scene, a JSON file")->required();
  command->add_option("--observable", a.observable,
                      "What is to be accurate (default: bottom_fraction, or the first observed)");
  command->add_option("--target", a.target, "Recommend the cheapest way to this total error")
      ->check(positive_number());
  add_duration(*command, a);
  command->add_option("--rounds", a.rounds, "Run so many rounds instead: the same give the same")
      ->check(CLI::Range(1, 1000000));
  command->add_option("--taps", a.taps, "Of the pilot (default: 10, or all of fewer)")
      ->check(CLI::Range(1, 1000000000));
  command->add_option("--sweep-point", a.point,
                      "Its number, or POINTER=VALUE of the sweep (default: the first)");
  command->add_option("--threads", a.threads, "Threads (default: the CPUs this process may use)")
      ->check(CLI::Range(1, 4096))
      ->envname("JOSTLE_THREADS");
  command->add_option("-o,--output", a.output, "The results (default: NAME-cost.h5)")
      ->check(file_to_write());
  command->add_flag("--resume", a.resume, "Go on with the output file");
  command->add_flag(
      "--force", a.force,
      "Replace existing output files; with --resume, only those of --csv and --figure");
  command->add_option("--csv", a.csv, "Also write the tables to this file")->check(file_to_write());
  command->add_option("--figure", a.figure, "Also write a gnuplot script to this file")
      ->check(file_to_write());
  command->add_flag("--no-progress", a.no_progress, "Print no progress")
      ->envname("JOSTLE_NO_PROGRESS");
  command->footer(
      "Example:\n"
      "  jostle cost scene.json --target 0.001 --observable bottom_fraction --budget 30m\n"
      "\n"
      "A ladder of settings is run for a few taps, in pairs from the same packings: stop rules,\n"
      "test intervals, step lengths, theta_0, half the spheres, the other pour between walls. "
      "docs/accuracy.md says how to read it.");
  command->callback([arguments, &code] { code = run_cost(*arguments); });
}

}  // namespace jostle
