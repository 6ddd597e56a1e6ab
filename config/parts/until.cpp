#include <fmt/format.h>

#include <algorithm>

#include "config/grids.hpp"
#include "config/json/suggestion.hpp"
#include "config/parts/parts.hpp"

namespace jostle::inline config {

namespace {

constexpr double largest_spread = 1e6;

SpreadTarget read_target(const Reader& in) {
  SpreadTarget target;
  if (!in.is_object_of({"observable", "taps", "standard_error", "sigma"})) return target;
  if (const auto observable = in.find("observable")) {
    target.observable = observable->text().value_or("");
  } else {
    in.missing("observable", "the name of an observable of this scene");
  }
  if (const auto taps = in.find("taps")) target.taps = chosen_taps(read_taps(*taps));
  const bool error = in.find("standard_error").has_value(), sigma = in.find("sigma").has_value();
  if (error && sigma) in.fault("expected only one of the keys standard_error, sigma");
  if (!error && !sigma) in.fault("expected one of the keys standard_error, sigma");
  in.read(sigma ? "sigma" : "standard_error", target.at_most, above(0, largest_spread));
  target.spread = sigma ? Spread::sigma : Spread::standard_error;
  return target;
}

}  // namespace

TargetPrecision read_until(const Reader& in) {
  TargetPrecision wanted;
  if (!in.is_object_of({"targets", "at_most"})) return wanted;
  if (!in.find("at_most")) in.missing("at_most", "the largest number of realizations");
  in.read_whole("at_most", wanted.at_most, 1, most_realizations);
  const auto targets = in.find("targets");
  if (!targets) in.missing("targets", "a list of observables and how small their spread must be");
  if (!targets || !targets->is_list(1, 100, "targets")) return wanted;
  for (std::size_t i = 0; i < targets->value().size(); ++i) {
    wanted.targets.push_back(read_target(targets->element(i)));
  }
  return wanted;
}

Json written(const TargetPrecision& wanted) {
  Json targets = Json::array();
  for (const SpreadTarget& target : wanted.targets) {
    targets.push_back({{"observable", target.observable},
                       {"taps", target.taps},
                       {target.spread == Spread::sigma ? "sigma" : "standard_error",
                        plain_number(target.at_most)}});
  }
  return {{"targets", targets}, {"at_most", wanted.at_most}};
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

}  // namespace jostle::inline config
