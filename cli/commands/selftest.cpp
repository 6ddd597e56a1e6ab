#include <fmt/format.h>

#include <memory>
#include <stdexcept>

#include "cli/commands/commands.hpp"
#include "cli/terminal/standard_streams.hpp"
#include "results/disk/error.hpp"
#include "results/disk/temporary_file.hpp"
#include "study/running/self_checks.hpp"

namespace jostle::inline cli {
namespace {

const char* remedy(SelfCheck::Finds finds) {
  switch (finds) {
    case SelfCheck::Finds::wrong_numbers:
      return "this build on this machine computes wrongly: trust no result of it. Build again "
             "without compiler flags of your own, try another machine, and report this line with "
             "`jostle --version`";
    case SelfCheck::Finds::bad_disk:
      return "look at the disk and its quota, or name another folder with --folder: runs that "
             "write there would lose data";
  }
  return "";
}

/// Returns whether the check passed.
bool print_check(const SelfCheck& check) {
  try {
    const std::string found = check.run();
    print(fmt::format("ok      {}: {}\n", check.name, found));
    return true;
  } catch (const std::exception& failure) {
    print(fmt::format("FAILED  {}: {}; {}\n", check.name, failure.what(), remedy(check.finds)));
    return false;
  }
}

ScratchFolder scratch_folder(const std::string& folder) {
  if (folder.empty()) return ScratchFolder("selftest");
  try {
    return ScratchFolder("selftest", folder);
  } catch (const ResultsError& error) {
    throw std::runtime_error(fmt::format("{}: name another with --folder", error.what()));
  }
}

int selftest(const std::string& folder) {
  const ScratchFolder scratch = scratch_folder(folder);
  int code = exit_ok;
  for (const SelfCheck& check : self_checks(scratch.path().string())) {
    if (!print_check(check)) code = exit_io_error;
  }
  return code;
}

}  // namespace

void add_selftest(Command& app, int& code) {
  Command command = app.add_command(
      "selftest", "Check in seconds that this machine computes and stores correctly");
  auto folder = std::make_shared<std::string>();
  command.add_option("--folder", *folder,
                     "Folder of the test files, on the disk that results will go to (default: "
                     "the folder for temporary files)");
  command.footer(
      "Examples:\n"
      "  jostle selftest\n"
      "  jostle selftest --folder /scratch/me   also tries that disk\n"
      "\n"
      "Prints one line per check, \"ok\" or \"FAILED\" with what, why and what to do; exit code 4\n"
      "if any failed. The checks compare trials of every instruction set of this machine with a\n"
      "plain loop, search all pairs for overlaps, fit a curve of known parameters, compare one\n"
      "thread with two, and read a results file back.");
  command.run([folder, &code] { code = selftest(*folder); });
}

}  // namespace jostle::inline cli
