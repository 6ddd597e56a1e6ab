#include "cli/reports/next_commands.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>
#include <vector>

#include "cli/options/command_words.hpp"
#include "study/provenance.hpp"

namespace jostle::inline cli {
namespace {

constexpr std::size_t most_commands = 2;
constexpr std::size_t least_points = 3;  // least points of a sweep curve
constexpr std::uint64_t least_taps_to_fit = 30;
constexpr std::uint64_t least_taps_to_age = 300;
constexpr std::uint32_t least_realizations_to_age = 3;

/// True if the scene asks for this itself. A resolved scene has empty lists of what it does not.
bool asked_for(const Json& scene, std::string_view part, std::string_view kind = "") {
  const Json* found = scene.find(part);
  if (found != nullptr && !kind.empty()) found = found->is_object() ? found->find(kind) : nullptr;
  if (found == nullptr || !found->is_object()) return found != nullptr && !found->empty();
  for (const auto& [name, member] : found->members()) {
    if (!member.empty()) return true;
  }
  return false;
}

/// The first fraction, which compaction is about, or else the first observable.
std::string fraction_of(const StudyPoint& point) {
  const auto found = std::ranges::find_if(
      point.observables, [](const Column& column) { return column.name.ends_with("fraction"); });
  return found != point.observables.end() ? found->name : point.observables.front().name;
}

/// Returns the first observable of the point that is named under a key "observable".
std::optional<std::string> named_in(const Json& part, const StudyPoint& point) {
  if (part.is_array()) {
    for (const Json& element : part.elements())
      if (auto found = named_in(element, point)) return found;
  }
  if (!part.is_object()) return std::nullopt;
  for (const auto& [key, member] : part.members()) {
    if (key != "observable") {
      if (auto found = named_in(member, point)) return found;
    } else if (member.is_string() && std::ranges::find(point.observables, member.text(),
                                                       &Column::name) != point.observables.end()) {
      return member.text();
    }
  }
  return std::nullopt;
}

/// Returns what the scene itself fits, analyses or runs until; else a fraction.
std::string studied_observable(const Json& scene, const StudyPoint& point) {
  for (const char* part : {"fits", "analyse", "until"}) {
    const Json* found = scene.find(part);
    if (found == nullptr) continue;
    if (auto name = named_in(*found, point)) return *name;
  }
  return fraction_of(point);
}

/// Ramps that follow one another may turn.
bool goes_up_and_down(const Json& scene) {
  const Json* protocol = scene.find("protocol");
  if (protocol == nullptr || !protocol->is_array()) return false;
  std::size_t ramps = 0;
  for (const Json& stage : protocol->elements()) ramps += stage.contains("ramp") ? 1 : 0;
  return ramps > 1;
}

bool has_one_stage(const Json& scene) {
  const Json* protocol = scene.find("protocol");
  return protocol != nullptr && protocol->is_array() && protocol->size() == 1 &&
         !protocol->elements().begin()->contains("ramp");
}

}  // namespace

std::vector<std::vector<std::string>> next_commands(const Study& study, const Json& scene,
                                                    const std::string& path) {
  const std::string file = operand(path);
  const StudyPoint& point = study.points.front();
  if (point.observables.empty()) return {{"info", file}};
  const std::string observable = studied_observable(scene, point);
  const bool kept = point.snapshots.positions && !point.snapshots.taps.empty();
  std::vector<std::vector<std::string>> commands;
  const auto propose = [&](bool makes_sense, std::vector<std::string> words) {
    if (makes_sense && commands.size() < most_commands) commands.push_back(std::move(words));
  };
  propose(study.points.size() >= least_points && !asked_for(scene, "analyse", "sweep"),
          {"analyse", file, "sweep", "--observable", observable});
  propose(goes_up_and_down(scene) && !asked_for(scene, "analyse", "hysteresis"),
          {"analyse", file, "hysteresis", "--observable", observable});
  propose(has_one_stage(scene) && point.taps >= least_taps_to_fit && !asked_for(scene, "fits"),
          {"fit", file, "--observable", observable});
  propose(has_one_stage(scene) && point.taps >= least_taps_to_age &&
              study.realizations >= least_realizations_to_age &&
              !asked_for(scene, "analyse", "ageing"),
          {"analyse", file, "ageing", "--observable", observable});
  // The page shows the tables that there are.
  propose(asked_for(scene, "fits") || asked_for(scene, "analyse") || asked_for(scene, "structure"),
          {"report", file});
  // Measures of structure take equal spheres.
  propose(kept && !point.mixture && !asked_for(scene, "structure"), {"structure", file});
  propose(kept, {"export", file, "--format", "extxyz"});
  propose(true, {"info", file});
  return commands;
}

namespace {

// Options of `run` that a resume takes over; --resume, --shard and the output are set anew, and
// --force must not come back.
constexpr std::string_view kept_flags[] = {"--retry-failed", "--wide", "--verbose", "--quiet",
                                           "--no-progress"};
constexpr std::string_view flags_set_anew[] = {"--resume", "--force"};
constexpr std::string_view kept_values[] = {"--threads", "--time-limit", "--checkpoint-every",
                                            "--wait"};
constexpr std::string_view values_set_anew[] = {"--shard", "--output", "-o"};

template <class Names>
bool is_one_of(std::string_view word, const Names& names) {
  return std::ranges::find(names, word) != std::end(names);
}

/// Appends the text that bash's quotes $'...' enclose; returns the place of the closing quote.
std::size_t append_escaped(std::string_view line, std::size_t start, std::string& word) {
  std::size_t i = start;
  for (; i < line.size() && line[i] != '\''; ++i) {
    if (line[i] == '\\' && i + 1 < line.size() && line[++i] == 'x') {
      const std::string_view digits = line.substr(i + 1, 2);
      unsigned byte = 0;
      const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), byte, 16);
      word += static_cast<char>(byte);
      i += static_cast<std::size_t>(read.ptr - digits.data());
    } else {
      word += line[i];
    }
  }
  return i;
}

/// Words of a line that shell_words() made.
std::vector<std::string> words_of(std::string_view line) {
  std::vector<std::string> words;
  bool in_word = false, quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == ' ' && !quoted) {
      in_word = false;
      continue;
    }
    if (!in_word) words.emplace_back();
    in_word = true;
    if (line.substr(i, 2) == "$'" && !quoted) {
      i = append_escaped(line, i + 2, words.back());
    } else if (c == '\'') {
      quoted = !quoted;
    } else if (c == '\\' && !quoted && i + 1 < line.size()) {
      words.back() += line[++i];
    } else {
      words.back() += c;
    }
  }
  return words;
}

/// The request of a command line of `run`.
struct RunWords {
  std::string scene;
  std::vector<std::string> options;  // those that are taken over
};

/// Nothing where the line is no command line of `run`.
std::optional<RunWords> run_words(const std::vector<std::string>& words) {
  RunWords found;
  if (words.size() < 3 || words[1] != "run") return std::nullopt;
  bool operands_only = false;
  for (std::size_t i = 2; i < words.size(); ++i) {
    const std::string& word = words[i];
    const bool attached = word.starts_with("-o") && word.size() > 2;  // -oFILE
    const std::string name = attached ? "-o" : word.substr(0, word.find('='));
    const bool has_value = is_one_of(name, kept_values) || is_one_of(name, values_set_anew);
    if (operands_only || !word.starts_with('-')) {
      if (!found.scene.empty()) return std::nullopt;
      found.scene = word;
    } else if (word == "--") {
      operands_only = true;
    } else if (has_value) {
      const bool in_next = name == word;
      if (in_next && ++i == words.size()) return std::nullopt;
      if (is_one_of(name, kept_values))
        found.options.push_back(in_next ? name + "=" + words[i] : word);
    } else if (is_one_of(word, kept_flags)) {
      found.options.push_back(word);
    } else if (!is_one_of(word, flags_set_anew)) {
      return std::nullopt;
    }
  }
  return found.scene.empty() ? std::nullopt : std::optional(found);
}

}  // namespace

std::string redo_command(const std::string& program, const std::string& stored, std::uint32_t index,
                         std::size_t count, const std::string& output) {
  const RunWords last = run_words(words_of(stored)).value_or(RunWords{"SCENE.json", {}});
  std::vector<std::string> words{program, "run", operand(last.scene)};
  words.insert(words.end(), last.options.begin(), last.options.end());
  words.emplace_back("--resume");
  if (count > 1) words.insert(words.end(), {"--shard", fmt::format("{}/{}", index, count)});
  words.insert(words.end(), {"-o", operand(output)});
  return shell_words(words);
}

}  // namespace jostle::inline cli
