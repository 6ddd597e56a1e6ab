#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "cli/commands/commands.hpp"
#include "cli/files/waiting.hpp"
#include "cli/options/command_words.hpp"
#include "cli/reports/status_report.hpp"
#include "cli/terminal/screen.hpp"
#include "cli/terminal/standard_streams.hpp"
#include "study/provenance.hpp"

namespace jostle::inline cli {
namespace {

struct StatusArguments {
  std::vector<std::string> files;
  bool json = false;
};

bool all_done(const ShardsStatus& study) {
  return study.indices(ShardState::done).size() == study.shards.size();
}

/// The next commands: these are never folded. `inputs`: what has the shards of this study alone.
std::string next_text(const ShardsStatus& study, const std::vector<std::string>& inputs,
                      const std::vector<std::string>& redo) {
  constexpr std::size_t most_commands = 20;
  std::string text;
  if (all_done(study) && study.shards.size() > 1) {
    std::vector<std::string> words{command_line().front(), "merge"};
    std::ranges::transform(inputs, std::back_inserter(words), operand);
    words.insert(words.end(), {"-o", study.scene + ".h5"});
    return fmt::format("next:\n  {}\n", shell_words(words));
  }
  if (redo.empty()) return "";
  text = "to run the stopped, dead and missing shards again:\n";
  for (std::size_t i = 0; i < std::min(redo.size(), most_commands); ++i)
    text += fmt::format("  {}\n", redo[i]);
  if (redo.size() > most_commands)
    text += fmt::format("  ... and {} more (--json has all)\n", redo.size() - most_commands);
  return text;
}

int show_status(const StatusArguments& arguments) {
  const Overview overview = overview_of(results_files(arguments.files));
  Json studies = Json::array(), bad_files = Json::array();
  for (const ShardsStatus& study : overview.studies) {
    const std::vector<std::string> redo = redo_commands(study, job_array(study));
    if (arguments.json) {
      studies.push_back(status_json(study, redo));
    } else {
      print_wrapped(status_text(study));
      std::vector<std::string> paths;
      for (const ShardStatus& shard : study.shards) paths.push_back(shard.path);
      print(next_text(study, overview.studies.size() == 1 ? arguments.files : paths, redo));
    }
  }
  for (const BadFile& file : overview.bad_files) {
    bad_files.push_back({{"file", file.path}, {"reason", file.reason}});
    print_to_standard_error(fmt::format("jostle: {}\n", file.reason));
  }
  warn_of_lost_seals(results_files(arguments.files));
  if (arguments.json) print_json({{"studies", studies}, {"bad_files", bad_files}});
  return overview.bad_files.empty() ? exit_ok : exit_io_error;
}

}  // namespace

void add_status(Command& app, int& code) {
  Command command = app.add_command(
      "status", "Show the progress of shards and the command that runs the missing ones");
  auto arguments = std::make_shared<StatusArguments>();
  command.add_option("files", arguments->files, "A folder of shards, or their files")
      .required()
      .offers_files({"h5"});
  command.add_flag("--json", arguments->json, "Print everything as JSON");
  command.footer(
      "Examples:\n"
      "  jostle status scene.shards     done, running, dead and missing shards, core-hours left\n"
      "  jostle status low.h5 high.h5 --json\n"
      "\n"
      "dead: its process was killed; a resume continues from its checkpoints. unreadable: its\n"
      "file is damaged, and may hold finished realizations. The last line is the command that\n"
      "runs the missing part alone.");
  command.run([arguments, &code] { code = show_status(*arguments); });
}

}  // namespace jostle::inline cli
