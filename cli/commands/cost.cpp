#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "cli/commands/commands.hpp"
#include "cli/files/keep_tables.hpp"
#include "cli/files/output_file.hpp"
#include "cli/files/waiting.hpp"
#include "cli/reports/cost_report.hpp"
#include "cli/tables/durations.hpp"
#include "cli/tables/table_output.hpp"
#include "cli/terminal/failure.hpp"
#include "cli/terminal/run_display.hpp"
#include "cli/terminal/screen.hpp"
#include "cli/terminal/standard_streams.hpp"
#include "cli/terminal/stop_request.hpp"
#include "study/available_cpus.hpp"
#include "study/planning/cost_run.hpp"
#include "study/provenance.hpp"

namespace jostle::inline cli {
namespace {

constexpr std::uint64_t default_taps = 10;

struct CostArguments {
  std::string scene, output, observable, point, csv;
  double target = 0;
  Seconds budget{600};
  std::uint32_t replicates = 0;  // 0: as many as the budget allows
  std::uint64_t taps = 0;
  int threads = 0;
  bool resume = false, force = false, no_progress = false;
  Layout layout;
  Patience patience;
};

/// Nothing that is written may replace what is read, nor one another.
void require_outputs(const CostArguments& arguments, const LoadedScene& pilot,
                     const std::string& output) {
  std::vector<std::string> taken = pilot.files;
  require_replaceable(output, pilot.scene.name + ".h5");
  require_not_read("-o", output, taken);
  taken.push_back(output);
  require_text_output("--csv", arguments.csv, taken, arguments.force);
}

/// Returns whether the tables are stored.
bool write_reports(const CostArguments& arguments, const CostStudy& study, const Scene& scene,
                   const std::string& output, const std::string& observable,
                   const Provenance& provenance) {
  const auto cost =
      std::ranges::find_if(study.observables(), [&](const CostOfObservable& observable_cost) {
        return observable_cost.label.name == observable;
      });
  const std::optional<double> target =
      arguments.target > 0 ? std::optional(arguments.target) : std::nullopt;
  print_report(cost_text(study, *cost, scene.realizations, target, arguments.layout));
  const std::vector<Table> tables = study.tables(scene.realizations);
  if (!arguments.csv.empty()) {
    std::string csv;
    for (const Table& table : tables) csv += table_csv(table);
    write_text(arguments.csv, csv, existing_files(arguments.force));
  }
  return keep_tables(output, "analysis", tables, provenance, arguments.patience, {});
}

RunSettings settings_of(const CostArguments& arguments, const std::string& output, int threads,
                        const StopRequest& stop) {
  RunSettings settings{.output = output,
                       .take_over = arguments.force,
                       .patience = arguments.patience,
                       .threads = threads,
                       .stop = &stop.flag()};
  if (arguments.resume) {
    settings.existing = Existing::resume;
  } else if (arguments.force) {
    settings.existing = Existing::replace;
    require_results_or_empty(output);
  }
  return settings;
}

int run_cost(const CostArguments& arguments) {
  const LoadedScene loaded = load_scene(arguments.scene);
  CostPilot pilot = make_cost_pilot(loaded, arguments.scene, arguments.point,
                                    arguments.taps > 0 ? arguments.taps : default_taps);
  const std::string observable = cost_observable(pilot.scene, arguments.observable);
  const int threads = arguments.threads > 0 ? arguments.threads : available_cpus();
  const std::string output =
      arguments.output.empty() ? pilot.pilot.scene.name + ".h5" : arguments.output;
  require_outputs(arguments, pilot.pilot, output);
  try {
    const StopRequest stop;
    RunDisplay display(arguments.no_progress ? ProgressStyle::none : ProgressStyle::plain, "",
                       threads, false);
    if (arguments.replicates == 0) display.begin_budget(arguments.budget);
    CostRun run(pilot, {arguments.budget, arguments.replicates},
                settings_of(arguments, output, threads, stop), display);
    if (!run.run()) {
      print_to_standard_error(
          fmt::format("jostle: stopped by {}; --resume continues {}\n", stop.reason(), output));
      return exit_stopped;
    }
    const CostStudy found = run.study();
    if (!write_reports(arguments, found, pilot.scene, output, observable,
                       provenance_of_this_run(fmt::to_string(threads))))
      return exit_io_error;
    return found.failed().empty() ? exit_ok : exit_failed_realizations;
  } catch (const OtherScene& mismatch) {
    throw BadInput(fmt::format("{} holds the pilot of another scene:\n{}", mismatch.path(),
                               mismatch.differences()));
  } catch (const BadInput&) {
    throw;
  } catch (const std::exception& error) {
    print_to_standard_error(
        fmt::format("jostle: {}\njostle: what was checkpointed is kept; after fixing this, "
                    "--resume continues {}\n",
                    failure_text(error), output));
    return exit_io_error;
  }
}

Option add_duration(Command& command, CostArguments& arguments) {
  return command.add_reader(
      "--budget",
      [&arguments](const std::string& text) {
        const auto duration = parse_duration(text);
        if (!duration) throw BadValue(duration_fault(text));
        arguments.budget = *duration;
      },
      "Time to run, in whole replicates, at least two (default: 10m)");
}

}  // namespace

void add_cost(Command& app, int& code) {
  Command command = app.add_command("cost", "CPU time for a given accuracy of a scene");
  auto arguments = std::make_shared<CostArguments>();
  CostArguments& a = *arguments;
  command.add_option("scene", a.scene, "The scene, a JSON file").required().offers_files({"json"});
  command.add_option(
      "--observable", a.observable,
      "Observable whose accuracy counts (default: bottom_fraction, or the first observed)");
  command
      .add_option("--target", a.target, "Total error for which to recommend the cheapest settings")
      .positive_number();
  const Option budget = add_duration(command, a);
  const Option replicates =
      command
          .add_option("--replicates", a.replicates,
                      "Number of replicates to run, without --budget (reproducible)")
          .limit(1, 1000000);
  command.add_option("--taps", a.taps, "Taps of the pilot (default: 10, or all of fewer)")
      .limit(1, 1000000000);
  command.add_option("--sweep-point", a.point,
                     "Sweep point: its number, VALUE or NAME=VALUE (default: the first)");
  command.add_threads(a.threads);
  command.add_option("-o,--output", a.output, "The results (default: NAME-cost.h5)")
      .file_to_write()
      .offers_files({"h5"});
  command.add_flag("--resume", a.resume, "Continue the output file");
  command.add_flag(
      "--force", a.force,
      "Replace existing output files; with --resume, replace only that of --csv, and take "
      "over the lock of another host");
  command.add_option("--csv", a.csv, "File to which the tables are also written").file_to_write();
  add_wait(command, a.patience);
  add_wide(command, a.layout);
  command.add_flag("--no-progress", a.no_progress, "Print no progress")
      .environment("JOSTLE_NO_PROGRESS");
  command.footer(
      "Example:\n"
      "  jostle cost scene.json --target 0.001 --observable bulk_fraction --budget 30m\n"
      "\n"
      "A ladder of settings is run for a few taps, in pairs from the same packings.\n"
      "Monte Carlo: stop rules, test intervals, step lengths, theta_0, half the\n"
      "spheres, the other pour between walls. Discrete elements: rest, time step,\n"
      "stiffness, half the spheres. jostle report draws accuracy against time from\n"
      "the results; docs/explanation/accuracy.md describes it.");
  command.run([=, &code] {
    if (budget.count() > 0 && replicates.count() > 0) {
      throw BadInput(
          "--budget and --replicates exclude each other: a duration decides the number of "
          "replicates. Give one of them");
    }
    code = run_cost(*arguments);
  });
}

}  // namespace jostle::inline cli
