#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

// The command line as plain text, from which manual pages and completions are made.
namespace jostle::inline cli {

/// Values for completion.
struct Offer {
  std::vector<std::string> words = {};
  bool files = false;
  std::vector<std::string> suffixes = {};  // suffixes of those files, as "h5"; any, if empty
};

/// The parser has no place for offers: they are kept as the names of checks that find no fault, one
/// of these words, then what is offered, each after a blank.
inline constexpr const char* words_offered = "words";
inline constexpr const char* files_offered = "files";

struct OptionText {
  std::vector<std::string> names;  // "-o", "--output"; of a word without a name: what it is
  std::string value;               // placeholder of the value, "TEXT"; empty for a flag
  std::string description, environment;
  bool required = false, repeated = false;
  Offer offer;
};

struct CommandText {
  std::string name, description, footer;
  std::vector<OptionText> options;      // without hidden ones
  std::vector<OptionText> positionals;  // words without a name, in their order
  std::vector<CommandText> commands;
};

/// For a program with its description.
CommandText text_of(CLI::App& app);

}  // namespace jostle::inline cli
