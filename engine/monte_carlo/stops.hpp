#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "engine/bed/container.hpp"
#include "engine/bed/window.hpp"
#include "engine/fields.hpp"
#include "engine/monte_carlo/moves.hpp"

// When the relaxation after a tap ends. A sweep is n_spheres trials.
namespace jostle::inline engine {

/// Sweeps that a rule or a cap may name, at most.
inline constexpr std::uint64_t most_sweeps = 1'000'000'000;

/// Stop when |Z' - Z| / Z < eta between two tests, `every_sweeps` apart; Z is the mean height, and
/// in a mixture that of every kind as well. The first value is taken right after the tap. Philippe
/// & Bideau 2001, sec. II, which publishes neither eta nor the interval.
struct MeanHeightStop {
  double eta = 1e-5;
  std::uint64_t every_sweeps = 100;
  bool operator==(const MeanHeightStop&) const = default;

  static constexpr Description description{
      "mean_height",
      "The mean height changed by less than eta, relatively, or by less than change, in diameters, "
      "between two tests. Not both"};
  template <class Self = MeanHeightStop>
  static constexpr auto fields() {
    return std::tuple{
        field("eta", &Self::eta, Number{open_range(0, 1)}, "Relative change of the mean height"),
        field("every_sweeps", &Self::every_sweeps, Whole{1, most_sweeps},
              "Sweeps between two tests")};
  }
};

/// Stop when |Z' - Z| < `change` diameters between two tests: MeanHeightStop with eta <Z> fixed for
/// beds of every depth, and in a mixture for every kind. The first value is taken right after the
/// tap. Ours.
struct HeightChangeStop {
  double change = 1e-4;  // diameters
  std::uint64_t every_sweeps = 100;
  bool operator==(const HeightChangeStop&) const = default;

  static constexpr Description description{
      "mean_height"};  // a key distinguishes it from MeanHeightStop
  template <class Self = HeightChangeStop>
  static constexpr auto fields() {
    return std::tuple{field("change", &Self::change, Number{left_open_range(0, 1)},
                            "Absolute change, diameters: the same for beds of every depth",
                            {.required = "the change of the mean height"}),
                      field("every_sweeps", &Self::every_sweeps, Whole{1, most_sweeps},
                            "Sweeps between two tests")};
  }
};

/// Stop when the packing fraction in `window` changes by at most `change` between two measurements
/// `every_trials` apart, `times` times in a row. Rosato et al. 2010, sec. II: change = 0.001,
/// 1e6 trials, twice. It can stop a bed in mid-air.
struct BulkFractionStop {
  double change = 1e-3;
  std::uint64_t every_trials = 1'000'000;
  std::uint32_t times = 2;
  bool measure_start = true;  // true if the state right after the tap counts as a measurement
  Window window = QuantileWindow{};
  bool operator==(const BulkFractionStop&) const = default;

  static constexpr Description description{
      "bulk_fraction",
      "The packing fraction of a window changed by at most change, several times in a row (Rosato "
      "et al. 2010). Can stop a bed in mid-air"};
  template <class Self = BulkFractionStop>
  static constexpr auto fields() {
    return std::tuple{
        field("change", &Self::change, Number{closed_range(0, 1)},
              "Change of the packing fraction between two measurements, at most"),
        field("every_trials", &Self::every_trials, Whole{1, most_trials},
              "Trials between two measurements"),
        field("times", &Self::times, Whole{1, 1000},
              "Successive measurements that must change so little"),
        field("measure_start", &Self::measure_start, Flag{},
              "The state right after the tap counts as a measurement"),
        field("window", &Self::window, OneOf<Window>{},
              "Heights between which the packing fraction is measured", {.title = "Window"})};
  }
};

/// Stop after a fixed number of sweeps.
struct SweepsStop {
  std::uint64_t sweeps = 1000;
  bool operator==(const SweepsStop&) const = default;

  static constexpr Description description{"sweeps", "A fixed number of sweeps"};
  template <class Self = SweepsStop>
  static constexpr auto fields() {
    return std::tuple{field("", &Self::sweeps, Whole{1, most_sweeps})};
  }
};

using StopRule = std::variant<MeanHeightStop, BulkFractionStop, SweepsStop, HeightChangeStop>;

/// A rule and the cap that ends a relaxation which never meets it. A capped relaxation is reported.
struct Stop {
  StopRule rule = MeanHeightStop{};
  std::uint64_t max_sweeps = 1'000'000;
  bool operator==(const Stop&) const = default;

  template <class Self = Stop>
  static constexpr auto fields() {
    return std::tuple{
        field("stop", &Self::rule, OneOf<StopRule>{}, "When a relaxation ends",
              {.title = "Stop rule"}),
        field("max_sweeps", &Self::max_sweeps, Whole{1, most_sweeps},
              "Ends a relaxation that never meets its rule; such relaxations are counted and "
              "reported",
              {.title = "Cap"})};
  }
};

/// Why a relaxation in the container cannot end by the rule; nothing if it can. Without gravity
/// nothing comes to rest, so only a number of sweeps ends one.
std::optional<std::string> stop_fault(const StopRule& rule, const Container& container);

/// Why the cap ends every relaxation before the rule does; nothing if it need not.
std::optional<std::string> cap_fault(const Stop& stop);

}  // namespace jostle::inline engine
