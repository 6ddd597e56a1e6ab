#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace jostle::inline ensemble {

/// Series cut into blocks of one length, whose means are taken for independent.
struct BlockingLevel {
  std::size_t block_length = 1;  // taps, a power of two
  std::size_t n_blocks = 0;      // n blocks of all realizations
  double variance = 0;           // variance of block means about their realization's mean
  double error = 0;              // error of the mean of everything
  double error_error = 0;        // its own standard error, for independent Gaussian blocks
};

struct BlockingResult {
  std::vector<BlockingLevel> levels;
  /// The first level with long enough blocks; none where the series are too short: then
  /// every error of `levels` is a lower bound.
  std::optional<std::size_t> plateau;

  /// At the plateau; without one the largest of the levels, which is a lower bound. NaN for series
  /// of fewer than two values.
  double error() const;
};

/// The error of a mean of correlated values by blocking: Flyvbjerg and Petersen 1989,
/// doi:10.1063/1.457480. One series after another, all of one length; those of several realizations
/// are pooled, each about its own mean. The plateau is the first level whose blocks of B taps
/// satisfy B^3 > 2 N (error / error of single taps)^4, N the number of all values (Lee et al. 2011,
/// doi:10.1103/PhysRevE.83.066706), and that has at least 8 blocks.
class Blocking {
 public:
  void add(std::span<const double> series);
  BlockingResult result() const;

 private:
  struct Pool {
    std::size_t n_blocks = 0;  // n blocks of one realization
    double squares = 0;
  };
  std::size_t n_ = 0, realizations_ = 0;
  std::vector<Pool> pools_;  // by level
};

}  // namespace jostle::inline ensemble
