#include <fmt/format.h>

#include <algorithm>

#include "config/grids.hpp"
#include "config/json/suggestion.hpp"
#include "config/parts/parts.hpp"
#include "ensemble/statistics/counted.hpp"

namespace jostle::inline config {

namespace {

constexpr std::uint64_t fewest_ageing_taps = 2;  // for the default grid

/// Notes analyses of what the scene does not observe, or of taps that it does not have.
class AnalysisCheck {
 public:
  AnalysisCheck(const Scene& scene, std::vector<Fault>& faults)
      : scene_(scene),
        read_(faults),
        faults_(faults),
        observables_sound_(sound(faults, "/observe")),
        protocol_sound_(sound(faults, "/protocol")),
        taps_(protocol_sound_ ? total_taps(scene.protocol) : 0) {
    for (const Observable& observable : scene.observables)
      observed_.push_back(label(observable).name);
  }

  template <class Settings>
  void operator()(std::string_view kind, const std::vector<AnalysisRequest<Settings>>& requests) {
    for (std::size_t i = 0; i < requests.size(); ++i) {
      const std::string place = fmt::format("/analyse/{}/{}", kind, i);
      const std::string& name = requests[i].observable;
      const bool known = std::ranges::find(observed_, name) != observed_.end();
      if (!known && observables_sound_) {
        note(place, "/observable",
             fmt::format("\"{}\" is not observed (observed: {}).{}", name, listed(observed_),
                         did_you_mean(name, observed_)));
      }
      if (protocol_sound_) check(place, requests[i].settings);
    }
  }

 private:
  void check(const std::string& place, const SteadySettings& settings) {
    check_last(place, settings.last, SteadyStateTest::fewest_taps);
  }

  void check(const std::string& place, const SpectrumSettings& settings) {
    check_last(place, settings.last, fewest_spectrum_taps);
    const std::uint64_t analysed =
        settings.last.value_or(std::max(fewest_spectrum_taps, taps_ / 2));
    if (settings.segment && *settings.segment > analysed) {
      note(place, "/segment",
           fmt::format("{} taps are more than the {} that are analysed", *settings.segment,
                       analysed));
    }
  }

  void check(const std::string& place, const AgeingSettings& settings) {
    if (settings.waiting_times.empty() && settings.lags.empty() && taps_ < fewest_ageing_taps) {
      note(place, "",
           fmt::format("needs {}, but the protocol has {}", counted(fewest_ageing_taps, "tap"),
                       taps_));
    }
    if (!settings.waiting_times.empty() && settings.waiting_times.back() >= taps_) {
      note(place, "/waiting_times",
           fmt::format("{} taps, but the protocol has {}, and a lag follows",
                       settings.waiting_times.back(), taps_));
    }
    if (settings.lags.empty()) return;
    if (settings.lags.front() == 0) note(place, "/lags", "a lag is at least 1 tap");
    if (settings.lags.back() > taps_) {
      note(place, "/lags",
           fmt::format("{}, but the protocol has {}", counted(settings.lags.back(), "tap"), taps_));
    }
  }

  void check(const std::string& place, const HysteresisSettings& settings) {
    check_last(place, settings.last, 1);
    const std::vector<Stage> steps = stages(scene_.protocol);
    const auto is_same = [&](const Stage& stage) { return stage.tap == steps.front().tap; };
    if (std::ranges::all_of(steps, is_same)) {
      note(place, "",
           "the protocol has taps of one strength only: hysteresis needs a ramp, and a loop one up "
           "and "
           "one down");
    }
  }

  void check(const std::string& place, const OrderingSettings& settings) {
    const std::string& candidate = settings.equilibrium;
    if (!candidate.empty() && observables_sound_ &&
        std::ranges::find(observed_, candidate) == observed_.end()) {
      note(place, "/equilibrium",
           fmt::format("\"{}\" is not observed (observed: {}).{}", candidate, listed(observed_),
                       did_you_mean(candidate, observed_)));
    }
    if (settings.hold > taps_) {
      note(place, "/hold",
           fmt::format("{}, but the protocol has {}", counted(settings.hold, "tap"), taps_));
    }
    check_last(place, settings.last, 1);
  }

  void check(const std::string& place, const SweepSettings& settings) {
    check_last(place, settings.last, 1);
  }

  void check(const std::string& place, const VolumesSettings& settings) {
    check_last(place, settings.last, SteadyStateTest::fewest_taps);
  }

  void check(const std::string& place, const MemorySettings& settings) {
    const std::vector<Stage> steps = stages(scene_.protocol);
    if (steps.size() < 2) {
      note(place, "",
           "needs a protocol of at least two stages: ways of reaching a packing fraction, "
           "then a common one");
    } else if (!settings.lags.empty() && settings.lags.front() == 0) {
      note(place, "/lags", "a lag is at least 1 tap");
    } else if (!settings.lags.empty() && settings.lags.back() > steps.back().count) {
      note(place, "/lags",
           fmt::format("{}, but the last stage has {}", counted(settings.lags.back(), "tap"),
                       steps.back().count));
    }
  }

  void check_last(const std::string& place, const std::optional<std::uint64_t>& last,
                  std::uint64_t least) {
    if (last && *last > taps_) {
      note(place, "/last",
           fmt::format("{}, but the protocol has {}", counted(*last, "tap"), taps_));
    } else if (taps_ < least) {
      note(place, "",
           fmt::format("needs {}, but the protocol has {}", counted(least, "tap"), taps_));
    }
  }

  /// At a request, or at one of its values where that has no fault already: what was read in the
  /// place of a faulty value is a default.
  void note(const std::string& place, const std::string& key, std::string message) {
    if (!key.empty() && !sound(read_, place + key)) return;
    faults_.push_back({place + key, std::move(message)});
  }

  const Scene& scene_;
  const std::vector<Fault> read_;  // faults that reading found
  std::vector<Fault>& faults_;
  bool observables_sound_, protocol_sound_;
  std::vector<std::string> observed_;
  std::uint64_t taps_;
};

/// Quantities of a sweep besides the value: the results of the scene's other analyses and fits of
/// the observable.
std::vector<std::string> made_of(const Scene& scene, const std::string& observable) {
  std::vector<std::string> kinds;
  const auto add = [&](const char* kind, const auto& requests) {
    for (const auto& request : requests) {
      if (request.observable == observable) kinds.emplace_back(kind);
    }
  };
  add("steady", scene.analyse.steady);
  add("spectrum", scene.analyse.spectrum);
  add("ageing", scene.analyse.ageing);
  add("ordering", scene.analyse.ordering);
  for (const FitRequest& fit : scene.fits) {
    if (fit.observable != observable) continue;
    const std::vector<std::string> all = relaxation_laws();
    for (const std::string& model : fit.models) {
      if (model == "all") {
        kinds.insert(kinds.end(), all.begin(), all.end());
      } else if (model.starts_with("inverse_log")) {  // one law, kept in both sets of names
        kinds.insert(kinds.end(), {"inverse_log", "inverse_log_height"});
      } else {
        kinds.push_back(model);
      }
    }
  }
  return kinds;
}

}  // namespace

void check_analyses(const Scene& scene, std::vector<Fault>& faults) {
  AnalysisCheck check(scene, faults);
  std::apply([&](const auto&... kind) { (check(kind.key, scene.analyse.*kind.member), ...); },
             Analyses::fields());
}

void check_until(const Scene& scene, std::vector<Fault>& faults) {
  for (const char* part : {"/until", "/observe", "/protocol", "/realizations"}) {
    if (!sound(faults, part)) return;
  }
  if (scene.until.targets.empty()) return;
  if (scene.until.at_most < scene.realizations) {
    faults.push_back({"/until/at_most", fmt::format("{} is below the {} realizations to begin with",
                                                    scene.until.at_most, scene.realizations)});
  }
  std::vector<std::string> observed;
  for (const Observable& observable : scene.observables) observed.push_back(label(observable).name);
  const std::uint64_t taps = total_taps(scene.protocol);
  for (std::size_t i = 0; i < scene.until.targets.size(); ++i) {
    const SpreadTarget& target = scene.until.targets[i];
    const std::string place = fmt::format("/until/targets/{}", i);
    if (std::ranges::find(observed, target.observable) == observed.end()) {
      faults.push_back({place + "/observable",
                        fmt::format("\"{}\" is not observed (observed: {}).{}", target.observable,
                                    listed(observed), did_you_mean(target.observable, observed))});
    }
    if (!target.taps.empty() && target.taps.back() > taps) {
      faults.push_back({place + "/taps", fmt::format("tap {} is beyond the last tap, {}",
                                                     target.taps.back(), taps)});
    }
  }
}

void check_sweep_analyses(const Scene& scene, std::vector<Fault>& faults) {
  if (!sound(faults, "/sweep")) return;
  std::vector<std::string> pointers;
  for (const SweepAxis& axis : scene.sweep) {
    for (const auto& column : axis.columns) pointers.push_back(column.first);
  }
  for (std::size_t i = 0; i < scene.analyse.sweep.size(); ++i) {
    const auto& [observable, settings] = scene.analyse.sweep[i];
    const std::string place = fmt::format("/analyse/sweep/{}", i);
    if (pointers.empty()) {
      faults.push_back({place, "needs a sweep, and this scene has none"});
      continue;
    }
    if (!settings.against.empty() &&
        std::ranges::find(pointers, settings.against) == pointers.end()) {
      faults.push_back({place + "/against", fmt::format("\"{}\" is not swept (swept: {})",
                                                        settings.against, listed(pointers))});
    }
    if (settings.quantity == "value") continue;
    if (!sound(faults, "/fits")) continue;
    const std::vector<std::string> made = made_of(scene, observable);
    const std::string kind = settings.quantity.substr(0, settings.quantity.find('/'));
    if (kind == settings.quantity || std::ranges::find(made, kind) == made.end()) {
      faults.push_back(
          {place + "/quantity",
           fmt::format("\"{}\" is not made by this scene: expected value, or analysis/quantity or "
                       "law/parameter of one that it asks for of {} (it asks for: {})",
                       settings.quantity, observable, made.empty() ? "none" : listed(made))});
    }
  }
}

}  // namespace jostle::inline config
