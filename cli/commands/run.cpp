#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <charconv>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <string>

#include "cli/commands/arguments.hpp"
#include "cli/commands/commands.hpp"
#include "cli/terminal/durations.hpp"
#include "cli/terminal/failure.hpp"
#include "cli/terminal/output_file.hpp"
#include "cli/terminal/progress_display.hpp"
#include "cli/terminal/report.hpp"
#include "cli/terminal/standard_streams.hpp"
#include "cli/terminal/stop_request.hpp"
#include "cli/terminal/text_table.hpp"
#include "ensemble/statistics/counted.hpp"
#include "results/export/printable.hpp"
#include "results/live_run.hpp"
#include "results/run_store.hpp"
#include "results/tables.hpp"
#include "study/available_cpus.hpp"
#include "study/enough.hpp"
#include "study/provenance.hpp"
#include "study/scene_file.hpp"
#include "study/scene_tables.hpp"
#include "study/scene_warnings.hpp"

namespace jostle {
namespace {

struct RunArguments {
  std::string scene, output;
  int threads = 0;  // 0: what the process may use
  bool resume = false, force = false, retry_failed = false;
  std::optional<Seconds> time_limit;
  Seconds checkpoint_every{60};
  Shard shard;
  bool quiet = false, no_progress = false;
};

Shard parse_shard(std::string_view text) {
  Shard shard{0, 0};
  const char* const end = text.data() + text.size();
  const auto index = std::from_chars(text.data(), end, shard.index);
  const bool slash = index.ptr != end && *index.ptr == '/';
  const auto count = slash ? std::from_chars(index.ptr + 1, end, shard.count) : index;
  if (!slash || count.ptr != end || index.ec != std::errc{} || count.ec != std::errc{} ||
      shard.index < 1 || shard.index > shard.count) {
    throw CLI::ValidationError(
        "--shard", fmt::format("\"{}\" is not a share i/n with 1 <= i <= n, as 1/4", text));
  }
  return shard;
}

Seconds duration_argument(const std::string& option, const std::string& text) {
  const auto duration = parse_duration(text);
  if (!duration) {
    throw CLI::ValidationError(
        option, fmt::format("\"{}\" is not a duration, as 90s, 30m, 2h or 1h30m", text));
  }
  return *duration;
}

/// What a resume would change, named; nothing else may differ from the file's scene.
void require_same_scene(const std::string& output, const LoadedScene& loaded, const Shard& shard) {
  const ResultsFile file(output);
  const auto faults = resume_faults(stored_scene(file), Json::parse(loaded.resolved));
  if (!faults.empty()) {
    throw BadInput(
        fmt::format("{} was begun with another scene and cannot be resumed with this one:\n{}\n"
                    "Undo the change, or write to another file with -o.",
                    output, fault_lines(faults)));
  }
  if (file.shard() != shard) {
    throw BadInput(fmt::format("{} holds shard {}/{}, not {}/{}: resume it with --shard {}/{}",
                               output, file.shard().index, file.shard().count, shard.index,
                               shard.count, file.shard().index, file.shard().count));
  }
}

/// What a run works on once its scene is read and its file opened.
struct OpenedRun {
  Study study;
  std::string output;
  std::unique_ptr<RunStore> store;
  std::uint64_t taps_recorded = 0;    // of pending realizations, by earlier processes
  std::vector<std::string> tables{};  // that the file had before
};

std::uint64_t recorded_taps(const std::string& output, const std::vector<RealizationId>& pending) {
  std::uint64_t taps = 0;
  for (const auto& one : run_status(output).realizations) {
    const bool counts = one.status == RealizationStatus::running &&
                        std::ranges::find(pending, one.id) != pending.end();
    if (counts && one.rows > 0) taps += one.rows - 1;  // row 0 is the start
  }
  return taps;
}

/// Where results go. A link is followed: what it names is replaced, not the link.
std::string output_path(const RunArguments& arguments, const LoadedScene& loaded) {
  const std::string output =
      arguments.output.empty() ? loaded.scene.name + ".h5" : arguments.output;
  require_replaceable(output, loaded.scene.name + ".h5");
  if (!std::filesystem::is_symlink(output)) return output;
  const std::filesystem::path link(output);
  return (link.parent_path() / std::filesystem::read_symlink(link)).string();
}

OpenedRun open_run(const RunArguments& arguments, const LoadedScene& loaded, int threads) {
  OpenedRun run{
      .study = study_of(loaded), .output = output_path(arguments, loaded), .store = nullptr};
  require_not_read("-o", run.output, loaded.files);
  const bool exists = std::filesystem::exists(run.output);
  const Provenance provenance = provenance_of_this_run(fmt::to_string(threads));
  if (exists && (arguments.resume || arguments.retry_failed)) {
    require_same_scene(run.output, loaded, arguments.shard);
    run.study.realizations =
        std::max(run.study.realizations, ResultsFile(run.output).study().realizations);
    run.tables = table_names(run.output);
    run.store =
        RunStore::resume(run.output, run.study, arguments.shard, provenance, arguments.force);
    run.taps_recorded = recorded_taps(run.output, run.store->pending(arguments.retry_failed));
    return run;
  }
  if (exists && !arguments.force) {
    throw BadInput(
        fmt::format("{} exists and is kept. Go on with it with --resume, write elsewhere with -o "
                    "FILE, or replace it with --force.",
                    run.output));
  }
  require_results_or_empty(run.output);
  run.store = RunStore::create(run.output, run.study, arguments.shard, provenance, arguments.force);
  return run;
}

WorkAhead work_ahead(const OpenedRun& run, const std::vector<RealizationId>& pending) {
  WorkAhead ahead{.realizations = pending.size()};
  for (const auto& id : pending) ahead.taps += run.study.points[id.point].taps;
  ahead.taps -= std::min(ahead.taps, run.taps_recorded);
  return ahead;
}

/// This command again, as it goes on after a stop.
std::string resume_command(const RunArguments& arguments) {
  auto words = command_line();
  std::erase(words, "--force");
  if (!arguments.resume) words.emplace_back("--resume");
  return shell_words(words);
}

/// What this process computed, all sweep points together.
std::string process_line(const Progress& progress, Seconds elapsed, int threads) {
  std::string line = fmt::format("this run: {} on {}", format_duration(elapsed),
                                 counted(static_cast<std::uint64_t>(threads), "thread"));
  const auto trials = static_cast<double>(progress.units_done);
  const auto relaxing = static_cast<double>(progress.relaxing_nanoseconds) * 1e-9;
  if (trials > 0 && relaxing > 0) {
    line += fmt::format("; relaxing, {} trials/s a core and {:.3f} distance tests a trial",
                        format_count(trials / relaxing),
                        static_cast<double>(progress.pair_tests) / trials);
  }
  return line + "\n";
}

ProgressStyle progress_style(const RunArguments& arguments) {
  if (arguments.quiet || arguments.no_progress) return ProgressStyle::none;
  return isatty(STDERR_FILENO) != 0 ? ProgressStyle::live : ProgressStyle::plain;
}

int exit_code_of(const ResultsFile& file) {
  for (const auto& one : file.realizations()) {
    if (one.status == RealizationStatus::failed) return exit_failed_realizations;
  }
  return exit_ok;
}

/// What a process does from opening its file to its last realization.
struct ProcessWork {
  explicit ProcessWork(StopRequest& request) : stop(request) {}

  StopRequest& stop;
  Progress progress;
  int rounds = 0;
  std::chrono::steady_clock::time_point began = std::chrono::steady_clock::now();
};

/// Runs what is pending and folds it into the file. Returns whether it was stopped before the end.
bool compute(const RunArguments& arguments, const LoadedScene& loaded, OpenedRun& run, int threads,
             ProcessWork& work) {
  // Those that failed are tried once, before others are added.
  const bool retry_failed = arguments.retry_failed && work.rounds++ == 0;
  const auto pending = run.store->pending(retry_failed);
  RunSummary summary;
  spdlog::info("{}: {} of {} to do on {}", printable(run.output), pending.size(),
               counted(loaded.plans.size() * run.study.realizations, "realization"),
               counted(static_cast<std::uint64_t>(threads), "thread"));
  {
    WorkAhead ahead = work_ahead(run, pending);
    ahead.realizations += work.progress.realizations_done;
    ahead.taps += work.progress.taps_done;
    const ProgressDisplay display(work.progress, ahead, progress_style(arguments));
    summary = run_ensemble(loaded.plans, pending,
                           {.threads = threads,
                            .checkpoint_every = arguments.checkpoint_every,
                            .stop = &work.stop.flag()},
                           *run.store, work.progress);
  }
  StoringDisplay storing(progress_style(arguments));
  run.store->finish([&](std::uint64_t done, std::uint64_t of) { storing.show(done, of); });
  return summary.done + summary.failed < pending.size();
}

/// Runs realizations, and more of them until the scene says that they are enough. Returns whether
/// it was stopped before the end.
bool compute_enough(const RunArguments& arguments, const LoadedScene& loaded, OpenedRun& run,
                    int threads, ProcessWork& work) {
  const Enough& until = loaded.scene.until;
  while (!compute(arguments, loaded, run, threads, work)) {
    if (until.targets.empty()) return false;
    const EnoughStatus status = enough_status(ResultsFile(run.output), until);
    if (!arguments.quiet) print(enough_line(status));
    if (status.next == status.realizations) return false;
    run.study.realizations = status.next;
    run.taps_recorded = 0;
    run.store->extend(status.next);
  }
  return true;
}

void print_results(const OpenedRun& run, const ProcessWork& work, int threads) {
  const ResultsFile file(run.output);
  const std::string text =
      report(file) +
      process_line(work.progress, std::chrono::steady_clock::now() - work.began, threads);
  print(text);
}

/// Derived tables do not outlive the data they were made of: names those that are gone.
void say_which_tables_are_gone(const OpenedRun& run) {
  std::vector<std::string> gone;
  std::ranges::set_difference(run.tables, table_names(run.output), std::back_inserter(gone));
  if (gone.empty()) return;
  std::string lines;
  for (const std::string& name : gone) lines.append("\n  ").append(name);
  print_to_standard_error(
      fmt::format("jostle: these tables were made of the data before this run, and are no longer "
                  "in {}; make them again where they are wanted:{}\n",
                  run.output, lines));
}

/// What a complete run ends with.
void make_tables(const RunArguments& arguments, const LoadedScene& loaded,
                 const std::string& output, int threads) {
  if (arguments.shard.count > 1) return;
  if (!loaded.scene.until.targets.empty()) {
    const Table table = enough_status(ResultsFile(output), loaded.scene.until).table;
    store_tables(output, "analysis", std::span(&table, 1),
                 provenance_of_this_run(fmt::to_string(threads)));
  }
  make_scene_tables(output, threads, arguments.quiet);
}

int run(const RunArguments& arguments) {
  StopRequest stop;  // from here on, signals stop and do not kill
  outlive_readers();
  if (arguments.quiet) spdlog::set_level(spdlog::level::warn);
  if (arguments.force && (arguments.resume || arguments.retry_failed)) {
    spdlog::info("--force with a resume takes over another host's lock, and replaces no file");
  }
  const LoadedScene loaded = load_scene(arguments.scene);
  if (!loaded.scene.until.targets.empty() && arguments.shard.count > 1) {
    throw BadInput(
        "--shard: this scene runs until its realizations are enough (\"until\"), which a share of "
        "them cannot tell. Run it whole, or take \"until\" out, run shares, merge them and resume "
        "the merged file with \"until\".");
  }
  const int threads = arguments.threads > 0 ? arguments.threads : available_cpus();
  OpenedRun run = open_run(arguments, loaded, threads);
  for (const std::string& warning : scene_warnings(loaded))
    spdlog::info("warning: {}", printable(warning));
  try {
    if (arguments.time_limit) stop.stop_after(*arguments.time_limit);
    ProcessWork work(stop);
    const bool stopped = compute_enough(arguments, loaded, run, threads, work);
    if (!arguments.quiet) print_results(run, work, threads);
    if (stopped) {
      say_which_tables_are_gone(run);
      print_to_standard_error(fmt::format("jostle: stopped by {}; go on with\n  {}\n",
                                          work.stop.reason(), resume_command(arguments)));
      return exit_stopped;
    }
    run.store.reset();  // gives the lock back
    make_tables(arguments, loaded, run.output, threads);
    say_which_tables_are_gone(run);
  } catch (const BadInput&) {
    throw;
  } catch (const std::exception& error) {
    print_to_standard_error(
        fmt::format("jostle: {}\njostle: what was checkpointed is kept; once this is mended, go on "
                    "with\n  {}\n",
                    failure_text(error), resume_command(arguments)));
    return exit_broken_surroundings;
  }
  const ResultsFile file(run.output);
  if (arguments.quiet) print_to_standard_error(failure_lines(file));
  return exit_code_of(file);
}

void add_options(CLI::App& command, RunArguments& arguments) {
  command.add_option("scene", arguments.scene, "The scene, a JSON file")->required();
  command
      .add_option("-o,--output", arguments.output,
                  "The results (default: the scene's name + .h5, here)")
      ->check(file_to_write());
  command
      .add_option("--threads", arguments.threads,
                  "Threads (default: the CPUs this process may use)")
      ->check(CLI::Range(1, 4096))
      ->envname("JOSTLE_THREADS");
  command.add_flag("--resume", arguments.resume,
                   "Go on with the output file, or begin it if there is none");
  command.add_flag("--force", arguments.force,
                   "Replace an existing output file; with --resume, take over another host's lock");
  command.add_flag("--retry-failed", arguments.retry_failed,
                   "Run failed realizations again (resumes)");
  command
      .add_option_function<std::string>(
          "--time-limit",
          [&arguments](const std::string& text) {
            arguments.time_limit = duration_argument("--time-limit", text);
          },
          "Stop after this long, as a signal would: 90s, 30m, 2h, 1h30m")
      ->envname("JOSTLE_TIME_LIMIT");
  command
      .add_option_function<std::string>(
          "--checkpoint-every",
          [&arguments](const std::string& text) {
            arguments.checkpoint_every = duration_argument("--checkpoint-every", text);
          },
          "What a kill may cost (default: 60s)")
      ->envname("JOSTLE_CHECKPOINT_EVERY");
  command
      .add_option_function<std::string>(
          "--shard", [&arguments](const std::string& text) { arguments.shard = parse_shard(text); },
          "Run share i/n of the realizations; jostle merge joins the files")
      ->envname("JOSTLE_SHARD");
  command.add_flag("--quiet", arguments.quiet, "Print errors only")->envname("JOSTLE_QUIET");
  command.add_flag("--no-progress", arguments.no_progress, "Print no progress")
      ->envname("JOSTLE_NO_PROGRESS");
}

}  // namespace

void add_run(CLI::App& app, int& code) {
  auto* command = app.add_subcommand("run", "Run a scene and write its results");
  auto arguments = std::make_shared<RunArguments>();
  add_options(*command, *arguments);
  command->footer(
      "Examples:\n"
      "  jostle run scene.json                              writes NAME.h5, prints its curves\n"
      "  jostle run scene.json --resume --time-limit 23h    the same line for every job of a "
      "chain\n"
      "  jostle run scene.json --shard 3/8 -o part3.h5      one eighth of the realizations\n"
      "\n"
      "SIGINT, SIGTERM, SIGUSR1 and the time limit stop at the end of a sweep: all is stored, the\n"
      "command that goes on is printed, and the exit code is 75.");
  command->callback([arguments, &code] { code = run(*arguments); });
}

}  // namespace jostle
