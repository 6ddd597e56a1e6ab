#pragma once

#include <string>
#include <vector>

namespace jostle::inline cli {

/// A file's name, without a folder, and what is in it.
struct NamedText {
  std::string name, text;
};

/// Calls gnuplot for a script in a folder of its own among the temporary files, where `files` lie,
/// the script among them, and returns what it drew there: `wanted`, in this order. It reads no
/// settings of the user. Throws ResultsError where gnuplot is not installed, or fails.
std::vector<NamedText> run_gnuplot(const std::string& script, const std::vector<NamedText>& files,
                                   const std::vector<std::string>& wanted);

}  // namespace jostle::inline cli
