#include <fmt/format.h>
#include <stdlib.h>

#include <cerrno>
#include <filesystem>
#include <memory>
#include <system_error>

#include "cli/commands/commands.hpp"
#include "cli/terminal/standard_streams.hpp"
#include "study/bad_input.hpp"
#include "study/self_checks.hpp"

namespace jostle::inline cli {
namespace {

/// A folder of its own within another, removed with all that is in it.
class ScratchFolder {
 public:
  explicit ScratchFolder(const std::filesystem::path& within)
      : path_(within / "jostle-selftest-XXXXXX") {
    if (::mkdtemp(path_.data()) == nullptr) {
      const std::string reason = std::generic_category().message(errno);
      throw BadInput(fmt::format("{}: cannot make a folder there ({}): name another with --folder",
                                 within.string(), reason));
    }
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

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

int selftest(const std::string& folder) {
  const ScratchFolder scratch(folder.empty() ? std::filesystem::temp_directory_path()
                                             : std::filesystem::path(folder));
  int code = exit_ok;
  for (const SelfCheck& check : self_checks(scratch.path())) {
    if (!print_check(check)) code = exit_io_error;
  }
  return code;
}

}  // namespace

void add_selftest(Command& app, int& code) {
  Command command =
      app.add_command("selftest", "Check in seconds that this machine computes and stores right");
  auto folder = std::make_shared<std::string>();
  command.add_option("--folder", *folder,
                     "Write the trial files here, on the disk that results will go to (default: "
                     "the folder for temporary files)");
  command.footer(
      "Examples:\n"
      "  jostle selftest\n"
      "  jostle selftest --folder /scratch/me   also tries that disk\n"
      "\n"
      "One line a check, \"ok\" or \"FAILED\" with what, why and what to do; exit code 4 if any\n"
      "failed. Trials of every instruction set that this machine has against a plain loop; no\n"
      "overlaps, by all pairs; a certified fit; one thread against two; a results file read back.");
  command.run([folder, &code] { code = selftest(*folder); });
}

}  // namespace jostle::inline cli
