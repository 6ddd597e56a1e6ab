#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/arguments.hpp"
#include "cli/available_cpus.hpp"
#include "cli/commands.hpp"
#include "cli/output_file.hpp"
#include "cli/provenance.hpp"
#include "cli/scene_file.hpp"
#include "cli/scene_tables.hpp"
#include "cli/standard_streams.hpp"
#include "results/merge.hpp"

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

}  // namespace

void add_merge(CLI::App& app, int& code) {
  auto* command = app.add_subcommand("merge", "Join the files of all shards of a run into one");
  auto arguments = std::make_shared<MergeArguments>();
  command->add_option("files", arguments->inputs, "The shards' results, in any order")->required();
  command->add_option("-o,--output", arguments->output, "The file to write")
      ->required()
      ->check(file_to_write());
  command->add_flag("--force", arguments->force, "Replace the output file if it exists");
  command->footer(
      "Example:\n"
      "  jostle run scene.json --shard 1/2 -o a.h5\n"
      "  jostle run scene.json --shard 2/2 -o b.h5\n"
      "  jostle merge a.h5 b.h5 -o all.h5      the digest of all.h5 is that of an undivided run\n"
      "\n"
      "Refuses unfinished, damaged, overlapping and incomplete sets of files, and files of\n"
      "different scenes, naming which.");
  command->callback([arguments, &code] {
    require_output(*arguments);
    merge_files(arguments->inputs, arguments->output, provenance_of_this_run("1"),
                arguments->force);
    outlive_readers();
    std::fputs(
        fmt::format("{}: {} files merged\n", arguments->output, arguments->inputs.size()).c_str(),
        stdout);
    make_scene_tables(arguments->output, available_cpus(), false);
    code = exit_ok;
  });
}

}  // namespace jostle
