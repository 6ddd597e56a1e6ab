#include "results/locks/slurm_job.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <sstream>
#include <string_view>
#include <vector>

#include "results/disk/system_calls.hpp"

extern char** environ;  // glibc alone declares it

namespace jostle::inline results {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds longest_answer{30};

std::string variable(const char* name) {
  const char* const text = std::getenv(name);
  return text == nullptr ? "" : text;
}

std::optional<std::uint64_t> number(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// A word that a lock can hold between blanks.
bool is_word(const std::string& text) {
  constexpr std::size_t longest = 64;
  return !text.empty() && text.size() <= longest &&
         std::ranges::all_of(text, [](unsigned char c) { return c > ' ' && c < 0x7f; });
}

pid_t spawn(std::vector<std::string> words, int output) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&files, output, STDOUT_FILENO);
  pid_t child = -1;
  const int error =
      ::posix_spawnp(&child, arguments[0], &files, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  return error == 0 ? child : -1;
}

/// Reads a pipe to its end; nothing after a time limit.
std::optional<std::string> read_to_end(int pipe) {
  const auto deadline = Clock::now() + longest_answer;
  std::string text;
  std::array<char, 65536> piece;
  for (;;) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    pollfd readable{pipe, POLLIN, 0};
    const int ready = ::poll(&readable, 1, static_cast<int>(std::max<long>(left, 0)));
    if (ready < 0 && errno == EINTR) continue;
    if (ready <= 0) return std::nullopt;
    const ssize_t n = ::read(pipe, piece.data(), piece.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return std::nullopt;
    if (n == 0) return text;
    text.append(piece.data(), static_cast<std::size_t>(n));
  }
}

/// Output of a program on the PATH; nothing if it is missing, fails or does not end.
std::optional<std::string> output_of(const std::vector<std::string>& words) {
  std::array<int, 2> ends{};
  if (!open_pipe(ends)) return std::nullopt;
  const Descriptor read_end(ends[0]);
  pid_t child = -1;
  {
    const Descriptor write_end(ends[1]);
    child = spawn(words, write_end.get());
  }
  if (child < 0) return std::nullopt;
  const auto text = read_to_end(read_end.get());
  if (!text) ::kill(child, SIGKILL);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return text && WIFEXITED(status) && WEXITSTATUS(status) == 0 ? text : std::nullopt;
}

/// For a job that is not in one of these, processes may run: it runs, is suspended, comes to its
/// end, or is in a state that other versions of Slurm have.
bool has_no_processes(const std::string& state) {
  constexpr std::string_view states[] = {
      "PENDING",     "COMPLETED",    "CANCELLED",     "FAILED",   "TIMEOUT",
      "NODE_FAIL",   "PREEMPTED",    "OUT_OF_MEMORY", "DEADLINE", "BOOT_FAIL",
      "REQUEUE_FED", "REQUEUE_HOLD", "SPECIAL_EXIT",  "REVOKED",  "REQUEUED"};
  return std::ranges::find(states, state) != std::end(states);
}

/// The value of a line "key = value" of `scontrol show config`; empty where there is none.
std::string setting(const std::string& config, const std::string& wanted) {
  std::istringstream lines(config);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string key, equals, value;
    if (words >> key >> equals >> value && key == wanted) return value;
  }
  return "";
}

std::optional<std::string> slurm_config() {
  return output_of({"scontrol", "show", "config"});
}

}  // namespace

std::optional<std::uint64_t> slurm_max_array_size() {
  const auto size = number(setting(slurm_config().value_or(""), "MaxArraySize"));
  return size && *size > 1 ? size : std::nullopt;
}

std::optional<SlurmJob> this_slurm_job() {
  SlurmJob job;
  const auto id = number(variable("SLURM_JOB_ID"));
  job.cluster = variable("SLURM_CLUSTER_NAME");
  if (!id || !is_word(job.cluster)) return std::nullopt;
  job.id = *id;
  job.restarts = number(variable("SLURM_RESTART_COUNT")).value_or(0);
  const auto array = number(variable("SLURM_ARRAY_JOB_ID")),
             task = number(variable("SLURM_ARRAY_TASK_ID"));
  job.name = array && task ? fmt::format("{}_{}", *array, *task) : fmt::to_string(job.id);
  return job;
}

std::optional<bool> SlurmQueue::runs(const SlurmJob& job) {
  if (!asked_) ask();
  if (!jobs_ || job.cluster != cluster_) return std::nullopt;
  const auto found = jobs_->find(job.id);
  if (found == jobs_->end()) return false;  // ended, and forgotten since
  return found->second.restarts <= job.restarts && !has_no_processes(found->second.state);
}

void SlurmQueue::ask() {
  asked_ = true;
  // No heading, tasks of arrays apart, jobs in every state.
  const auto squeue =
      output_of({"squeue", "-h", "-r", "-t", "all", "-u", fmt::to_string(::getuid()), "-O",
                 "JobID:24,State:24,RestartCnt:24"});
  const auto config = squeue ? slurm_config() : std::nullopt;
  if (!config) return;
  cluster_ = setting(*config, "ClusterName");
  jobs_.emplace();
  std::istringstream lines(*squeue);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::uint64_t id = 0;
    Listed listed;
    if (!(words >> id >> listed.state >> listed.restarts)) continue;
    // Tasks of an array that wait share the number of the array, which one of them keeps.
    const auto [known, is_new] = jobs_->try_emplace(id, listed);
    if (!is_new && has_no_processes(known->second.state)) known->second = listed;
  }
}

}  // namespace jostle::inline results
