#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/commands/commands.hpp"
#include "cli/files/output_file.hpp"
#include "cli/files/waiting.hpp"
#include "cli/first_run/beyond_first_run.hpp"
#include "cli/options/command_words.hpp"
#include "cli/reports/next_commands.hpp"
#include "cli/reports/report.hpp"
#include "cli/tables/durations.hpp"
#include "cli/tables/scene_tables.hpp"
#include "cli/tables/wrapped.hpp"
#include "cli/terminal/failure.hpp"
#include "cli/terminal/log.hpp"
#include "cli/terminal/run_display.hpp"
#include "cli/terminal/screen.hpp"
#include "cli/terminal/standard_streams.hpp"
#include "cli/terminal/stop_request.hpp"
#include "config/json/json_text.hpp"
#include "ensemble/statistics/counted.hpp"
#include "ensemble/statistics/finite_text.hpp"
#include "results/checkpoints/part.hpp"
#include "results/disk/output_path.hpp"
#include "study/amounts.hpp"
#include "study/available_cpus.hpp"
#include "study/number_text.hpp"
#include "study/provenance.hpp"
#include "study/running/run.hpp"
#include "study/running/scene_warnings.hpp"
#include "study/running/stored_scene.hpp"

namespace jostle::inline cli {
namespace {

struct RunArguments {
  std::string scene, output;
  int threads = 0;  // 0: what the process may use
  bool resume = false, force = false, retry_failed = false;
  std::optional<Seconds> time_limit;
  Seconds checkpoint_every{60};
  Shard shard;
  Patience patience;
  bool quiet = false, no_progress = false, verbose = false;
  Layout layout;
};

Shard parse_shard(std::string_view text) {
  const std::size_t slash = text.find('/');
  const auto index = read_whole_number(text.substr(0, slash));
  const auto count = slash < text.size() ? read_whole_number(text.substr(slash + 1)) : std::nullopt;
  if (!index || !count || *index < 1 || *index > *count || *count > most_realizations) {
    throw BadValue(fmt::format("\"{}\" is not a share i/n with 1 <= i <= n <= {}, as 1/4", text,
                               most_realizations));
  }
  return {static_cast<std::uint32_t>(*index), static_cast<std::uint32_t>(*count)};
}

Seconds duration_argument(const std::string& text) {
  const auto duration = parse_duration(text);
  if (!duration) throw BadValue(duration_fault(text));
  return *duration;
}

/// Where results go. A link is followed: what it names is replaced, not the link.
std::string results_path(const RunArguments& arguments, const LoadedScene& loaded) {
  const std::string output =
      arguments.output.empty() ? loaded.scene.name + ".h5" : arguments.output;
  require_replaceable(output, loaded.scene.name + ".h5");
  return output_path(output);
}

RunSettings settings_of(const RunArguments& arguments, const LoadedScene& loaded, int threads) {
  RunSettings settings{.output = results_path(arguments, loaded),
                       .take_over = arguments.force,
                       .patience = arguments.patience,
                       .retry_failed = arguments.retry_failed,
                       .shard = arguments.shard,
                       .threads = threads,
                       .checkpoint_every = arguments.checkpoint_every};
  if (arguments.time_limit) settings.room = RunStore::Room::for_a_part;
  require_not_read("-o", settings.output, loaded.files);
  if (arguments.resume || arguments.retry_failed) {
    settings.existing = Existing::resume;
  } else if (arguments.force) {
    settings.existing = Existing::replace;
    require_results_or_empty(settings.output);
  }
  return settings;
}

/// This command, as it resumes after a stop.
std::string resume_command(const RunArguments& arguments) {
  auto words = command_line();
  remove_flag(words, "--force");
  if (!arguments.resume) add_flag(words, "--resume");
  return shell_words(words);
}

/// The work of this process, all sweep points together; `unit` is empty of several engines, whose
/// rates do not add up.
std::string process_line(const Progress& progress, Seconds elapsed, int threads,
                         const std::string& unit) {
  std::string line = fmt::format("this run: {} on {}", format_duration(elapsed),
                                 counted(static_cast<std::uint64_t>(threads), "thread"));
  const auto units = static_cast<double>(progress.units_done);
  const auto relaxing = static_cast<double>(progress.relaxing_nanoseconds) * 1e-9;
  if (!unit.empty() && units > 0 && relaxing > 0) {
    line += finite_text("; relaxing, {} {}/s per core and {:.3f} distance tests {}",
                        format_count(units / relaxing), unit,
                        static_cast<double>(progress.pair_tests) / units,
                        unit == "trials" ? "per trial" : "for each");
  }
  return line + "\n";
}

ProgressStyle progress_style(const RunArguments& arguments) {
  if (arguments.quiet || arguments.no_progress) return ProgressStyle::none;
  return isatty(STDERR_FILENO) != 0 ? ProgressStyle::live : ProgressStyle::plain;
}

/// Derived tables do not outlive the data they were made of: names those that are gone.
void say_which_tables_are_gone(const std::vector<std::string>& tables_before,
                               std::vector<std::string> tables_after, const std::string& output) {
  std::ranges::sort(tables_after);
  std::vector<std::string> gone;
  std::ranges::set_difference(tables_before, tables_after, std::back_inserter(gone));
  if (gone.empty()) return;
  std::string lines;
  for (const std::string& name : gone) lines.append("\n  ").append(name);
  print_to_standard_error(
      fmt::format("jostle: tables of fewer data were removed from {}; "
                  "compute those that you need again:{}\n",
                  output, lines));
}

/// The curve that was computed, and the commands that go on from it.
void print_end(const ResultsFile& file, const RunSettings& settings) {
  print_curves(file);
  if (settings.shard.count > 1) return;  // jostle merge knows the other shards' files
  const auto realizations = file.realizations();
  if (std::ranges::none_of(realizations, [](const RealizationSummary& realization) {
        return realization.status == RealizationStatus::done;
      })) {
    return;  // nothing to go on from
  }
  std::string text = "\nnext:\n";
  for (std::vector<std::string> words :
       next_commands(file.study(), stored_scene(file), settings.output)) {
    words.insert(words.begin(), command_line().front());
    text += fmt::format("  {}\n", shell_words(words));
  }
  print(text);
}

/// From the first realization to the last table. Returns the exit code.
int run_to_end(const RunArguments& arguments, SceneRun& run, const RunSettings& settings,
               const StopRequest& stop, SceneTablesMaker* make_tables) {
  const auto began = std::chrono::steady_clock::now();
  const bool stopped = !run.compute_until_precise();
  if (!arguments.quiet) {
    print_report((run.left_in_parts() ? "" : report(run.results(), arguments.layout)) +
                 wrapped(process_line(run.progress(), std::chrono::steady_clock::now() - began,
                                      settings.threads, common_unit(run.results().study())),
                         arguments.layout.width));
  }
  if (run.left_in_parts()) {
    print_to_standard_error(
        fmt::format("jostle: what was computed is in {}, not in {} itself: "
                    "to fold it in takes longer than a stop should, and is done "
                    "at the end of the run; jostle info shows it, and the "
                    "other commands read it with --live\n",
                    parts_folder(settings.output), settings.output));
  }
  if (stopped) {
    say_which_tables_are_gone(run.tables_before(), run.results().table_names(), settings.output);
    print_to_standard_error(
        fmt::format("jostle: stopped by {}; resume with{}\n  {}\n", stop.reason(),
                    arguments.time_limit ? " (omit --time-limit to reach the end)" : "",
                    resume_command(arguments)));
    return exit_stopped;
  }
  const std::vector<std::string> tables_before = run.tables_before();
  const ResultsFile file = run.close();
  std::vector<std::string> tables = file.table_names();
  if (settings.shard.count == 1 && make_tables != nullptr) {
    const auto stored =
        make_tables(file, {.threads = settings.threads,
                           .patience = settings.patience,
                           .quiet = arguments.quiet ? Quiet::yes : Quiet::no,
                           .layout = arguments.layout,
                           .detail = arguments.verbose ? TableDetail::full : TableDetail::summary});
    tables.insert(tables.end(), stored.begin(), stored.end());
  }
  say_which_tables_are_gone(tables_before, tables, settings.output);
  if (!arguments.quiet) print_end(file, settings);
  const std::string failures = failure_lines(file);
  if (arguments.quiet) print_to_standard_error(failures);
  return failures.empty() ? exit_ok : exit_failed_realizations;
}

/// The program of a first run refuses scenes that need more than it has.
void require_first_run(const LoadedScene& loaded) {
  const std::vector<std::string> needs = beyond_first_run(loaded);
  if (needs.empty()) return;
  throw BadInput(
      fmt::format("the scene needs {}, which this program does not have: run it with jostle",
                  joined(needs, ", ")));
}

int run(const RunArguments& arguments, SceneTablesMaker* make_tables) {
  StopRequest stop;  // from here on, signals stop and do not kill
  if (arguments.quiet) silence_log();
  if (arguments.force && (arguments.resume || arguments.retry_failed)) {
    log_line("--force with a resume takes over another host's lock, and replaces no file");
  }
  const LoadedScene loaded = load_scene(arguments.scene);
  if (make_tables == nullptr) require_first_run(loaded);
  const int threads = arguments.threads > 0 ? arguments.threads : available_cpus();
  RunSettings settings = settings_of(arguments, loaded, threads);
  settings.stop = &stop.flag();
  RunDisplay display(progress_style(arguments), settings.output, threads, !arguments.quiet);
  SceneRun run(loaded, settings, display);
  std::vector<std::string> warnings = scene_warnings(loaded);
  if (const std::string lock = run.lock_warning(); !lock.empty()) warnings.push_back(lock);
  for (const std::string& warning : warnings) log_line(fmt::format("warning: {}", warning));
  try {
    std::vector<std::string> read = loaded.files;
    if (settings.existing == Existing::resume) read.push_back(settings.output);
    warn_of_lost_seals(read);
    if (arguments.time_limit) stop.stop_after(*arguments.time_limit);
    return run_to_end(arguments, run, settings, stop, make_tables);
  } catch (const BadInput&) {
    throw;
  } catch (const std::exception& error) {
    print_to_standard_error(
        fmt::format("jostle: {}\njostle: what was checkpointed is kept; after fixing this, resume "
                    "with\n  {}\n",
                    failure_text(error), resume_command(arguments)));
    return exit_io_error;
  }
}

void add_options(Command& command, RunArguments& arguments) {
  command.add_option("scene", arguments.scene, "The scene, a JSON file")
      .required()
      .offers_files({"json"});
  command
      .add_option("-o,--output", arguments.output,
                  "The results (default: the scene's name + .h5, in the current folder)")
      .file_to_write()
      .offers_files({"h5"});
  command.add_threads(arguments.threads);
  command.add_flag("--resume", arguments.resume,
                   "Continue the output file, or begin it if there is none");
  command.add_flag("--force", arguments.force,
                   "Replace an existing output file; with --resume, take over another host's lock");
  command.add_flag("--retry-failed", arguments.retry_failed,
                   "Run failed realizations again (resumes)");
  command
      .add_reader(
          "--time-limit",
          [&arguments](const std::string& text) { arguments.time_limit = duration_argument(text); },
          "Time after which the run stops as at a signal: 90s, 30m, 2h, 1h30m")
      .environment("JOSTLE_TIME_LIMIT");
  command
      .add_reader(
          "--checkpoint-every",
          [&arguments](const std::string& text) {
            arguments.checkpoint_every = duration_argument(text);
          },
          "Interval between checkpoints (default: 60s)")
      .environment("JOSTLE_CHECKPOINT_EVERY");
  command
      .add_reader(
          "--shard", [&arguments](const std::string& text) { arguments.shard = parse_shard(text); },
          "Share i/n of the realizations to run; jostle merge joins the files")
      .environment("JOSTLE_SHARD");
  add_wait(command, arguments.patience);
  add_wide(command, arguments.layout);
  command.add_flag("--verbose", arguments.verbose,
                   "Full reports of the fits, analyses and structure of the scene (default: their "
                   "results)");
  command.add_flag("--quiet", arguments.quiet, "Print errors only").environment("JOSTLE_QUIET");
  command.add_flag("--no-progress", arguments.no_progress, "Print no progress")
      .environment("JOSTLE_NO_PROGRESS");
}

}  // namespace

void add_run(Command& app, int& code, SceneTablesMaker* make_tables) {
  Command command = app.add_command("run", "Run a scene and write its results");
  auto arguments = std::make_shared<RunArguments>();
  add_options(command, *arguments);
  command.footer(
      "Examples:\n"
      "  jostle run scene.json                    writes NAME.h5, prints its curves\n"
      "  jostle run scene.json --resume --time-limit 23h    for every job of a chain\n"
      "  jostle run scene.json --shard 3/8 -o part3.h5      one eighth of it\n"
      "\n"
      "SIGINT, SIGTERM, SIGUSR1 and the time limit stop at the end of a sweep: all is stored, the\n"
      "command that continues is printed, and the exit code is 75.");
  command.run([arguments, make_tables, &code] { code = run(*arguments, make_tables); });
}

void add_run_requests(Command& requests, int& code) {
  Command command = requests.add_command("run", "Print what a run needs beyond a first run");
  auto arguments = std::make_shared<RunArguments>();
  add_options(command, *arguments);
  command.run([arguments, &code] {
    code = print_requests(beyond_first_run(load_scene(arguments->scene)));
  });
}

}  // namespace jostle::inline cli
