#include <fmt/format.h>

#include <algorithm>

#include "config/grids.hpp"
#include "config/parts/parts.hpp"
#include "ensemble/statistics/counted.hpp"

namespace jostle::inline config {

namespace {

constexpr std::uint32_t origins_a_decade = 2, lags_a_decade = 10;

std::vector<std::uint64_t> taps_or(const std::optional<TapChoice>& choice,
                                   const LogarithmicTaps& otherwise) {
  return chosen_taps(choice ? *choice : TapChoice(otherwise));
}

/// Notes the faults of a list of taps.
class TapCheck {
 public:
  TapCheck(const char* pointer, std::uint64_t taps, std::vector<Fault>& faults)
      : pointer_(pointer), taps_(taps), faults_(faults) {}

  void operator()(std::span<const std::uint64_t> chosen, std::uint64_t first) const {
    if (chosen.empty()) return note("expected at least one tap");
    if (chosen.size() > most_motion_taps)
      note(fmt::format("{} are more than {}", counted(chosen.size(), "tap"), most_motion_taps));
    if (chosen.front() < first) note("a lag is at least 1 tap");
    if (chosen.back() > taps_)
      note(fmt::format("tap {} is beyond the last tap of the protocol, {}", chosen.back(), taps_));
  }

 private:
  void note(std::string message) const { faults_.push_back({pointer_, std::move(message)}); }

  const char* pointer_;
  std::uint64_t taps_;
  std::vector<Fault>& faults_;
};

void check_amounts(const MotionSettings& settings, const Scene& scene, std::vector<Fault>& faults) {
  if (const auto bytes = motion_bytes(settings, scene.n_spheres); bytes > most_motion_bytes) {
    faults.push_back(
        {"/motion",
         fmt::format("{} of {} take {} MB per realization, more than {} MB: choose fewer "
                     "origins (each keeps the centres of all spheres) or lags",
                     counted(settings.origins.size(), "origin"), counted(scene.n_spheres, "sphere"),
                     bytes >> 20, most_motion_bytes >> 20)});
  }
  const bool grows = !scene.until.targets.empty();
  const std::uint64_t realizations =
      std::max<std::uint64_t>(scene.realizations, grows ? scene.until.at_most : 0);
  if (motion_numbers(settings, realizations) > most_motion_numbers) {
    faults.push_back({"/motion", fmt::format("{} realizations make more than {} numbers per sweep "
                                             "point: choose fewer origins, lags, lengths or layers",
                                             realizations, most_motion_numbers)});
  }
}

}  // namespace

MotionSettings motion_settings(const MotionChoice& choice, std::uint64_t taps,
                               std::size_t n_kinds) {
  MotionSettings settings{.origins = {},
                          .lags = {},
                          .overlap_lengths = choice.overlap_lengths,
                          .layers = choice.layers,
                          .kinds = n_kinds > 1 ? static_cast<std::uint32_t>(n_kinds) : 0};
  if (taps == 0) return settings;
  settings.origins = taps_or(
      choice.origins, {.first = 1, .last = taps - 1, .per_decade = origins_a_decade, .also = {0}});
  settings.lags = taps_or(choice.lags, {.first = 1, .last = taps, .per_decade = lags_a_decade});
  return settings;
}

void check_motion(const Scene& scene, std::vector<Fault>& faults) {
  if (!scene.motion || !sound(faults, "/motion") || !sound(faults, "/protocol")) return;
  const std::uint64_t taps = total_taps(scene.protocol);
  if (taps == 0) {
    faults.push_back(
        {"/motion", "needs a tap, but the protocol has none: leave it out, or add a tap"});
    return;
  }
  const MotionSettings settings = motion_settings(*scene.motion, taps, scene.kinds.size());
  TapCheck("/motion/origins", taps, faults)(settings.origins, 0);
  TapCheck("/motion/lags", taps, faults)(settings.lags, 1);
  if (!sound(faults, "/spheres")) return;
  if (settings.layers > scene.n_spheres)
    faults.push_back(
        {"/motion/layers",
         fmt::format("{} layers of {}: give at most as many (the "
                     "default is {})",
                     settings.layers, counted(scene.n_spheres, "sphere"), MotionChoice{}.layers)});
  check_amounts(settings, scene, faults);
}

}  // namespace jostle::inline config
