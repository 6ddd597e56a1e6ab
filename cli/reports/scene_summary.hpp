#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "ensemble/analysis/table.hpp"

namespace jostle::inline cli {

/// The results in words of the tables that a scene requests: one line per analysis and sweep point,
/// one line for all parts of structure.
class SceneSummary {
 public:
  void add(const Table& table);
  /// Lines of at most `width` characters; empty without tables.
  std::string text(std::size_t width) const;

 private:
  struct Line {
    std::string analysis, point, verdict;
  };
  std::vector<Line> lines_;
  std::vector<std::string> parts_;  // parts of structure, each once
};

}  // namespace jostle::inline cli
