#include "cli/reports/status_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <optional>

#include "cli/options/command_words.hpp"
#include "cli/reports/next_commands.hpp"
#include "cli/tables/durations.hpp"
#include "ensemble/statistics/counted.hpp"
#include "ensemble/statistics/finite_text.hpp"
#include "results/disk/error.hpp"
#include "results/disk/input_file.hpp"
#include "results/disk/output_path.hpp"
#include "study/provenance.hpp"

namespace jostle::inline cli {
namespace {

namespace fs = std::filesystem;

constexpr ShardState all_states[] = {ShardState::done, ShardState::running, ShardState::stopped,
                                     ShardState::dead, ShardState::missing, ShardState::unreadable};

/// The folder of all files; nothing where they lie in several.
std::optional<fs::path> common_folder(const ShardsStatus& study) {
  std::optional<fs::path> folder;
  for (const ShardStatus& shard : study.shards) {
    if (shard.path.empty()) continue;
    const fs::path own = fs::path(shard.path).parent_path();
    if (folder && *folder != own) return std::nullopt;
    folder = own;
  }
  return folder;
}

/// The number behind "key=" in the script's line of variables.
std::optional<std::uint32_t> variable(const std::string& script, const std::string& key) {
  for (const char* const separator : {"\n", " "}) {
    const std::size_t index = script.find(separator + key + "=");
    if (index == std::string::npos) continue;
    const char* const digits = script.data() + index + key.size() + 2;
    std::uint32_t number = 0;
    const auto [end, error] = std::from_chars(digits, script.data() + script.size(), number);
    if (error == std::errc{} && number > 0) return number;
  }
  return std::nullopt;
}

/// True if a resume continues a shard. An unreadable file may hold finished work.
bool is_open(const ShardStatus& shard, const ShardsStatus& study) {
  if (shard.state == ShardState::missing) return study.unread.empty();
  return shard.state == ShardState::stopped || shard.state == ShardState::dead;
}

std::string owner_name(const LockOwner& owner) {
  const std::string process = fmt::format("process {} on {}", owner.pid, owner.host);
  return owner.job ? fmt::format("job {}, {}", owner.job->name, process) : process;
}

/// Lists a few shards with their states.
std::string remark(const ShardStatus& shard) {
  if (!shard.owner) return "";
  return owner_name(*shard.owner) + (shard.state == ShardState::dead ? ", has ended" : "");
}

std::string state_line(const ShardsStatus& study, ShardState state) {
  constexpr std::size_t most_remarks = 3;
  const std::vector<std::uint32_t> indices = study.indices(state);
  std::string text = fmt::format("  {:<13}{}", name_of(state), indices.size());
  if (indices.empty()) return state == ShardState::unreadable ? "" : text + "\n";
  text += fmt::format(": {}", ranges_text(indices));
  if (indices.size() <= most_remarks) {
    for (const std::uint32_t index : indices) {
      const std::string of_it = remark(study.shards[index - 1]);
      if (!of_it.empty()) text += fmt::format("; {}: {}", index, of_it);
    }
  }
  return text + "\n";
}

struct Sums {
  std::uint64_t done = 0, failed = 0, realizations = 0, taps = 0, all_taps = 0;
};
Sums sums_of(const ShardsStatus& study) {
  Sums sums;
  for (const ShardStatus& shard : study.shards) {
    sums.done += shard.done;
    sums.failed += shard.failed;
    sums.realizations += shard.realizations;
    sums.taps += shard.taps;
    sums.all_taps += shard.all_taps;
  }
  return sums;
}

double hours(Seconds time) {
  return time.count() / 3600;
}

Json hours_json(const std::optional<Seconds>& time) {
  return time ? Json(hours(*time)) : Json(nullptr);
}

}  // namespace

JobArray job_array(const ShardsStatus& study) {
  const auto folder = common_folder(study);
  if (!folder) return {};
  const std::string path = (*folder / "job.sbatch").string();
  std::error_code unreadable;
  if (!fs::is_regular_file(path, unreadable)) return {};
  if (may_be_planted(path, Writers::a_group_or_everybody)) return {};  // it would be submitted
  try {
    const std::string script = read_text_file(path);
    const auto shards = variable(script, "shards"), a_task = variable(script, "a_task");
    if (shards == study.shards.size() && a_task) return {path, *a_task};
  } catch (const ResultsError&) {  // unreadable: as if it were not there
  }
  return {};
}

std::vector<std::string> redo_commands(const ShardsStatus& study, const JobArray& array) {
  std::vector<std::uint32_t> tasks;
  std::vector<std::string> commands;
  const auto known = std::ranges::find_if(
      study.shards, [](const ShardStatus& shard) { return !shard.command.empty(); });
  const fs::path folder = common_folder(study).value_or("");
  for (const ShardStatus& shard : study.shards) {
    if (!is_open(shard, study)) continue;
    if (!array.script.empty()) {
      const std::uint32_t task = (shard.index - 1) / array.shards_a_task + 1;
      if (tasks.empty() || tasks.back() != task) tasks.push_back(task);
    } else if (known != study.shards.end()) {
      std::string output = shard.path;
      if (output.empty()) output = (folder / fmt::format("{}.h5", shard.index)).string();
      if (shard.path.empty() && fs::exists(output)) {  // it holds another shard
        output = (folder / fmt::format("{}-of-{}.h5", shard.index, study.shards.size())).string();
      }
      commands.push_back(redo_command(command_line().front(),
                                      shard.command.empty() ? known->command : shard.command,
                                      shard.index, study.shards.size(), output));
    }
  }
  if (!tasks.empty()) {
    commands.push_back(shell_words(
        {"sbatch", fmt::format("--array={}", ranges_text(tasks)), operand(array.script)}));
  }
  return commands;
}

std::string status_text(const ShardsStatus& study) {
  const Sums sums = sums_of(study);
  std::string text = fmt::format("{}: {}\n", study.scene, counted(study.shards.size(), "shard"));
  for (const ShardState state : all_states) text += state_line(study, state);
  const auto line = [&](const char* key, const std::string& value) {
    text += fmt::format("  {:<13}{}\n", key, value);
  };
  line("realizations", fmt::format("{} of {} done{}", sums.done, sums.realizations,
                                   sums.failed > 0 ? fmt::format(", {} failed", sums.failed) : ""));
  line("taps", fmt::format("{} of {}", sums.taps, sums.all_taps));
  line("core-hours", (study.used ? finite_text("{:.3g} used, ", hours(*study.used))
                                 : "no cost is recorded yet, ") +
                         (study.left ? finite_text("about {:.3g} left", hours(*study.left))
                                     : "the rest is not known"));
  for (const std::string& path : study.twice)
    line("twice", path + " holds a shard that another file holds");
  const std::string restore =
      " cannot be read, and what it holds may be finished: restore it from a copy, or remove it to "
      "compute it again";
  for (const ShardStatus& shard : study.shards)
    if (shard.state == ShardState::unreadable) line("unreadable", shard.path + restore);
  for (const std::string& path : study.unread) line("unreadable", path + restore);
  return text;
}

Json status_json(const ShardsStatus& study, const std::vector<std::string>& redo) {
  const Sums sums = sums_of(study);
  Json shards = Json::array(), commands = Json::array(), twice = Json::array();
  for (const ShardStatus& shard : study.shards) {
    Json shard_json{{"index", std::uint64_t{shard.index}},
                    {"state", name_of(shard.state)},
                    {"realizations", shard.realizations},
                    {"done", shard.done},
                    {"failed", shard.failed},
                    {"taps_recorded", shard.taps},
                    {"taps", shard.all_taps}};
    if (!shard.path.empty()) shard_json["file"] = shard.path;
    if (shard.owner) {
      shard_json["host"] = shard.owner->host;
      if (shard.owner->job) shard_json["job"] = shard.owner->job->name;
    }
    shards.push_back(shard_json);
  }
  for (const std::string& command : redo) commands.push_back(command);
  for (const std::string& path : study.twice) twice.push_back(path);
  Json unread = Json::array();
  for (const std::string& path : study.unread) unread.push_back(path);
  Json counts = Json::object();
  for (const ShardState state : all_states)
    counts[name_of(state)] = static_cast<std::uint64_t>(study.indices(state).size());
  return {{"scene", study.scene},
          {"counts", counts},
          {"realizations", sums.realizations},
          {"realizations_done", sums.done},
          {"realizations_failed", sums.failed},
          {"core_hours_used", hours_json(study.used)},
          {"core_hours_left", hours_json(study.left)},
          {"shards", shards},
          {"redo", commands},
          {"twice", twice},
          {"unread", unread}};
}

}  // namespace jostle::inline cli
