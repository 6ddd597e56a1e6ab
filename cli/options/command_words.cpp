#include "cli/options/command_words.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <system_error>
#include <utility>

namespace jostle::inline cli {
namespace {

std::vector<std::string>::iterator end_of_options(std::vector<std::string>& words) {
  return std::ranges::find(words, "--");
}

bool reads_as_list(const std::string& word) {
  return word.size() > 1 && word.front() == '[' && word.back() == ']';
}

const OptionText* option_named(const CommandText& command, const std::string& name) {
  for (const OptionText& option : command.options)
    if (std::ranges::find(option.names, name) != option.names.end()) return &option;
  for (const CommandText& subcommand : command.commands)
    if (const OptionText* option = option_named(subcommand, name)) return option;
  return nullptr;
}

bool reads_as_option(const std::string& word) {
  return word.size() > 1 && word.front() == '-' &&
         std::isdigit(static_cast<unsigned char>(word[1])) == 0;
}

/// One pass over the words of a command line.
class ValueSeparation {
 public:
  ValueSeparation(const std::vector<std::string>& words, const CommandText& command)
      : words_(words), command_(command) {}

  SeparateValues operator()() {
    while (next_ < words_.size() && words_[next_] != "--") take_word();
    take_operands();
    while (next_ < words_.size()) take_word();
    return std::move(found_);
  }

 private:
  /// From "--" to the subcommand behind the files; the word behind "--" is a file, whatever it is.
  void take_operands() {
    const std::size_t first_file = next_ + 1;
    for (; next_ < words_.size() && (next_ <= first_file || !ends_files(next_)); ++next_)
      found_.words.push_back(words_[next_]);
    has_file_ = has_file_ || next_ > first_file;
  }

  void take_word() {
    const std::string& word = words_[next_];
    found_.words.push_back(word);
    const auto equals = word.find('=');
    const OptionText* option = option_named(command_, word.substr(0, equals));
    if (option == nullptr) {
      const bool is_subcommand = ends_files(next_);
      has_subcommand_ = has_subcommand_ || is_subcommand;
      has_file_ = has_file_ || (next_ > 0 && !is_subcommand && !reads_as_option(word));
    }
    ++next_;
    if (option == nullptr || option->value.empty()) return;
    const bool has_value = equals != std::string::npos && equals + 1 < word.size();
    if (!has_value && next_ < words_.size()) found_.words.push_back(words_[next_++]);
    if (option->repeated) take_list(word.substr(0, equals), option->offer.words);
  }

  void take_list(const std::string& name, const std::vector<std::string>& offered) {
    std::string list = name + " " + found_.words.back();
    const std::size_t first = next_;
    for (; next_ < words_.size() && continues_list(offered); ++next_) {
      found_.words.insert(found_.words.end(), {name, words_[next_]});
      list += " " + words_[next_];
    }
    if (next_ > first && !has_file_) found_.long_list = list;
  }

  bool continues_list(const std::vector<std::string>& offered) const {
    const std::string& word = words_[next_];
    if (reads_as_option(word) || ends_files(next_) || has_suffix_of_file(word)) return false;
    if (has_file_) return true;
    if (next_ + 1 == words_.size() || ends_files(next_ + 1)) return false;
    std::error_code ignored;
    const bool is_value = std::ranges::find(offered, word) != offered.end() ||
                          (!takes_several_files() && has_file_behind());
    return is_value || !std::filesystem::is_regular_file(word, ignored);
  }

  bool has_suffix_of_file(const std::string& word) const {
    for (const OptionText& files : command_.positionals)
      for (const std::string& suffix : files.offer.suffixes)
        if (word.ends_with("." + suffix)) return true;
    return false;
  }

  bool takes_several_files() const {
    return std::ranges::any_of(command_.positionals, &OptionText::repeated);
  }

  /// A word with such a suffix ends this list.
  bool has_file_behind() const {
    for (std::size_t i = next_; i < words_.size() && !reads_as_option(words_[i]); ++i)
      if (has_suffix_of_file(words_[i])) return true;
    return false;
  }

  bool ends_files(std::size_t index) const {
    return !has_subcommand_ && std::ranges::find(command_.commands, words_[index],
                                                 &CommandText::name) != command_.commands.end();
  }

  const std::vector<std::string>& words_;
  const CommandText& command_;
  std::size_t next_ = 0;
  bool has_file_ = false, has_subcommand_ = false;
  SeparateValues found_;
};

}  // namespace

SeparateValues with_separate_values(const std::vector<std::string>& words,
                                    const CommandText& command) {
  return ValueSeparation(words, command)();
}

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
