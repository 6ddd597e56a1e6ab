#include "cli/files/live_input.hpp"

#include <fmt/format.h>

#include "cli/files/waiting.hpp"
#include "cli/terminal/standard_streams.hpp"
#include "study/provenance.hpp"

namespace jostle::inline cli {

void add_live(Command& command, Live& live) {
  command.add_flag(
      "--live", [&live] { live = Live::yes; },
      "Read the checkpoints of an unfinished run too; its results file stays as it is");
}

ResultsFile open_to_read(const std::string& path, Live live) {
  ResultsFile file = open_results(path, live);
  warn_of_lost_seals(std::span(&path, 1));
  if (file.state() == RunState::interrupted) {
    print_to_standard_error(fmt::format(
        "jostle: {}: its run is unfinished: here are the taps of its last {}. Finish it with "
        "{} SCENE --resume.\n",
        path, live == Live::yes ? "checkpoints" : "stop",
        shell_words({command_line().front(), "run"})));
  }
  return file;
}

}  // namespace jostle::inline cli
