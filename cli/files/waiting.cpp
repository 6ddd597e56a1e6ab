#include "cli/files/waiting.hpp"

#include <fmt/format.h>

#include "cli/tables/durations.hpp"
#include "cli/terminal/standard_streams.hpp"
#include "results/disk/printable.hpp"
#include "results/file/results_file.hpp"
#include "study/provenance.hpp"

namespace jostle::inline cli {

void add_wait(Command& command, Patience& patience) {
  patience.tell = [](const std::string& message) {
    print_to_standard_error(fmt::format("jostle: {}\n", printable(message)));
  };
  command
      .add_reader(
          "--wait",
          [&patience](const std::string& text) {
            const auto duration = parse_duration(text);
            if (!duration) throw BadValue(fmt::format("\"{}\" is not a duration, as 10m", text));
            patience.for_storing = patience.for_runs = *duration;
          },
          "Longest wait for another process that writes the results (default: 10s to store "
          "tables, 0s for a run)")
      .environment("JOSTLE_WAIT");
}

void warn_of_lost_seals(std::span<const std::string> paths) {
  for (const std::string& path : paths) {
    const std::string warning = seal_warning(path);
    if (warning.empty()) continue;
    print_to_standard_error(
        fmt::format("jostle: warning: {}: {}. Seal the file again:\n  {}\n", printable(path),
                    warning, shell_words({command_line().front(), "info", "--reseal", path})));
  }
}

}  // namespace jostle::inline cli
