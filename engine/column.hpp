#pragma once

#include <string>

namespace jostle::inline engine {

/// How a report of taps shows what an ensemble has in a column.
enum class Shown {
  spread,  // mean, its error and sigma, a line a tap
  mean,    // the mean alone, a line a tap
  count,   // 1 where something happened, else 0: in one sentence, how often it did
  share,   // a fraction: in one sentence, its mean over the taps that have any
  stored,  // in the file alone
};

/// Whose bed is measured: names and units of a column depend on it.
enum class Spheres { equal, several_sizes };

/// A number that is recorded at every tap: how it is stored, and how a report shows it.
struct Column {
  std::string name;       // also in scenes; one word of a path
  std::string units;      // "1" where there is none
  std::string long_name;  // a sentence
  std::string source;     // paper, or "jostle"
  Shown shown = Shown::spread;
  int decimals = 4;       // decimals of a mean (Shown::mean)
  std::string if_any{};   // the sentence, with {} for "3 of 60" taps or for "1.5 %"
  std::string if_none{};  // the sentence where there is none; may be empty
  bool operator==(const Column&) const = default;
};

}  // namespace jostle::inline engine
