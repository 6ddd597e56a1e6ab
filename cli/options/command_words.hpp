#pragma once

#include <string>
#include <vector>

#include "cli/options/command_text.hpp"

// Command lines that are printed for a person to run: what a word means must not depend on how the
// files are called. Words behind "--" are operands, whatever they begin with.
namespace jostle::inline cli {

/// A file's name as an operand: "./-x.h5" of "-x.h5", which is an option by itself, and "./[x]" of
/// "[x]", which the parser takes for a list. Other names as they are.
std::string operand(const std::string& path);

/// Adds a flag before the operands that follow "--", or at the end; once.
void add_flag(std::vector<std::string>& words, const std::string& flag);

/// Removes a flag, but no operand behind "--".
void remove_flag(std::vector<std::string>& words, const std::string& flag);

/// The words of a command line in which "--" and all that it changes is written without it: what
/// follows it up to the name of a subcommand is operands. `subcommands`: of the command `words[0]`.
std::vector<std::string> without_operand_mark(std::vector<std::string> words,
                                              const std::vector<std::string>& subcommands);

/// A command line in which every value of an option that takes several has the option's name before
/// it: "--part a b x.h5" becomes "--part a --part b x.h5".
struct SeparateValues {
  std::vector<std::string> words;
  std::string long_list;  // "--part a b", if words without commas follow it before any file
};
/// A list ends at an option, a subcommand or a file: a word with a suffix that the command offers
/// for its files. Before any file is given, the last word is one, and so is an existing file that
/// is no value the option offers, unless a word with such a suffix follows in the list of a command
/// of one file. Words behind "--" are files up to a subcommand. `words[0]` is the name of
/// `command`.
SeparateValues with_separate_values(const std::vector<std::string>& words,
                                    const CommandText& command);

}  // namespace jostle::inline cli
