#include "cli/reports/redo_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <vector>

#include "cli/options/command_words.hpp"
#include "study/provenance.hpp"

namespace jostle::inline cli {
namespace {

// Options of `run` that a resume takes over; --resume, --shard and the output are set anew, and
// --force must not come back.
constexpr std::string_view kept_flags[] = {"--retry-failed", "--wide", "--quiet", "--no-progress"};
constexpr std::string_view flags_set_anew[] = {"--resume", "--force"};
constexpr std::string_view kept_values[] = {"--threads", "--time-limit", "--checkpoint-every",
                                            "--wait"};
constexpr std::string_view values_set_anew[] = {"--shard", "--output", "-o"};

template <class Names>
bool is_one_of(std::string_view word, const Names& names) {
  return std::ranges::find(names, word) != std::end(names);
}

/// Words of a line that shell_words() made.
std::vector<std::string> words_of(const std::string& line) {
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
    if (c == '\'') {
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
    const std::string name = word.substr(0, word.find('='));
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
