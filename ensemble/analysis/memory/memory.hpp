#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "ensemble/analysis/table.hpp"
#include "ensemble/statistics/student_tests.hpp"
#include "structure/observables.hpp"

// Tests if the packing fraction alone is the state: one value reached in several ways, then one
// common way of tapping (Josserand, Tkachenko, Mueth & Jaeger 2000,
// doi:10.1103/PhysRevLett.85.3632). If it is, what comes after does not depend on the way.
namespace jostle::inline ensemble {

/// Lags after the switch, first .. last, both included, whose mean is one value.
struct LagWindow {
  std::uint64_t first = 1, last = 1;
};

/// 1, 2 to 3, 4 to 10, 11 to 30, ...: two windows per decade of lags, up to the last, which may end
/// within one. last >= 1.
std::vector<LagWindow> lag_windows(std::uint64_t last);
/// Like the function above, with windows that end at these lags, ascending, at least 1.
std::vector<LagWindow> lag_windows(std::span<const std::uint64_t> ends);

/// One way of reaching the common value.
struct History {
  double strength = 0;            // strength of the last taps before the switch
  std::uint64_t switch_tap = 0;   // the last of them
  std::vector<double> at_switch;  // [realizations]
  std::vector<double> responses;  // [n_windows, realizations]
};

/// Difference of two histories after the switch, at equal values at the switch.
struct AlignedDifference {
  std::size_t first = 0, second = 0, window = 0;  // histories, window of lags
  /// At equal value at the switch: the intercept of the straight line through the differences of
  /// the responses against those at the switch, realization by realization; second less first.
  double value = 0;
  ErrorOf error{};  // error of that line, M - 2 degrees of freedom; none below three realizations
  double p = 1,
         corrected = 1;   // p-value for no difference: by itself, and for all together (Holm 1979)
  double detectable = 0;  // difference that would have been found with probability 0.8
};

struct MemoryTest {
  std::vector<LagWindow> windows;
  std::vector<AlignedDifference> differences;  // pairs of histories, each with all windows
  double response = 0;  // largest mean change after the switch, of any history and window
  std::size_t realizations = 0;
  std::vector<double> strengths{};  // [n_histories], before the switch

  static constexpr double level = 0.05;  // false alarms, all tests together
  /// The difference that is detected with probability 0.8 in every window and between all
  /// histories.
  double detectable() const;
  /// "phi alone is not the state", "no memory found" or "cannot decide", with test and power;
  /// `units`: of the observable, "1" for a plain number; `control`: what the strengths of the
  /// histories are, which it names them by. Lags are in taps.
  std::string statement(const std::string& observable, const std::string& units,
                        const std::string& control) const;

 private:
  /// Its strength, and its number where others have the same.
  std::string name_of(std::size_t history) const;
};

/// Histories of the same realizations, at least two.
MemoryTest memory_test(std::span<const History> histories, std::vector<LagWindow> windows);

/// Values at the switch, responses and differences with their errors; note "verdict".
Table memory_table(std::string name, const Column& observable, const std::string& control,
                   const std::string& units, std::span<const History> histories,
                   const MemoryTest& test);

}  // namespace jostle::inline ensemble
