#pragma once

#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <variant>

// How one sphere is displaced in a trial. Lengths in diameters, angles in radians.
namespace jostle::inline engine {

/// Law of the angle theta from the downward vertical: a density in theta itself (no sin theta) on
/// [0, pi/2]. Gaussian exp(-(theta/theta0)^2), exponential exp(-theta/theta0), linear
/// max(0, 1 - theta/theta0). Philippe & Bideau 2001, eq. 1 and the text below it.
enum class ThetaLaw { gaussian, exponential, linear };

/// Scales of the law of theta that make a table.
inline constexpr double least_theta0 = 1e-6, most_theta0 = 1000;

/// A downward step: azimuth uniform, length uniform in [0, max_step], theta by its law; accepted if
/// and only if nothing overlaps. Philippe & Bideau 2001, sec. II: max_step = R/5, theta0 = pi/4.
struct PolarMove {
  double max_step = 0.1;
  double theta0 = std::numbers::pi / 4;
  ThetaLaw law = ThetaLaw::gaussian;
  bool operator==(const PolarMove&) const = default;
};

/// Which trials the share of accepted ones is taken of.
enum class AcceptanceBase { all_trials, not_upward };

/// Every `every_trials` trials the step is multiplied by `factor` if fewer than `threshold` of
/// them were accepted. Rosato et al. 2010, sec. II.
struct StepAdaptation {
  double factor = 0.995;
  std::uint64_t every_trials = 10'000;
  double threshold = 0.5;
  AcceptanceBase base = AcceptanceBase::all_trials;
  bool reset_each_tap = true;  // whether the step starts anew at max_step at each tap
  bool operator==(const StepAdaptation&) const = default;
};

/// x + step (1 - 2 xi), xi uniform in [0, 1]^3; accepted if nothing overlaps and dz <= 0, else with
/// probability exp(-beta dz), beta in units of 1/(m g d). Rosato et al. 2010, sec. II. Beta is
/// unused where there is no gravity.
struct MetropolisMove {
  double max_step = 0.1;
  double beta = std::numeric_limits<double>::infinity();
  std::optional<StepAdaptation> adaptation = std::nullopt;  // absent: the step is fixed
  bool operator==(const MetropolisMove&) const = default;
};

using Move = std::variant<PolarMove, MetropolisMove>;

}  // namespace jostle::inline engine
