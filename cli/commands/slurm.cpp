#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/commands/commands.hpp"
#include "cli/files/keep_tables.hpp"
#include "cli/files/output_file.hpp"
#include "cli/options/command_words.hpp"
#include "cli/reports/batch_script.hpp"
#include "cli/tables/durations.hpp"
#include "cli/terminal/standard_streams.hpp"
#include "ensemble/statistics/counted.hpp"
#include "ensemble/statistics/finite_text.hpp"
#include "results/disk/output_path.hpp"
#include "results/disk/printable.hpp"
#include "results/locks/slurm_job.hpp"
#include "study/planning/job_plan.hpp"
#include "study/planning/scene_pilot.hpp"
#include "study/provenance.hpp"

namespace jostle::inline cli {
namespace {

namespace fs = std::filesystem;

constexpr int most_cpus =
    65535;  // most cpus of a job, which has one node: Slurm counts those in 16 bits

struct SlurmArguments {
  std::string scene, output, folder;
  double hours = 0;
  std::uint32_t cpus = 0, jobs = 0;
  std::uint32_t most_tasks = 0;  // 0: ask Slurm
  bool force = false;
};

/// Checks a text of the script: it must be one line that shows what it holds.
std::string one_line(const std::string& text, const char* option_name) {
  const std::string shown = printable_name(text);
  if (shown != text)
    throw BadInput(
        fmt::format("{} \"{}\" has a character that a line of a script cannot contain or "
                    "show: choose another name",
                    option_name, shown));
  return text;
}

/// A folder's name by which a link to the folder is seen as one.
std::string without_last_slashes(std::string folder) {
  while (folder.size() > 1 && folder.ends_with('/')) folder.pop_back();
  return folder;
}

/// Slurm counts whole minutes.
Seconds time_limit(const SlurmArguments& arguments) {
  constexpr double most_hours = 87600;  // ten years, which Slurm's minutes can count
  if (arguments.hours > most_hours)
    throw BadInput(finite_text("--hours {:.4g}: a time limit has at most {:.0f} hours, ten years",
                               arguments.hours, most_hours));
  return Seconds(60 * std::max(1.0, std::ceil(arguments.hours * 60 - 1e-6)));
}

SceneCost cost_of(const LoadedScene& loaded, const ScenePilot& pilot) {
  SceneCost cost{.realization = {},
                 .realizations = loaded.scene.realizations,
                 .start = pilot.start(),
                 .bytes_on_disk = disk_estimate(study_of(loaded), Shard{})};
  for (std::size_t point = 0; point < loaded.plans.size(); ++point)
    cost.realization.push_back(pilot.realization(point));
  return cost;
}

/// Half as much again as the estimate, in pieces of 64 MiB.
std::uint64_t megabytes_to_ask_for(double bytes) {
  constexpr double margin = 1.5, piece = 64, least = 512;
  const double wanted = std::max(least, margin * bytes / (1 << 20));
  return static_cast<std::uint64_t>(std::ceil(wanted / piece) * piece);
}

/// "about 3.2 core-hours (2.9 to 3.5)": pilots of one scene differ by a tenth on an idle machine.
std::string core_hours(const JobPlan& plan, const ScenePilot& pilot) {
  constexpr double least_scatter = 0.1;
  const double hours = plan.core_time.count() / 3600;
  if (!pilot.settled()) return finite_text("at least {:.3g} core-hours", hours);
  const double part = std::min(0.9, std::max(least_scatter, pilot.scatter()));
  return finite_text("about {:.3g} core-hours ({:.2g} to {:.2g})", hours, hours * (1 - part),
                     hours * (1 + part));
}

/// "the longest task needs about 49 min, limit 30 min: 2 submissions".
std::string estimate_line(const JobPlan& plan, const SlurmArguments& arguments,
                          const ScenePilot& pilot) {
  return finite_text(
      "{}, {} on {} each: {}, efficiency {:.0f} %; the longest task needs {} {}, limit {}: {}",
      counted(plan.tasks, "task"), counted(plan.shards, "shard"), counted(arguments.cpus, "CPU"),
      core_hours(plan, pilot), 100 * plan.efficiency, pilot.settled() ? "about" : "at least",
      format_duration(plan.longest_task), format_duration(time_limit(arguments)),
      counted(plan.starts, "submission"));
}

/// "efficiency 58 %: --cpus 3 --jobs 4 take 40 min with 92 %".
std::string layout_hint(const SceneCost& cost, const JobRequest& request, const JobPlan& plan) {
  const std::optional<JobRequest> better = better_layout(cost, request);
  if (!better) return "";
  const JobPlan better_plan = plan_jobs(cost, *better);
  return finite_text(
      "CPUs have nothing to do for {:.0f} % of the reserved time. With --cpus {} --jobs {} the "
      "efficiency is {:.0f} %, and the longest task needs {}",
      100 * (1 - plan.efficiency), better->cpus, better->shards, 100 * better_plan.efficiency,
      format_duration(better_plan.longest_task));
}

std::vector<std::string> warnings_of(const JobPlan& plan, const SlurmArguments& arguments,
                                     const SceneCost& cost, const ScenePilot& pilot) {
  std::vector<std::string> warnings;
  if (pilot.scatter() > ScenePilot::busy) {
    warnings.push_back(
        finite_text("the machine is busy: two pilots of the same work differ by {:.0f} % of their "
                    "time. Repeat the estimate on an idle machine",
                    100 * pilot.scatter()));
  }
  if (plan.starts > 1) {
    warnings.push_back(fmt::format(
        "the longest task needs {}: the script requeues itself. Increase --jobs or --hours "
        "for fewer submissions",
        counted(plan.starts, "submission")));
  }
  if (plan.most_realizations < arguments.cpus) {
    warnings.push_back(fmt::format(
        "a job has at most {}, one CPU each: {} of its {} CPUs have nothing to do. Use --cpus {}, "
        "or fewer --jobs",
        counted(plan.most_realizations, "realization"), arguments.cpus - plan.most_realizations,
        arguments.cpus, plan.most_realizations));
  }
  const std::size_t points = cost.realization.size();
  constexpr std::uint64_t large = 1 << 30;
  if (cost.bytes_on_disk > large && plan.shards % points != 0 && points % plan.shards != 0) {
    warnings.push_back(fmt::format(
        "every shard has some realizations of all {} sweep points, which makes files and merges "
        "larger. Use a multiple or a divisor of {} as --jobs, so that shards have whole points",
        points, points));
  }
  return warnings;
}

BatchScript script_for(const SlurmArguments& arguments, const LoadedScene& loaded,
                       const JobPlan& plan, const ScenePilot& pilot) {
  const std::string& name = loaded.scene.name;
  return {.name = name,
          .scene = one_line(arguments.scene, "the scene"),
          .results = one_line(
              arguments.folder.empty() ? name + ".shards" : without_last_slashes(arguments.folder),
              "--folder"),
          .folder = one_line(fs::current_path().string(), "the folder"),
          .program = one_line(program_path().string(), "the program"),
          .made_by = shell_words(command_line()),
          .cpus = arguments.cpus,
          .time_limit = time_limit(arguments),
          .megabytes = megabytes_to_ask_for(
              pilot.bytes(std::min<std::uint64_t>(arguments.cpus, plan.most_realizations))),
          .estimate = estimate_line(plan, arguments, pilot)};
}

void say(const std::string& text) {
  print_to_standard_error(fmt::format("jostle: {}\n", text));
}

void write_script(const SlurmArguments& arguments) {
  time_limit(arguments);  // refused before the pilot runs
  const LoadedScene loaded = load_scene(arguments.scene);
  require_text_output("-o", arguments.output, loaded.files, arguments.force);
  if (arguments.jobs > 1 && !loaded.scene.until.targets.empty()) {
    throw BadInput(
        "this scene runs until a target precision is reached (\"until\"), which a shard, with "
        "a part of the realizations, cannot decide: use --jobs 1, or remove \"until\"");
  }
  constexpr std::uint32_t usual_array = 1001;  // MaxArraySize of Slurm, one more than the last task
  const std::uint64_t largest = arguments.most_tasks > 0
                                    ? arguments.most_tasks
                                    : slurm_max_array_size().value_or(usual_array) - 1;
  const ScenePilot pilot(loaded, {}, ScenePilot::Repeat::first_point);
  const SceneCost cost = cost_of(loaded, pilot);
  const JobRequest request{
      .time_limit = time_limit(arguments),
      .cpus = arguments.cpus,
      .shards = arguments.jobs,
      .most_tasks = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(largest, 1, 1u << 20))};
  const JobPlan plan = plan_jobs(cost, request);
  const BatchScript script = script_for(arguments, loaded, plan, pilot);
  output_path(script.results + "/1.h5");  // refuses links of others
  const std::string text = slurm_script(script, plan);
  if (arguments.output.empty()) {
    print_exactly(text);
  } else {
    write_text(arguments.output, text, existing_files(arguments.force));
  }
  say(script.estimate);
  for (const std::string& warning : warnings_of(plan, arguments, cost, pilot))
    say("warning: " + warning);
  if (const std::string hint = layout_hint(cost, request, plan); !hint.empty()) say(hint);
  const std::string file = arguments.output.empty() ? script.name + ".sbatch" : arguments.output;
  say(fmt::format("next{}:\n  {}\n  {}\n  {}",
                  arguments.output.empty() ? ", with the script in " + file : "",
                  shell_words({"sbatch", operand(file)}),
                  shell_words({command_line().front(), "status", operand(script.results)}),
                  shell_words({command_line().front(), "merge", operand(script.results), "-o",
                               script.name + ".h5"})));
}

}  // namespace

void add_slurm(Command& app, int& code) {
  Command command =
      app.add_command("slurm", "Print a batch script that runs a scene as a Slurm job array");
  auto arguments = std::make_shared<SlurmArguments>();
  command.add_option("scene", arguments->scene, "The scene, a JSON file")
      .required()
      .offers_files({"json"});
  command.add_option("--hours", arguments->hours, "Time limit of a job")
      .required()
      .positive_number();
  command.add_option("--cpus", arguments->cpus, "CPUs of a job: realizations at once")
      .required()
      .limit(1, most_cpus);
  command.add_option("--jobs", arguments->jobs, "Shards, each a job and a results file")
      .required()
      .whole_from(1);
  command.add_option("--folder", arguments->folder,
                     "Folder of the shards' files (default: the scene's name + .shards)");
  command
      .add_option("--array-limit", arguments->most_tasks,
                  "Tasks that an array may have (default: asks Slurm, else 1000); more shards run "
                  "one after another in a task")
      .whole_from(1);
  command.add_option("-o,--output", arguments->output, "Write the script there, not on the screen")
      .file_to_write();
  command.add_flag("--force", arguments->force, "Replace the script if it exists");
  command.footer(
      "Examples:\n"
      "  jostle slurm scene.json --hours 12 --cpus 4 --jobs 2 > scene.sbatch\n"
      "  jostle slurm scene.json --hours 0.5 --cpus 1 --jobs 4 -o quick.sbatch\n"
      "\n"
      "Time and memory come from the pilot of jostle check, which takes up to about twenty\n"
      "seconds, with grains up to two minutes. A job receives a signal before its time limit,\n"
      "stops, goes back into the queue and continues there.");
  command.run([arguments, &code] {
    write_script(*arguments);
    code = exit_ok;
  });
}

}  // namespace jostle::inline cli
