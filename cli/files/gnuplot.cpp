#include "cli/files/gnuplot.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <system_error>

#include "results/checkpoints/output_path.hpp"
#include "results/checkpoints/scratch_folder.hpp"
#include "results/error.hpp"

extern char** environ;  // glibc alone declares it

namespace jostle::inline cli {
namespace {

namespace fs = std::filesystem;

/// Empty where there is no such file.
std::string read_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// What the child does before it becomes gnuplot; freed with this.
class FileActions {
 public:
  explicit FileActions(const fs::path& folder, const fs::path& messages) {
    ::posix_spawn_file_actions_init(&actions_);
    ::posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions_, STDERR_FILENO, messages.c_str(),
                                       O_WRONLY | O_CREAT | O_EXCL, 0600);
    ::posix_spawn_file_actions_addchdir_np(&actions_, folder.c_str());
  }
  FileActions(const FileActions&) = delete;
  FileActions& operator=(const FileActions&) = delete;
  ~FileActions() { ::posix_spawn_file_actions_destroy(&actions_); }
  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

/// The exit status, as of wait(); throws where there is no gnuplot.
int call_gnuplot(const std::string& script, const fs::path& folder, const fs::path& messages) {
  const FileActions actions(folder, messages);
  std::string program = "gnuplot", settings = "--default-settings", name = script;
  char* const arguments[] = {program.data(), settings.data(), name.data(), nullptr};
  pid_t child = 0;
  const int fault = ::posix_spawnp(&child, "gnuplot", actions.get(), nullptr, arguments, environ);
  if (fault == ENOENT) {
    throw ResultsError("gnuplot",
                       "it is not installed, and draws the figures: on Debian or Ubuntu, sudo "
                       "apt-get install gnuplot-nox");
  }
  if (fault != 0) {
    throw ResultsError("gnuplot", "cannot be called: " + std::generic_category().message(fault));
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno == EINTR) continue;
    throw ResultsError("gnuplot", "is lost: " + std::generic_category().message(errno));
  }
  return status;
}

}  // namespace

std::vector<NamedText> run_gnuplot(const std::string& script, const std::vector<NamedText>& files,
                                   const std::vector<std::string>& wanted) {
  const ScratchFolder folder("figures");
  for (const NamedText& file : files)
    write_new_file(folder.path() / file.name, std::as_bytes(std::span(file.text)));
  const fs::path messages = folder.path() / "messages.txt";
  const int status = call_gnuplot(script, folder.path(), messages);
  std::vector<NamedText> drawn;
  for (const std::string& name : wanted) drawn.push_back({name, read_file(folder.path() / name)});
  for (const NamedText& one : drawn) {
    if (status == 0 && !one.text.empty()) continue;
    throw ResultsError(script,
                       fmt::format("gnuplot could not draw it; jostle needs version 5.4 or "
                                   "later with the terminals svg and pdfcairo. It says:\n{}",
                                   read_file(messages)));
  }
  return drawn;
}

}  // namespace jostle::inline cli
