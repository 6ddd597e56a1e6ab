#include "cli/options/command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <optional>
#include <sstream>
#include <type_traits>
#include <utility>

#include "cli/options/command_text.hpp"
#include "study/number_text.hpp"

namespace jostle::inline cli {

namespace {

/// The parser's own checks wrap negative numbers, and print ranges in 309 digits.
std::string whole_number_fault(const std::string& text, std::uint64_t least) {
  const auto number = read_whole_number(text);
  if (number && *number >= least) return {};
  return fmt::format("{} is not a whole number from {} on", text, least);
}

std::string positive_number_fault(const std::string& text) {
  const auto number = read_number(text);
  if (number && *number > 0) return {};
  return fmt::format("{} is not a number above 0", text);
}

/// The parser itself takes hexadecimal and octal numbers, "inf" and "nan". Its checks may change
/// the text: whole numbers lose leading zeros, which it would take for octal.
template <class T>
std::string require_plain_number(std::string& text) {
  if constexpr (std::is_floating_point_v<T>) {
    return read_number(text) ? "" : fmt::format("{} is not a number like 12, -0.5 or 1e-3", text);
  } else {
    const bool is_negative = std::is_signed_v<T> && text.starts_with('-');
    const std::string digits = text.substr(is_negative ? 1 : 0);
    const auto number = read_whole_number(digits);
    if (!number) {
      return fmt::format("{} is not a whole number{}", text,
                         !std::is_signed_v<T> && text.starts_with('-') ? " from 0 on" : "");
    }
    text = fmt::format("{}{}", is_negative ? "-" : "", *number);
    return {};
  }
}

/// The number that an option holds, once or several times; void where it holds none.
template <class T>
struct NumberOf {
  using type = std::conditional_t<std::is_arithmetic_v<T>, T, void>;
};
template <class T>
struct NumberOf<std::optional<T>> : NumberOf<T> {};
template <class T>
struct NumberOf<std::vector<T>> : NumberOf<T> {};

template <class T>
CLI::Option& with_plain_numbers(CLI::Option& option) {
  using Number = typename NumberOf<T>::type;
  if constexpr (!std::is_void_v<Number>) {
    option.transform(CLI::Validator(require_plain_number<Number>, "", ""));
  }
  return option;
}

std::string file_name_fault(const std::string& text) {
  if (!text.empty() && text != "-") return {};
  return fmt::format("\"{}\" is no file's name", text);
}

/// An option takes one value each time it is given: with_separate_values() repeats it.
template <class T>
CLI::Option& with_single_values(CLI::Option& option) {
  if (option.nonpositional() && option.get_items_expected_max() > 1) option.allow_extra_args(false);
  return with_plain_numbers<T>(option);
}

// The parser has no place for what is offered: it is kept as the name of a check that finds no
// fault. A later one counts.
void note_offer(CLI::Option& option, const char* kind, const std::vector<std::string>& texts) {
  std::string name = kind;
  for (const std::string& text : texts) name += " " + text;
  option.check(CLI::Validator([](std::string&) { return std::string(); }, "", name));
}

/// Paragraphs as one line each, for a screen of any width; examples, which are indented, as they
/// are.
std::string filled(const std::string& text) {
  std::string all, line, previous;
  for (std::istringstream lines(text); std::getline(lines, line); previous = line) {
    const auto of_paragraph = [](const std::string& line_text) {
      return !line_text.empty() && line_text.front() != ' ' && !line_text.ends_with(':');
    };
    if (!all.empty()) all += of_paragraph(previous) && of_paragraph(line) ? ' ' : '\n';
    all += line;
  }
  return all;
}

}  // namespace

Option& Option::required() {
  option_->required();
  return *this;
}

Option& Option::environment(const std::string& variable) {
  option_->envname(variable);
  return *this;
}

Option& Option::separated_by(char character) {
  option_->delimiter(character);
  return *this;
}

Option& Option::excludes(const Option& option) {
  option_->excludes(option.option_);
  return *this;
}

Option& Option::needs(const Option& option) {
  option_->needs(option.option_);
  return *this;
}

Option& Option::limit(int least, int most) {
  option_->check(CLI::Range(least, most));
  return *this;
}

Option& Option::whole_from(std::uint64_t least) {
  return check([least](const std::string& text) { return whole_number_fault(text, least); }, "");
}

Option& Option::positive_number() {
  return check(positive_number_fault, "");
}

Option& Option::one_of(const std::vector<std::string>& words) {
  option_->check(CLI::IsMember(words));
  return offers(words);
}

Option& Option::file_name() {
  return check(file_name_fault, "");
}

Option& Option::file_to_write() {
  file_name();
  return offers_files({});
}

Option& Option::check(std::function<std::string(const std::string& text)> fault,
                      const std::string& type) {
  option_->check(CLI::Validator(std::move(fault), type));
  return *this;
}

Option& Option::offers(const std::vector<std::string>& words) {
  note_offer(*option_, words_offered, words);
  return *this;
}

Option& Option::offers_files(const std::vector<std::string>& suffixes) {
  note_offer(*option_, files_offered, suffixes);
  return *this;
}

std::size_t Option::count() const {
  return option_->count();
}

Command Command::add_command(const std::string& name, const std::string& description) {
  return Command(*app_->add_subcommand(name, description));
}

template <class T>
Option Command::add_option(const std::string& name, T& value, const std::string& description) {
  return Option(with_single_values<T>(*app_->add_option(name, value, description)));
}

template <class T>
Option Command::add_hidden_option(const std::string& name, T& value) {
  return Option(with_single_values<T>(*app_->add_option(name, value)->group(hidden_group)));
}

#define JOSTLE_OPTION_OF(T)                                                        \
  template Option Command::add_option(const std::string&, T&, const std::string&); \
  template Option Command::add_hidden_option(const std::string&, T&)
JOSTLE_OPTION_OF(std::string);
JOSTLE_OPTION_OF(int);
JOSTLE_OPTION_OF(std::uint32_t);
JOSTLE_OPTION_OF(std::uint64_t);
JOSTLE_OPTION_OF(double);
JOSTLE_OPTION_OF(std::optional<double>);
JOSTLE_OPTION_OF(std::vector<std::string>);
JOSTLE_OPTION_OF(std::vector<std::uint64_t>);
#undef JOSTLE_OPTION_OF

Option Command::add_flag(const std::string& name, bool& value, const std::string& description) {
  return Option(*app_->add_flag(name, value, description));
}

Option Command::add_flag(const std::string& name, std::function<void()> if_given,
                         const std::string& description) {
  return Option(*app_->add_flag_callback(name, std::move(if_given), description));
}

Option Command::add_reader(const std::string& name,
                           std::function<void(const std::string& text)> read,
                           const std::string& description) {
  const std::function<void(const std::string&)> parse =
      [name, read = std::move(read)](const std::string& text) {
        try {
          read(text);
        } catch (const BadValue& fault) {
          throw CLI::ValidationError(name, fault.what());
        }
      };
  return Option(*app_->add_option_function(name, parse, description));
}

void Command::add_threads(int& threads, const std::string& description) {
  add_option("--threads", threads, description).limit(1, 4096).environment("JOSTLE_THREADS");
}

void Command::footer(const std::string& text) {
  app_->footer(filled(text));
}

void Command::run(std::function<void()> act) {
  app_->callback(std::move(act));
}

void Command::require_command() {
  app_->require_subcommand(1);
}

void Command::fall_through() {
  app_->fallthrough();
}

std::string Command::name() const {
  return app_->get_name();
}

bool Command::has_option(const std::string& name) const {
  return app_->get_option_no_throw(name) != nullptr;
}

std::size_t Command::count(const std::string& option) const {
  return app_->count(option);
}

std::vector<std::string> Command::hidden_options_given() const {
  std::vector<std::string> names;
  for (const CLI::Option* option : std::as_const(*app_).get_options())
    if (option->count() > 0 && option->get_group() == hidden_group)
      names.push_back("--" + option->get_single_name());
  return names;
}

}  // namespace jostle::inline cli
