#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ensemble/analysis/spectra/ensemble_spectrum.hpp"
#include "ensemble/analysis/steady_state.hpp"
#include "ensemble/analysis/table.hpp"

// The analyses of one observable at one sweep point as tables. Each takes the last taps of one
// realization after another, so that only one series is held at a time.
namespace jostle::inline ensemble {

/// The series under analysis.
struct AnalysedSeries {
  std::string observable, units;
  std::uint64_t first_tap = 0, last_tap = 0;  // both included
  std::uint64_t n_taps() const { return last_tap + 1 - first_tap; }
};

/// How a steady state is judged: by its last taps.
struct SteadySettings {
  /// At least SteadyStateTest::fewest_taps; absent: the last quarter of a run.
  std::optional<std::uint64_t> last = std::nullopt;
  bool operator==(const SteadySettings&) const = default;
};

/// How a spectrum is estimated, of the last taps.
struct SpectrumSettings {
  std::optional<std::uint64_t> last = std::nullopt;     // absent: the last half of a run
  std::optional<std::uint64_t> segment = std::nullopt;  // absent: about a quarter of `last`
  Taper window = Taper::hann;
  Detrending detrending = Detrending::mean;
  /// Of the slope, in 1/taps; absent: from the first sound line to 1/2.
  std::optional<Band> band = std::nullopt;
  bool operator==(const SpectrumSettings&) const = default;
};

/// At which pairs of taps ageing is measured; empty: as ageing_grid() has them.
struct AgeingSettings {
  std::vector<std::uint64_t> waiting_times, lags;  // ascending; lags at least 1
  bool operator==(const AgeingSettings&) const = default;
};

/// How the steps of a protocol are judged: each by its last taps.
struct HysteresisSettings {
  std::optional<std::uint64_t> last = std::nullopt;  // absent: a quarter of the shortest stage
  bool operator==(const HysteresisSettings&) const = default;
};

/// When a realization counts as ordered, and what of the end of a run it is compared with.
struct OrderingSettings {
  double threshold = 0;
  std::uint64_t hold = 10;  // taps running at or above the threshold
  std::string equilibrium;  // observable whose last taps are compared; empty: the same
  std::optional<std::uint64_t> last = std::nullopt;  // of these taps; absent: the last quarter
  bool operator==(const OrderingSettings&) const = default;
};

/// What is drawn against which swept value.
struct SweepSettings {
  /// "value": the mean of the last taps; else what another analysis ("steady/sigma") or a fit
  /// ("kww/rho_inf") of the same observable found.
  std::string quantity = "value";
  std::optional<std::uint64_t> last = std::nullopt;  // of "value"; absent: the last quarter
  std::string against;                               // JSON pointer; empty: the first of the sweep
  /// The point, on the axis as drawn, that all others are compared with; absent: neighbours.
  std::optional<double> reference = std::nullopt;
  bool operator==(const SweepSettings&) const = default;
};

/// What is drawn of volumes and compactivities, over the points of a sweep.
struct VolumesSettings {
  std::optional<std::uint64_t> last = std::nullopt;  // absent: the last quarter
  std::string against;                               // as for sweeps
  /// Whose volume it is; absent: those of the observable's window.
  std::optional<double> spheres = std::nullopt;
  bool operator==(const VolumesSettings&) const = default;
};

/// At which lags after the last stage has begun histories are compared.
struct MemorySettings {
  std::vector<std::uint64_t> lags;  // last ones of windows, ascending, at least 1; empty: all
  bool operator==(const MemorySettings&) const = default;
};

/// The fewest taps that a spectrum is estimated from.
inline constexpr std::uint64_t fewest_spectrum_taps = 32;

/// With half-overlapping segments for Hann, others end to end. A segment that is not given is the
/// longest fast one of at most a quarter of the taps, at least 16. n_taps >= fewest_spectrum_taps;
/// a given segment is in 16 .. n_taps.
SpectrumOptions spectrum_options(const SpectrumSettings& settings, std::uint64_t n_taps);

class SpectrumAnalysis {
 public:
  SpectrumAnalysis(const AnalysedSeries& series, const SpectrumSettings& settings);

  void add(std::span<const double> values);  // [n_taps]
  /// After at least one realization: frequency; density, its error, lines a bin; the slope, its
  /// error; the trend. Note "drift" says whether a drift fakes the low frequencies,
  /// "verdict" how the slope compares with that of an AR(1) process of the same memory.
  Table table() const;

 private:
  AnalysedSeries series_;
  SpectrumSettings settings_;
  SpectrumOptions options_;
  SpectrumAverage average_;
  TrendTest trend_;
};

/// Value, deviation, autocorrelation time, each with its error; the blocking levels; trend and
/// halves. Note "verdict" begins with "reached", "not reached" or "cannot decide", and says why.
Table steady_table(const AnalysedSeries& series, const SteadyState& state);

}  // namespace jostle::inline ensemble
