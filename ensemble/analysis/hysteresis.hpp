#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "ensemble/analysis/table.hpp"
#include "ensemble/protocol_steps.hpp"
#include "ensemble/statistics/student_tests.hpp"
#include "structure/observables.hpp"

namespace jostle::inline ensemble {

/// Indices of the steps of each branch: a new one begins where the strength turns, with the step at
/// the turn, which ends the branch before. Steps of equal strength stay together.
std::vector<std::vector<std::size_t>> branches(std::span<const double> strengths);

/// The distance of two branches: the integral of the later's value less the earlier's over the
/// strengths that both have, straight lines between steps.
struct Loop {
  std::size_t earlier = 0, later = 0;  // branches
  double lowest = 0, highest = 0;      // strengths
  double area = 0;                     // mean over realizations; NaN without any
  ErrorOf error{};                     // over realizations, Student's; none below two
  double p = 1, corrected = 1;   // p-value for no area: by itself, and for all loops (Holm 1979)
  double detectable = 0;         // area that would have been found with probability 0.8
  std::size_t realizations = 0;  // realizations with all steps of both branches

  static constexpr double level = significance_level;  // false alarms, all loops together
  /// "the branches differ", "the branches are equal in every realization" or "cannot decide", with
  /// the test and what would have refuted it; areas in these units.
  std::string statement(const std::string& units = "1") const;
};

/// For every branch and the next. values: [n_steps, n_realizations], NaN where there is none.
std::vector<Loop> loops(std::span<const double> strengths, std::span<const double> values,
                        std::uint32_t realizations);

/// The steady-state value of each step with its error over realizations, its branch, and the loops
/// between branches. values: [n_steps, n_realizations], means of the last taps of each step
/// (means_over_rows of the steps' windows), NaN where there is none.
Table hysteresis_table(std::string name, const Column& observable, const ProtocolSteps& steps,
                       std::span<const double> values, std::uint32_t realizations);

/// The values of the steps [n_steps, n_realizations] from a whole series [n_taps, n_realizations],
/// tap 0 first; NaN at steps that it does not reach.
std::vector<double> step_values(const ProtocolSteps& steps, std::span<const double> series,
                                std::uint32_t realizations);

}  // namespace jostle::inline ensemble
