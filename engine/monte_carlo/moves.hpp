#pragma once

#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "engine/bed/container.hpp"
#include "engine/fields.hpp"

// How one sphere is displaced in a trial. Lengths in diameters, angles in radians. A move has,
// beside its fields, the reasons why a container or the sampler that skips rejections does not suit
// it. Its policy is in kernel/move_policies.hpp.
namespace jostle::inline engine {

/// Law of the angle theta from the downward vertical: a density in theta itself (no sin theta) on
/// [0, pi/2]. Gaussian exp(-(theta/theta0)^2), exponential exp(-theta/theta0), linear
/// max(0, 1 - theta/theta0). Philippe & Bideau 2001, eq. 1 and the text below it.
enum class ThetaLaw { gaussian, exponential, linear };
inline constexpr NameTable<ThetaLaw, 3> theta_laws{{{"gaussian", ThetaLaw::gaussian},
                                                    {"exponential", ThetaLaw::exponential},
                                                    {"linear", ThetaLaw::linear}}};

/// A longer step could go round the narrowest periodic box.
inline constexpr Range step_length_range = closed_range(1e-9, least_periodic_width);

/// Scales of the law of theta that make a table.
inline constexpr double least_theta0 = 1e-6, most_theta0 = 1000;

/// A downward step: azimuth uniform, length uniform in [0, max_step], theta by its law; accepted if
/// and only if nothing overlaps. Philippe & Bideau 2001, sec. II: max_step = R/5, theta0 = pi/4.
struct PolarMove {
  double max_step = 0.1;
  double theta0 = std::numbers::pi / 4;
  ThetaLaw law = ThetaLaw::gaussian;
  bool operator==(const PolarMove&) const = default;

  std::optional<std::string> container_fault(const Container& container) const;
  std::vector<std::string> skipping_faults() const;

  static constexpr Description description{
      "polar",
      "A downward step, accepted where nothing overlaps (Philippe & Bideau 2001). The default",
      "Polar move"};
  template <class Self = PolarMove>
  static constexpr auto fields() {
    return std::tuple{
        field("max_step", &Self::max_step, Number{step_length_range, "diameters"},
              "Largest length of a step", {.ladder_symbol = "d_max"}),
        field("theta0", &Self::theta0, Number{closed_range(least_theta0, most_theta0), "radians"},
              "Width of the distribution of the angle from the downward vertical",
              {.ladder_symbol = "theta_0"}),
        field("law", &Self::law, word(theta_laws),
              "Density in theta on [0, pi/2]: exp(-(theta/theta0)^2), exp(-theta/theta0) or "
              "max(0, 1 - theta/theta0)")};
  }
};

/// Trials that a rule may name, at most.
inline constexpr std::uint64_t most_trials = 1'000'000'000'000;

/// The trials of which the share of accepted ones is taken.
enum class AcceptanceBase { all_trials, not_upward };
inline constexpr NameTable<AcceptanceBase, 2> acceptance_bases{
    {{"all_trials", AcceptanceBase::all_trials}, {"not_upward", AcceptanceBase::not_upward}}};

/// Every `every_trials` trials the step is multiplied by `factor` if fewer than `threshold` of
/// them were accepted. Rosato et al. 2010, sec. II.
struct StepAdaptation {
  double factor = 0.995;
  std::uint64_t every_trials = 10'000;
  double threshold = 0.5;
  AcceptanceBase base = AcceptanceBase::all_trials;
  bool reset_each_tap = true;  // true if the step starts anew at max_step at each tap
  bool operator==(const StepAdaptation&) const = default;

  template <class Self = StepAdaptation>
  static constexpr auto fields() {
    return std::tuple{field("factor", &Self::factor, Number{open_range(0, 1)},
                            "Factor by which the step is multiplied"),
                      field("every_trials", &Self::every_trials, Whole{1, most_trials},
                            "Trials between two tests"),
                      field("threshold", &Self::threshold, Number{left_open_range(0, 1)},
                            "Accepted fraction of the trials below which the step shrinks"),
                      field("of", &Self::base, word(acceptance_bases),
                            "The trials of which the accepted fraction is taken"),
                      field("reset_each_tap", &Self::reset_each_tap, Flag{},
                            "The step starts anew at max_step at each tap")};
  }
};

/// x + step (1 - 2 xi), xi uniform in [0, 1]^3; accepted if nothing overlaps and dz <= 0, else with
/// probability exp(-beta dz), beta in units of 1/(m g d). Rosato et al. 2010, sec. II. In a mixture
/// a sphere's own mass makes it exp(-beta m dz), m in masses of a sphere of diameter 1 and density
/// 1. Beta is unused where there is no gravity.
struct MetropolisMove {
  double max_step = 0.1;
  double beta = std::numeric_limits<double>::infinity();
  std::optional<StepAdaptation> adaptation = std::nullopt;  // absent: the step is fixed
  bool operator==(const MetropolisMove&) const = default;

  std::optional<std::string> container_fault(const Container& container) const;
  std::vector<std::string> skipping_faults() const;

  static constexpr Description description{
      "metropolis", "A displacement uniform in a cube (Rosato et al. 2010)", "Metropolis move"};
  template <class Self = MetropolisMove>
  static constexpr auto fields() {
    return std::tuple{
        field("max_step", &Self::max_step, Number{step_length_range, "diameters"},
              "Largest displacement along an axis", {.ladder_symbol = "delta"}),
        field("beta", &Self::beta, or_word(Number{left_open_range(0, 1e300)}, "infinity"),
              "1/temperature in units of 1/(m g d); infinity: no move goes up"),
        field("adapt", &Self::adaptation, or_word(Object<StepAdaptation>{}, "never"),
              "never, or: every every_trials trials the step is multiplied by factor if fewer than "
              "threshold of them were accepted",
              {.title = "Adaptation of the step"})};
  }
};

using Move = std::variant<PolarMove, MetropolisMove>;

}  // namespace jostle::inline engine
