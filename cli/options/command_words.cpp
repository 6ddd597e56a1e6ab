#include "cli/options/command_words.hpp"

#include <algorithm>

namespace jostle::inline cli {
namespace {

std::vector<std::string>::iterator end_of_options(std::vector<std::string>& words) {
  return std::ranges::find(words, "--");
}

bool reads_as_list(const std::string& word) {
  return word.size() > 1 && word.front() == '[' && word.back() == ']';
}

}  // namespace

std::string operand(const std::string& path) {
  return path.starts_with('-') || reads_as_list(path) ? "./" + path : path;
}

void add_flag(std::vector<std::string>& words, const std::string& flag) {
  const auto end = end_of_options(words);
  if (std::find(words.begin(), end, flag) == end) words.insert(end, flag);
}

void remove_flag(std::vector<std::string>& words, const std::string& flag) {
  words.erase(std::remove(words.begin(), end_of_options(words), flag), end_of_options(words));
}

std::vector<std::string> without_operand_mark(std::vector<std::string> words,
                                              const std::vector<std::string>& subcommands) {
  const auto mark = end_of_options(words);
  if (subcommands.empty() || mark == words.end()) return words;
  auto word = words.erase(mark);
  if (word == words.end()) return words;
  *word = operand(*word);  // a file, even if a subcommand has its name
  for (++word; word != words.end() && std::ranges::find(subcommands, *word) == subcommands.end();
       ++word)
    *word = operand(*word);
  return words;
}

}  // namespace jostle::inline cli
