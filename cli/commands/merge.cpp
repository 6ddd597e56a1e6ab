#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "cli/commands/arguments.hpp"
#include "cli/commands/commands.hpp"
#include "cli/terminal/output_file.hpp"
#include "cli/terminal/standard_streams.hpp"
#include "config/sweep.hpp"
#include "ensemble/statistics/counted.hpp"
#include "results/error.hpp"
#include "results/merge.hpp"
#include "study/available_cpus.hpp"
#include "study/provenance.hpp"
#include "study/scene_file.hpp"
#include "study/scene_tables.hpp"

namespace jostle {
namespace {

struct MergeArguments {
  std::vector<std::string> inputs;
  std::string output;
  bool force = false;
};

void require_output(const MergeArguments& arguments) {
  require_replaceable(arguments.output, "merged.h5");
  require_not_read("-o", arguments.output, arguments.inputs);
  if (arguments.force) return require_results_or_empty(arguments.output);
  if (std::filesystem::exists(arguments.output)) {
    throw BadInput(
        fmt::format("{} exists and is kept. Write elsewhere with -o FILE, or replace it with "
                    "--force.",
                    arguments.output));
  }
}

/// The study of files whose scenes differ in the values of their sweeps alone; nothing where they
/// are shares of one run. Throws ResultsError where they differ in more.
std::optional<Study> joined_study(const std::vector<std::string>& inputs) {
  std::vector<ResultsFile> files;
  for (const std::string& input : inputs) files.emplace_back(input);
  const auto same = [&](const ResultsFile& file) {
    return file.study().resolved_scene == files.front().study().resolved_scene;
  };
  if (std::ranges::all_of(files, same)) return std::nullopt;
  Json scene = stored_scene(files.front());
  ParsedScene joined;
  for (const ResultsFile& file : files) {
    joined = join_sweeps(scene, stored_scene(file));
    if (!joined.scene) {
      throw ResultsError(file.path(),
                         fmt::format("cannot be merged with {}: {}", files.front().path(),
                                     fault_lines(joined.faults)));
    }
    scene = resolved(*joined.scene);
  }
  Study study{scene.dump(2), scene.dump(2), files.front().study().realizations, {}};
  std::unordered_map<std::uint64_t, const StudyPoint*> held;
  for (const ResultsFile& file : files) {
    for (const StudyPoint& point : file.study().points) held[point.id] = &point;
  }
  for (const SweepPoint& point : sweep_points(joined.scene->sweep)) {
    const auto holder = held.find(point_id(point));
    if (holder == held.end()) {
      throw ResultsError(files.front().path(),
                         fmt::format("cannot be merged: together the sweeps have the point {}, "
                                     "which no file holds; run it, as a resume of one of them",
                                     point_label(point)));
    }
    study.points.push_back(*holder->second);
  }
  return study;
}

}  // namespace

void add_merge(CLI::App& app, int& code) {
  auto* command =
      app.add_subcommand("merge", "Join shards of a run, or runs whose sweeps differ, into one");
  auto arguments = std::make_shared<MergeArguments>();
  command
      ->add_option(
          "files", arguments->inputs,
          "Results: the shards, in any order, or runs of one scene with other values of its sweep")
      ->required();
  command->add_option("-o,--output", arguments->output, "The file to write")
      ->required()
      ->check(file_to_write());
  command->add_flag("--force", arguments->force, "Replace the output file if it exists");
  command->footer(
      "Examples:\n"
      "  jostle run scene.json --shard 1/2 -o a.h5\n"
      "  jostle run scene.json --shard 2/2 -o b.h5\n"
      "  jostle merge a.h5 b.h5 -o all.h5       the digest of all.h5 is that of an undivided run\n"
      "  jostle merge low.h5 high.h5 -o all.h5  one sweep of two with other values of it\n"
      "\n"
      "Refuses unfinished, damaged, overlapping and incomplete sets of files, and files of\n"
      "scenes that differ in more than the values of their sweeps, naming which.");
  command->callback([arguments, &code] {
    require_output(*arguments);
    merge_files(arguments->inputs, arguments->output, provenance_of_this_run("1"), arguments->force,
                joined_study(arguments->inputs));
    outlive_readers();
    print(fmt::format("{}: {} merged\n", arguments->output,
                      counted(arguments->inputs.size(), "file")));
    make_scene_tables(arguments->output, available_cpus(), false);
    code = exit_ok;
  });
}

}  // namespace jostle
