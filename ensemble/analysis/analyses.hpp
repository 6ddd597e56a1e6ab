#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/fields.hpp"
#include "engine/taps.hpp"
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

/// The last taps of a run, or of a stage, that an analysis looks at.
template <class Settings>
constexpr auto last_taps(std::uint64_t least, std::string_view text) {
  return field("last", &Settings::last, Whole{least, most_taps}, text);
}
/// The swept value that is drawn against.
template <class Settings>
constexpr auto drawn_against() {
  return field("against", &Settings::against, Text{},
               "JSON pointer; absent: the first of the sweep", {.unless_default = true});
}

/// How a steady state is judged: by its last taps.
struct SteadySettings {
  /// At least SteadyStateTest::fewest_taps; absent: the last quarter of a run.
  std::optional<std::uint64_t> last = std::nullopt;
  bool operator==(const SteadySettings&) const = default;

  static constexpr Description description{
      "steady", "Value, fluctuation and memory of the last taps, and whether they are steady"};
  template <class Self = SteadySettings>
  static constexpr auto fields() {
    return std::tuple{last_taps<SteadySettings>(SteadyStateTest::fewest_taps,
                                                "Taps at the end; absent: a quarter of all")};
  }
};

/// The fewest taps that a spectrum is estimated from.
inline constexpr std::uint64_t fewest_spectrum_taps = 32;
inline constexpr std::uint64_t shortest_spectrum_segment = 16;

/// How a spectrum is estimated, of the last taps.
struct SpectrumSettings {
  std::optional<std::uint64_t> last = std::nullopt;     // absent: the last half of a run
  std::optional<std::uint64_t> segment = std::nullopt;  // absent: about a quarter of `last`
  Taper window = Taper::hann;
  Detrending detrending = Detrending::mean;
  /// Band of the slope, in 1/taps; absent: from the first unbiased line to 1/2.
  std::optional<Band> band = std::nullopt;
  bool operator==(const SpectrumSettings&) const = default;

  static constexpr Description description{"spectrum",
                                           "Power spectrum of the last taps and its log-log slope"};
  template <class Self = SpectrumSettings>
  static constexpr auto fields() {
    return std::tuple{
        last_taps<SpectrumSettings>(fewest_spectrum_taps, "Taps at the end; absent: half of all"),
        field("segment", &Self::segment, Whole{shortest_spectrum_segment, most_taps},
              "Taps of a segment of Welch's average; absent: about a quarter of them"),
        field("window", &Self::window, word(taper_names)),
        field("detrend", &Self::detrending, word(detrending_names),
              "Function that is subtracted from every segment"),
        field("band", &Self::band, Band::form,
              "Lowest and highest frequency of the slope, in 1/taps; absent: all that are sound",
              {.examples = "[[0.001, 0.1]]"})};
  }
};

/// At which pairs of taps ageing is measured; empty: as ageing_grid() has them.
struct AgeingSettings {
  std::vector<std::uint64_t> waiting_times, lags;  // ascending; lags at least 1
  bool operator==(const AgeingSettings&) const = default;

  static constexpr Description description{
      "ageing", "A(t, t_W), V and C with errors, fits of eq. 6, tests of a collapse of all ages"};
  template <class Self = AgeingSettings>
  static constexpr auto fields() {
    return std::tuple{
        field("waiting_times", &Self::waiting_times, TapNumbers{},
              "Ages t_W; none: 0 and two per decade, up to a tenth of the taps"),
        field("lags", &Self::lags, TapNumbers{}, "t, each at least 1; none: ten per decade")};
  }
};

/// How the steps of a protocol are judged: each by its last taps.
struct HysteresisSettings {
  std::optional<std::uint64_t> last = std::nullopt;  // absent: a quarter of the shortest stage
  bool operator==(const HysteresisSettings&) const = default;

  static constexpr Description description{
      "hysteresis", "Steady value of every stage of the protocol, branches, areas of loops"};
  template <class Self = HysteresisSettings>
  static constexpr auto fields() {
    return std::tuple{last_taps<HysteresisSettings>(
        1, "Taps at the end of each stage; absent: a quarter of the shortest")};
  }
};

/// When a realization counts as ordered, and what of the end of a run it is compared with.
struct OrderingSettings {
  double threshold = 0;
  std::uint64_t hold = 10;  // taps running at or above the threshold
  std::string equilibrium;  // observable whose last taps are compared; empty: the same
  std::optional<std::uint64_t> last =
      std::nullopt;  // number of last taps; absent: the last quarter
  bool operator==(const OrderingSettings&) const = default;

  static constexpr Description description{
      "ordering",
      "Time to order, its distribution over realizations, growth; over a "
      "sweep which point orders first, and which ends highest"};
  template <class Self = OrderingSettings>
  static constexpr auto fields() {
    return std::tuple{
        field("threshold", &Self::threshold, Number{closed_range(-1e9, 1e9)},
              "The value from which a packing counts as ordered, in units of the observable",
              {.required = "the value of the observable at which a packing counts as ordered"}),
        field("hold", &Self::hold, Whole{1, most_taps},
              "Consecutive taps at which the observable must be at or above the threshold"),
        field("equilibrium", &Self::equilibrium, Text{},
              "The observable whose last taps are compared over a sweep; absent: the analysed one",
              {.unless_default = true}),
        last_taps<OrderingSettings>(1, "Taps at the end that are compared; absent: a quarter")};
  }
};

/// Quantities that are drawn against a swept value.
struct SweepSettings {
  /// "value": the mean of the last taps; else what another analysis ("steady/sigma") or a fit
  /// ("kww/rho_inf") of the same observable found.
  std::string quantity = "value";
  std::optional<std::uint64_t> last =
      std::nullopt;     // number of last taps of "value"; absent: the last quarter
  std::string against;  // JSON pointer; empty: the first of the sweep
  /// The point, on the axis as drawn, that all others are compared with; absent: neighbours.
  std::optional<double> reference = std::nullopt;
  bool operator==(const SweepSettings&) const = default;

  static constexpr Description description{
      "sweep",
      "A quantity against the swept value, its extrema, its straight "
      "line, differences between its points"};
  template <class Self = SweepSettings>
  static constexpr auto fields() {
    return std::tuple{
        field("quantity", &Self::quantity, Text{},
              "value: the mean of the last taps; or a result of another analysis or fit that the "
              "scene requests",
              {.examples = R"(["value", "steady/sigma", "kww/rho_inf"])"}),
        last_taps<SweepSettings>(1, "Taps at the end; absent: a quarter of all"),
        drawn_against<SweepSettings>(),
        field("reference", &Self::reference, Number{closed_range(-1e9, 1e9)},
              "Point on the axis as drawn that all others are compared with; absent: neighbours")};
  }
};

/// Volumes and compactivities over the points of a sweep.
struct VolumesSettings {
  std::optional<std::uint64_t> last = std::nullopt;  // absent: the last quarter
  std::string against;                               // see sweeps
  /// Spheres of the volume; absent: those of the observable's window.
  std::optional<double> spheres = std::nullopt;
  bool operator==(const VolumesSettings&) const = default;

  static constexpr Description description{
      "volumes", "Variance of steady states over strengths, compactivity by two estimators"};
  template <class Self = VolumesSettings>
  static constexpr auto fields() {
    return std::tuple{last_taps<VolumesSettings>(
                          SteadyStateTest::fewest_taps,
                          "Taps at the end; absent: a quarter of all, or of the shortest stage"),
                      drawn_against<VolumesSettings>(),
                      field("spheres", &Self::spheres, Number{left_open_range(0, 1e9)},
                            "Number of spheres in the volume; absent: those of the observable's "
                            "window")};
  }
};

/// At which lags after the last stage has begun histories are compared.
struct MemorySettings {
  std::vector<std::uint64_t> lags;  // last ones of windows, ascending, at least 1; empty: all
  bool operator==(const MemorySettings&) const = default;

  static constexpr Description description{
      "memory",
      "A test of whether the evolution after a common value depends on how it was reached: "
      "the last stage is common to the sweep points"};
  template <class Self = MemorySettings>
  static constexpr auto fields() {
    return std::tuple{
        field("lags", &Self::lags, TapNumbers{},
              "Last ones of windows after the switch, each at least 1; none: 1, 3, 10, 30, ...")};
  }
};

/// With half-overlapping segments for Hann, others end to end. A segment that is not given is the
/// longest fast one of at most a quarter of the taps, at least 16. n_taps >= fewest_spectrum_taps;
/// a given segment is in 16 .. n_taps.
SpectrumOptions spectrum_options(const SpectrumSettings& settings, std::uint64_t n_taps);

class SpectrumAnalysis {
 public:
  SpectrumAnalysis(const AnalysedSeries& series, const SpectrumSettings& settings);

  void add(std::span<const double> values);  // [n_taps]
  /// After at least one realization: frequency; density, its error, lines a bin; the slope, its
  /// error; the trend. The note "drift" reports if a drift imitates low frequencies,
  /// "verdict" how the slope compares with that of an AR(1) process of the same memory.
  Table table() const;

 private:
  AnalysedSeries series_;
  SpectrumSettings settings_;
  SpectrumOptions options_;
  SpectrumAverage average_;
  TrendTest trend_;
};

/// Begins the description of a quantity of a steady state that is only known to be at least its
/// value.
inline const std::string lower_bound = "lower bound";

/// Value, deviation, autocorrelation time, each with its error; the blocking levels; trend and
/// halves. Note "verdict" begins with "reached", "not reached" or "cannot decide", with the reason.
Table steady_table(const AnalysedSeries& series, const SteadyState& state);

}  // namespace jostle::inline ensemble
