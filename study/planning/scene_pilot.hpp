#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "study/planning/pilot.hpp"
#include "study/running/scene_file.hpp"

namespace jostle::inline study {

/// Pilots of a scene's first, middle and last sweep points, and what they make of the others.
class ScenePilot {
 public:
  using Tell = std::function<void(const Plan&, const PilotEstimate&)>;

  enum class Repeat { none, first_point };

  /// Takes about ten seconds on one core, up to a minute for grains. The function `tell` receives
  /// each finished pilot. `repeat`: the first point is tried again at the end, to see how times
  /// scatter. Throws BadInput where one fails.
  explicit ScenePilot(const LoadedScene& loaded, const Tell& tell = {},
                      Repeat repeat = Repeat::none);

  /// By what part of their mean the times of two pilots that do the same work differ; 0 where none
  /// was repeated. Above `busy` other work takes the processor's time.
  double scatter() const { return scatter_; }
  static constexpr double busy = 0.2;

  /// True if all met their stop rules: else times are lower bounds.
  bool settled() const { return settled_; }
  /// Time of a realization on one core: the mean over the points that were tried.
  Seconds mean_realization() const;
  /// Time of a realization of this sweep point, interpolated linearly between two that were tried.
  Seconds realization(std::size_t point) const;
  /// The longest start. One that is stopped is made anew.
  Seconds start() const { return start_; }
  /// Memory of a process that runs so many realizations at once.
  double bytes(std::size_t threads) const;

 private:
  std::vector<std::size_t> points_;  // tried points, ascending
  std::vector<Seconds> times_;       // times of a realization of each point
  Seconds start_{0};
  std::size_t bytes_ = 0;  // bytes of a realization
  std::size_t motion_bytes_ =
      0;  // motion bytes of all realizations of a point, when a run has ended
  bool settled_ = true;
  double scatter_ = 0;
};

}  // namespace jostle::inline study
