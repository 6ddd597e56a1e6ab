#include "cli/files/python_plot.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <span>
#include <system_error>

#include "results/disk/error.hpp"
#include "results/disk/output_path.hpp"
#include "results/disk/temporary_file.hpp"
#include "study/provenance.hpp"

extern char** environ;  // glibc alone declares it

namespace jostle::inline cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* where_the_package_is =
    "Where cmake --install put jostle: export PYTHONPATH=PREFIX/lib/python3/dist-packages.";
constexpr const char* what_to_install =
    "On Debian or Ubuntu: sudo apt-get install python3-matplotlib python3-h5py python3-numpy. The "
    "data, the scripts and the JSON of --figures are written in any case.";

/// Empty where there is no such file.
std::string read_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The child does this before it becomes python3.
class FileActions {
 public:
  FileActions(const fs::path& folder, const fs::path& messages) {
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

/// The file of this program; empty if unknown.
fs::path own_path() {
  try {
    return program_path();
  } catch (const fs::filesystem_error&) {
    return {};
  }
}

/// The environment with the folder of the module first on Python's path.
class Surroundings {
 public:
  Surroundings() {
    std::error_code fault;
    const fs::path program = own_path();
    const fs::path package = program.parent_path().parent_path() / "lib/python3/dist-packages";
    const bool is_there =
        !program.empty() && fs::exists(package / "jostle/plot/__main__.py", fault);
    for (char** variable = environ; *variable != nullptr; ++variable) {
      const std::string_view text = *variable;
      if (!(is_there && text.starts_with("PYTHONPATH="))) kept_.emplace_back(text);
    }
    if (is_there) {
      const char* const own = std::getenv("PYTHONPATH");
      const std::string inherited = own == nullptr || *own == '\0' ? "" : ":" + std::string(own);
      kept_.push_back("PYTHONPATH=" + package.string() + inherited);
    }
    kept_.emplace_back("PYTHONDONTWRITEBYTECODE=1");
    for (std::string& variable : kept_) pointers_.push_back(variable.data());
    pointers_.push_back(nullptr);
  }
  char* const* get() const { return pointers_.data(); }

 private:
  std::vector<std::string> kept_;
  std::vector<char*> pointers_;
};

/// How a python3 ended; `status` is empty where there is no such program.
struct Ended {
  std::optional<int> status;
  std::string messages;
};

Ended call(std::string python, const fs::path& folder, JournalColumns columns) {
  const ScratchFolder own("python");
  const fs::path messages = own.path() / "messages.txt";
  const FileActions actions(folder, messages);
  const Surroundings surroundings;
  std::string is_module = "-m", module = "jostle.plot", input = "catalogue.json",
              option = "--columns", width = columns == JournalColumns::two ? "2" : "1";
  char* const arguments[] = {python.data(), is_module.data(), module.data(), input.data(),
                             option.data(), width.data(),     nullptr};
  pid_t child = 0;
  const int fault =
      ::posix_spawnp(&child, python.c_str(), actions.get(), nullptr, arguments, surroundings.get());
  if (fault == ENOENT) return {};
  if (fault != 0) {
    throw ResultsError(python, "cannot be called: " + std::generic_category().message(fault));
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno == EINTR) continue;
    throw ResultsError(python, "is lost: " + std::generic_category().message(errno));
  }
  return {status, read_file(messages)};
}

bool lacks_module(const Ended& ended) {
  if (!ended.status || !WIFEXITED(*ended.status)) return !ended.status;
  return WEXITSTATUS(*ended.status) != 0 &&
         ended.messages.find("No module named") != std::string::npos;
}

/// The first python3 that has all modules, else the first that there is: that of the environment
/// into which pip has installed this program, that of the PATH, the system's.
Ended call_first_complete(const fs::path& folder, JournalColumns columns) {
  std::vector<std::string> programs = {"python3", "/usr/bin/python3"};
  const fs::path own_folder = own_path().parent_path();
  std::error_code fault;
  if (fs::exists(own_folder / "../pyvenv.cfg", fault))
    programs.insert(programs.begin(), (own_folder / "python3").string());
  Ended first;
  for (const std::string& program : programs) {
    Ended ended = call(program, folder, columns);
    if (!lacks_module(ended)) return ended;
    if (!first.status) first = std::move(ended);
  }
  return first;
}

/// The last line of a traceback names the missing module.
std::string last_line(std::string text) {
  while (text.ends_with('\n')) text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

}  // namespace

std::vector<PaperFigure> draw_with_python(const std::vector<Json>& figures,
                                          JournalColumns columns) {
  const ScratchFolder folder("figures");
  const std::string catalogue = catalogue_json(figures, {}).dump();
  write_new_file(folder.path() / "catalogue.json", std::as_bytes(std::span(catalogue)));
  const Ended ended = call_first_complete(folder.path(), columns);
  if (!ended.status) {
    throw ResultsError(
        "python3", fmt::format("it is not installed, and draws the figures. {}", what_to_install));
  }
  if (lacks_module(ended)) {
    const std::string missing = last_line(ended.messages);
    const bool is_own = missing.find("'jostle") != std::string::npos;
    throw ResultsError("python3", fmt::format("it cannot draw the figures: {}. {}", missing,
                                              is_own ? where_the_package_is : what_to_install));
  }
  std::vector<PaperFigure> drawn;
  for (const Json& figure : figures) {
    const fs::path path = folder.path() / figure.at("name").text();
    drawn.push_back({read_file(path.string() + ".svg"), read_file(path.string() + ".pdf")});
    if (*ended.status == 0 && !drawn.back().svg.empty() && !drawn.back().pdf.empty()) continue;
    throw ResultsError(path.filename().string(),
                       fmt::format("python3 could not draw it; jostle needs matplotlib 3.6 or "
                                   "later. It reports:\n{}",
                                   ended.messages));
  }
  return drawn;
}

}  // namespace jostle::inline cli
