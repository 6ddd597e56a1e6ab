#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/commands/commands.hpp"
#include "cli/files/output_file.hpp"
#include "cli/files/waiting.hpp"
#include "cli/tables/scene_tables.hpp"
#include "cli/terminal/screen.hpp"
#include "cli/terminal/standard_streams.hpp"
#include "ensemble/statistics/counted.hpp"
#include "results/run/merge.hpp"
#include "study/available_cpus.hpp"
#include "study/bad_input.hpp"
#include "study/planning/shards.hpp"
#include "study/provenance.hpp"
#include "study/running/merge.hpp"

namespace jostle::inline cli {
namespace {

struct MergeArguments {
  std::vector<std::string> named;  // files and folders
  std::vector<std::string> inputs;
  std::string output;
  bool force = false;
  Patience patience;
};

void require_output(const MergeArguments& arguments) {
  require_replaceable(arguments.output, "merged.h5");
  require_not_read("-o", arguments.output, arguments.inputs);
  if (arguments.force) return require_results_or_empty(arguments.output);
  std::error_code unreadable;
  if (std::filesystem::exists(arguments.output, unreadable)) {
    throw BadInput(
        fmt::format("{} exists and is kept. Write elsewhere with -o FILE, or replace it with "
                    "--force.",
                    arguments.output));
  }
}

}  // namespace

void add_merge(Command& app, int& code) {
  Command command =
      app.add_command("merge", "Join shards of a run, or runs whose sweeps differ, into one");
  auto arguments = std::make_shared<MergeArguments>();
  command
      .add_option(
          "files", arguments->named,
          "Results: the shards, in any order, or the folder they are in; or runs of one scene with "
          "other values of its sweep")
      .required()
      .offers_files({"h5"});
  command.add_option("-o,--output", arguments->output, "The file to write")
      .required()
      .file_to_write()
      .offers_files({"h5"});
  command.add_flag("--force", arguments->force, "Replace the output file if it exists");
  add_wait(command, arguments->patience);
  command.footer(
      "Examples:\n"
      "  jostle run scene.json --shard 1/2 -o a.h5\n"
      "  jostle run scene.json --shard 2/2 -o b.h5\n"
      "  jostle merge a.h5 b.h5 -o all.h5        has the digest of an undivided run\n"
      "  jostle merge scene.shards -o merged.h5  the shards of a folder\n"
      "  jostle merge low.h5 high.h5 -o all.h5   joins two sweeps of one scene\n"
      "\n"
      "Refuses unfinished, damaged, overlapping and incomplete sets of files, and files of\n"
      "scenes that differ in more than the values of their sweeps, naming which.");
  command.run([arguments, &code] {
    arguments->inputs = results_files(arguments->named);
    require_output(*arguments);
    merge_files(arguments->inputs, arguments->output, provenance_of_this_run("1"), arguments->force,
                joined_study(arguments->inputs), arguments->patience);
    warn_of_lost_seals(arguments->inputs);
    print(fmt::format("{}: {} merged\n", arguments->output,
                      counted(arguments->inputs.size(), "file")));
    make_scene_tables(ResultsFile(arguments->output), {.threads = available_cpus(),
                                                       .patience = arguments->patience,
                                                       .layout = {.width = screen().width}});
    code = exit_ok;
  });
}

}  // namespace jostle::inline cli
