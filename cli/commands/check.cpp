#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "cli/commands/commands.hpp"
#include "cli/first_run/beyond_first_run.hpp"
#include "cli/reports/effects.hpp"
#include "cli/tables/durations.hpp"
#include "cli/tables/text_table.hpp"
#include "cli/tables/wrapped.hpp"
#include "cli/terminal/screen.hpp"
#include "cli/terminal/standard_streams.hpp"
#include "config/json/json_text.hpp"
#include "ensemble/statistics/counted.hpp"
#include "ensemble/statistics/finite_text.hpp"
#include "study/amounts.hpp"
#include "study/available_cpus.hpp"
#include "study/planning/scene_pilot.hpp"
#include "study/running/grain_summary.hpp"
#include "study/running/scene_file.hpp"
#include "study/running/scene_warnings.hpp"

namespace jostle::inline cli {
namespace {

struct CheckArguments {
  std::string scene;
  int threads = 0;  // 0: what the process may use
  bool no_pilot = false;
};

void print_size(const LoadedScene& loaded, const Study& study) {
  std::uint64_t taps = 0;
  for (const auto& point : study.points) taps += point.taps * study.realizations;
  print_wrapped(fmt::format("size\n  {} x {}, {}, {} in all\n",
                            counted(study.points.size(), "sweep point"),
                            counted(study.realizations, "realization"),
                            counted(loaded.scene.n_spheres, "sphere"), counted(taps, "tap")));
  constexpr std::size_t most_labels = 1000;
  std::string labels;
  for (const auto& point :
       std::span(study.points).first(std::min(study.points.size(), most_labels))) {
    if (!point.label.empty()) labels += fmt::format("    {}\n", point.label);
  }
  if (!labels.empty()) labels = "  sweep points\n" + labels;
  if (study.points.size() > most_labels) {
    labels += fmt::format("    ... and {} more\n", study.points.size() - most_labels);
  }
  print_wrapped(labels);
  if (!loaded.scene.until.targets.empty()) {
    print_wrapped(fmt::format(
        "  at first: realizations are added until the target precision is reached, at most {}\n",
        loaded.scene.until.at_most));
  }
  print_wrapped(
      fmt::format("  disk: at most {}, for the results file and the files of the run together\n",
                  format_bytes(static_cast<double>(disk_estimate(study, Shard{})))));
}

void print_pilot_line(const Plan& plan, const PilotEstimate& estimate) {
  std::string pilot = counted(plan.n_spheres, "sphere");
  if (estimate.n_spheres < plan.n_spheres) {
    pilot = fmt::format("{} of {}", estimate.n_spheres, pilot);
  }
  if (estimate.n_strengths > 1) {
    pilot += fmt::format(", taps of {} strengths", estimate.n_strengths);
  }
  const char* const qualifier = estimate.settled ? "about" : "at least";
  const std::string a_tap = total_taps(plan) == 0
                                ? ""
                                : finite_text("{} {:.0f} {} per tap, ", qualifier,
                                              estimate.rounds_per_tap, round_name(plan.engine));
  print_wrapped(fmt::format(
      "  {}{}pilot of {}: {} {} at {} {}/s; the scene: {}{} {} per realization\n", plan.label,
      plan.label.empty() ? "" : ": ", pilot, format_count(static_cast<double>(estimate.units)),
      unit_name(plan.engine), format_count(estimate.units_per_second), unit_name(plan.engine),
      a_tap, qualifier, format_duration(estimate.realization)));
}

/// Derived numbers of the grains' settings, at the first sweep points that differ in them.
void print_grains(const LoadedScene& loaded) {
  constexpr std::size_t most = 5;
  std::set<std::string> known;
  std::string text;
  for (const Plan& plan : loaded.plans) {
    const std::vector<std::string> lines = grain_summary(plan);
    if (lines.empty() || known.size() == most) continue;
    const std::string block = joined(lines, "\n  ");
    if (!known.insert(block).second) continue;
    text += fmt::format("  {}{}{}\n", plan.label, plan.label.empty() ? "" : "\n  ", block);
  }
  if (!text.empty()) print_wrapped("discrete elements\n" + text);
}

/// "18 s of core time", "3.2 core-hours".
std::string core_time(Seconds seconds) {
  return seconds < Seconds(60) ? format_duration(seconds) + " of core time"
                               : finite_text("{:.3g} core-hours", seconds.count() / 3600);
}

void print_pilot(const LoadedScene& loaded, int cpus) {
  print("cost, extrapolated from the first taps of a pilot\n");
  const ScenePilot pilot(loaded, print_pilot_line);
  const std::size_t realizations = loaded.plans.size() * loaded.scene.realizations;
  const std::size_t threads = std::min(static_cast<std::size_t>(cpus), realizations);
  const std::size_t turns = (realizations + threads - 1) / threads;
  const Seconds mean = pilot.mean_realization();
  print_wrapped(finite_text("  time: {} {} on {}, {}\n", pilot.settled() ? "about" : "at least",
                            format_duration(mean * static_cast<double>(turns)),
                            counted(threads, "thread"),
                            core_time(mean * static_cast<double>(realizations))));
  print_wrapped(fmt::format("  memory: about {}\n", format_bytes(pilot.bytes(threads))));
}

/// With its description a line at a time, which a scene may have.
void print_scene(const std::string& resolved) {
  constexpr std::size_t around_a_line = 8;  // its indent, quotes and comma
  Json scene = Json::parse(resolved);
  const std::size_t width = screen().width - around_a_line;
  if (scene.contains("description") && scene.at("description").text().size() > width) {
    const std::string lines = wrapped(scene.at("description").text(), width);
    Json description = Json::array();
    for (std::size_t start = 0; start < lines.size();) {
      const std::size_t end = std::min(lines.find('\n', start), lines.size());
      const std::size_t begin = std::min(lines.find_first_not_of(' ', start), end);  // no indent
      description.push_back(lines.substr(begin, end - begin));
      start = end + 1;
    }
    scene["description"] = description;
  }
  print(scene.dump(2) + "\n\n");
}

void check(const CheckArguments& arguments) {
  const LoadedScene loaded = load_scene(arguments.scene);
  print_scene(loaded.resolved);
  print_wrapped(effects_text(Json::parse(loaded.resolved)));
  print_grains(loaded);
  print_size(loaded, study_of(loaded));
  const std::vector<std::string> warnings = scene_warnings(loaded);
  if (!warnings.empty()) print_wrapped(fmt::format("warnings\n  {}\n", joined(warnings, "\n  ")));
  if (arguments.no_pilot) return;
  print_pilot(loaded, arguments.threads > 0 ? arguments.threads : available_cpus());
}

void add_options(Command& command, CheckArguments& arguments) {
  command.add_option("scene", arguments.scene, "The scene, a JSON file")
      .required()
      .offers_files({"json"});
  command.add_threads(arguments.threads,
                      "Threads of the estimate (default: the CPUs this process may use)");
  command.add_flag("--no-pilot", arguments.no_pilot,
                   "Run no pilot: estimates without time and memory");
}

}  // namespace

void add_check(Command& app, int& code) {
  Command command =
      app.add_command("check", "Resolve a scene and estimate its time, memory and disk");
  auto arguments = std::make_shared<CheckArguments>();
  add_options(command, *arguments);
  command.footer(
      "Examples:\n"
      "  jostle check scene.json              up to about ten seconds; grains, a minute\n"
      "  jostle check scene.json --no-pilot   at once, without time and memory\n"
      "\n"
      "Every fault of a bad scene is printed on stderr, with its JSON pointer and what to do; the\n"
      "exit code is then 2.");
  command.run([arguments, &code] {
    check(*arguments);
    code = exit_ok;
  });
}

void add_check_requests(Command& requests, int& code) {
  Command command = requests.add_command("check", "Print what a check needs beyond a first run");
  auto arguments = std::make_shared<CheckArguments>();
  add_options(command, *arguments);
  command.run([arguments, &code] {
    const LoadedScene loaded = load_scene(arguments->scene);
    code = print_requests(arguments->no_pilot ? std::vector<std::string>{}
                                              : loops_beyond_first_run(loaded));
  });
}

}  // namespace jostle::inline cli
