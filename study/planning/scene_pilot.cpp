#include "study/planning/scene_pilot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <variant>

#include "engine/starts/starts.hpp"

namespace jostle::inline study {
namespace {

constexpr double process_bytes = 40e6;  // libraries and bookkeeping

/// For the pilots of a scene.
struct PilotLimits {
  std::uint64_t units;    // shared by the points tried
  std::uint32_t spheres;  // most spheres of a bed that is not cut down
};

/// A few seconds of Monte Carlo. A bed of grains comes to rest only after 1e5 to 1e6 time steps
/// from a start, so there are more units, of smaller beds.
PilotLimits pilot_limits(const EngineSettings& engine) {
  if (std::holds_alternative<DiscreteElement>(engine)) return {2'000'000'000, 2'000};
  return {500'000'000, 20'000};
}

/// First, middle and last point: costs differ along a sweep.
std::vector<std::size_t> pilot_points(std::size_t n_points) {
  std::vector<std::size_t> points{0, n_points / 2, n_points - 1};
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

PilotEstimate tried(const LoadedScene& loaded, std::size_t point, std::size_t n_points) {
  const Plan& plan = loaded.plans[point];
  const PilotLimits limits = pilot_limits(plan.engine);
  try {
    return pilot(plan, limits.units / n_points, limits.spheres);
  } catch (const StartError& error) {
    throw BadInput(fmt::format("{}: /start: {}", loaded.files.front(), error.what()));
  } catch (const std::runtime_error& error) {
    throw BadInput(fmt::format("{}{}the pilot failed: {}", plan.label,
                               plan.label.empty() ? "" : ": ", error.what()));
  }
}

}  // namespace

ScenePilot::ScenePilot(const LoadedScene& loaded, const Tell& tell, Repeat repeat)
    : points_(pilot_points(loaded.plans.size())) {
  for (const std::size_t point : points_) {
    const PilotEstimate estimate = tried(loaded, point, points_.size());
    if (tell) tell(loaded.plans[point], estimate);
    times_.push_back(estimate.realization);
    start_ = std::max(start_, estimate.start);
    bytes_ = std::max(bytes_, estimate.bytes);
    settled_ = settled_ && estimate.settled;
  }
  if (repeat == Repeat::first_point) {
    const Seconds repeated = tried(loaded, points_.front(), points_.size()).realization;
    const Seconds sum = times_.front() + repeated;
    if (sum > Seconds{0}) scatter_ = 2 * std::abs((times_.front() - repeated) / sum);
    times_.front() = sum / 2;
  }
  for (const Plan& plan : loaded.plans) {
    if (!plan.motion) continue;
    const std::uint64_t numbers = motion_numbers(*plan.motion, loaded.scene.realizations);
    motion_bytes_ = std::max<std::size_t>(motion_bytes_, numbers * sizeof(double));
  }
}

Seconds ScenePilot::mean_realization() const {
  const Seconds sum = std::accumulate(times_.begin(), times_.end(), Seconds{0});
  return sum / static_cast<double>(times_.size());
}

Seconds ScenePilot::realization(std::size_t point) const {
  const auto index = std::ranges::lower_bound(points_, point) - points_.begin();
  const auto last = static_cast<std::ptrdiff_t>(points_.size()) - 1;
  if (index > last) return times_.back();
  const auto high = static_cast<std::size_t>(index);
  if (points_[high] == point) return times_[high];
  const auto left = static_cast<double>(point - points_[high - 1]),
             whole = static_cast<double>(points_[high] - points_[high - 1]);
  return times_[high - 1] + left / whole * (times_[high] - times_[high - 1]);
}

double ScenePilot::bytes(std::size_t threads) const {
  return process_bytes + static_cast<double>(threads * bytes_ + motion_bytes_);
}

}  // namespace jostle::inline study
