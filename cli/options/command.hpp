#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

// How a command describes its options. The parser's own headers take seconds of every source that
// sees them: only the sources of this folder do.
namespace jostle::inline cli {

/// The group of options that the help does not show. A parser's message names them.
inline constexpr const char* hidden_group = "hidden";

/// Thrown by the reader of Command::add_reader: the fault of the text, without the option's name.
class BadValue : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One option of a command, or a word without a name. A handle: the command owns it.
class Option {
 public:
  explicit Option(CLI::Option& option) : option_(&option) {}

  Option& required();
  Option& environment(const std::string& variable);
  Option& separated_by(char character);
  Option& excludes(const Option& option);
  Option& needs(const Option& option);

  Option& limit(int least, int most);
  Option& whole_from(std::uint64_t least);
  Option& positive_number();
  Option& one_of(const std::vector<std::string>& words);
  /// A file's name: neither empty nor "-", which stands for no stream here.
  Option& file_name();
  Option& file_to_write();
  /// `fault` describes the fault of a text; nothing if it is valid. `type` is shown in the help.
  Option& check(std::function<std::string(const std::string& text)> fault, const std::string& type);

  /// Values that completion offers; others are accepted, too.
  Option& offers(const std::vector<std::string>& words);
  /// Names of files with one of these suffixes, "h5"; of any file, if there are none.
  Option& offers_files(const std::vector<std::string>& suffixes);

  /// How often it was given.
  std::size_t count() const;

 private:
  CLI::Option* option_;
};

/// A command, or the program as the one that all others belong to. A handle, as Option.
class Command {
 public:
  explicit Command(CLI::App& app) : app_(&app) {}

  Command add_command(const std::string& name, const std::string& description);

  /// `value` keeps what it holds where the option is not given, and must outlive the parsing. T:
  /// std::string, int, std::uint32_t, std::uint64_t, double, std::optional<double>, and vectors of
  /// std::string and std::uint64_t.
  template <class T>
  Option add_option(const std::string& name, T& value, const std::string& description);
  /// Not in the help, and listed by hidden_options_given().
  template <class T>
  Option add_hidden_option(const std::string& name, T& value);
  Option add_flag(const std::string& name, bool& value, const std::string& description);
  Option add_flag(const std::string& name, std::function<void()> if_given,
                  const std::string& description);
  /// `read` is given the option's text, and throws BadValue.
  Option add_reader(const std::string& name, std::function<void(const std::string& text)> read,
                    const std::string& description);
  /// --threads, also JOSTLE_THREADS; 0: the CPUs that the process may use.
  void add_threads(int& threads, const std::string& description =
                                     "Threads (default: the CPUs this process may "
                                     "use)");

  void footer(const std::string& text);
  /// `act` is called once the command line has been read, if it names this command.
  void run(std::function<void()> act);
  void require_command();
  /// Options that the command does not know are looked for in the one it belongs to.
  void fall_through();

  std::string name() const;
  bool has_option(const std::string& name) const;
  /// How often an option was given that there is.
  std::size_t count(const std::string& option) const;
  /// Names of hidden options that were given, as "--last".
  std::vector<std::string> hidden_options_given() const;

 private:
  CLI::App* app_;
};

}  // namespace jostle::inline cli
