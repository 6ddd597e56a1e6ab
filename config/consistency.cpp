#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "config/grids.hpp"
#include "config/json/suggestion.hpp"
#include "config/parts/parts.hpp"
#include "ensemble/sink.hpp"

namespace jostle {

namespace {

constexpr double densest_growth = 0.64;

template <class T>
bool is(const auto& choice) {
  return std::holds_alternative<T>(choice);
}

/// Notes faults between parts, each only where the parts it joins have none of their own.
class Check {
 public:
  Check(const Scene& scene, std::vector<Fault>& faults) : scene_(scene), faults_(faults) {}

  void start_suits_container() {
    if (!all_sound({"/start", "/container", "/spheres"})) return;
    const bool fluid = is<FullyPeriodicBox>(scene_.container);
    const bool file = is<PackingFile>(scene_.start);
    if (fluid && !file && !is<Grow>(scene_.start)) {
      note("/start",
           "a fully_periodic container has neither floor nor gravity: start it with "
           "{\"grow\": {}} or from a file");
    }
    if (is<Grow>(scene_.start)) growth_is_possible();
    if (is<FittedPour>(scene_.start) && !is<WalledBox>(scene_.container)) {
      note("/start/pour",
           "a fitted pour is fitted between walls: it needs the sides \"walls\" "
           "(elsewhere take \"steepest_descent\")");
    }
    if (is<Crystal>(scene_.start) && is<Cylinder>(scene_.container)) {
      note("/start/crystal", "a crystal needs a rectangular footprint, a cylinder has none");
    }
  }

  void fluid_has_no_gravity() {
    if (!is<FullyPeriodicBox>(scene_.container) || !all_sound({"/container"})) return;
    if (all_sound({"/relax"})) {
      if (is<PolarMove>(scene_.relax.move)) {
        note("/relax", "polar moves fall: without gravity (fully_periodic) use \"metropolis\"");
      }
      if (!is<SweepsStop>(scene_.relax.stop.rule)) {
        note("/relax/stop",
             "without gravity (fully_periodic) nothing settles: end a relaxation "
             "after a number of \"sweeps\"");
      }
    }
    if (all_sound({"/observe"}) && !scene_.observables.empty()) {
      note("/observe",
           "these are measured from a floor, a fully_periodic container has none: "
           "write \"observe\": [] and keep snapshots");
    }
    if (all_sound({"/protocol"})) taps_are_idle();
  }

  void relaxations_can_be() {
    sampler_suits_the_move(scene_.relax, "/relax");
    relaxation_can_end(scene_.relax, "/relax");
    if (!scene_.relax_start) return;
    sampler_suits_the_move(*scene_.relax_start, "/relax_start");
    relaxation_can_end(*scene_.relax_start, "/relax_start");
    const bool settles = is<RandomSettle>(scene_.start) || is<FittedPour>(scene_.start);
    if (all_sound({"/start"}) && !settles) {
      note("/relax_start",
           "this start is at rest from the beginning: only random_settle and a fitted pour can "
           "be relaxed before tap 0");
    }
  }

  void observables_have_names() {
    // What every sweep point has beside the observables.
    std::map<std::string, std::string> taken;
    for (const Column& column : columns(MonteCarlo{scene_.relax, scene_.relax_start}))
      taken[column.name] = "a column of every series";
    for (const std::string beside : names_beside_series)
      taken[beside] = "what is stored beside the observables";
    for (std::size_t i = 0; i < scene_.observables.size(); ++i) {
      const std::string name = name_of(scene_.observables[i]);
      const std::string here = fmt::format("/observe/{}", i);
      if (!all_sound({here})) continue;
      const auto [other, is_new] = taken.emplace(name, here);
      if (is_new) continue;
      note(here, fmt::format("the name \"{}\" is taken by {}", name, other->second));
    }
  }

  void fits_have_curves() {
    if (!all_sound({"/fits", "/observe", "/protocol"})) return;
    std::vector<std::string> names;
    for (const Observable& observable : scene_.observables) names.push_back(name_of(observable));
    for (std::size_t i = 0; i < scene_.fits.size(); ++i) {
      const FitRequest& fit = scene_.fits[i];
      const std::string place = fmt::format("/fits/{}", i);
      if (std::ranges::find(names, fit.observable) == names.end()) {
        note(place + "/observable",
             fmt::format("\"{}\" is not observed (observed: {}).{}", fit.observable, listed(names),
                         did_you_mean(fit.observable, names)));
      }
      if (fit.first > total_taps(scene_.protocol)) {
        note(place + "/range", fmt::format("begins at tap {}, after the last one, {}", fit.first,
                                           total_taps(scene_.protocol)));
      }
    }
  }

  void snapshots_are_reached() {
    if (!all_sound({"/snapshots", "/protocol"})) return;
    const std::vector<std::uint64_t> taps = chosen_taps(scene_.snapshots.taps);
    const std::uint64_t last = total_taps(scene_.protocol);
    if (taps.empty() || taps.back() <= last) return;
    note("/snapshots/taps",
         fmt::format("tap {} is beyond the last tap of the protocol, {}", taps.back(), last));
  }

 private:
  bool all_sound(std::initializer_list<std::string_view> pointers) const {
    for (const std::string_view pointer : pointers) {
      if (!sound(faults_, pointer)) return false;
    }
    return true;
  }
  void note(std::string pointer, std::string message) {
    faults_.push_back({std::move(pointer), std::move(message)});
  }

  void growth_is_possible() {
    const auto* box = std::get_if<FullyPeriodicBox>(&scene_.container);
    if (!box) {
      note("/start/grow", "spheres grow in a fully_periodic container only: elsewhere pour them");
      return;
    }
    const double volume = box->width_x * box->width_y * box->height;
    const double fraction = scene_.n_spheres * sphere_volume / volume;
    if (fraction <= densest_growth) return;
    note("/spheres", fmt::format("{} spheres fill {:.4f} of the box: growing without order ends at "
                                 "{}, that is {:.0f} spheres",
                                 scene_.n_spheres, fraction, densest_growth,
                                 std::floor(densest_growth * volume / sphere_volume)));
  }

  /// Without gravity a tap is a relaxation and nothing else: its strength must be zero.
  void taps_are_idle() {
    for (std::size_t i = 0; i < scene_.protocol.size(); ++i) {
      const ProtocolLine& line = scene_.protocol[i];
      if (!line.ramp && (line.tap == Tap{Dilate{0}} || line.tap == Tap{Lift{0}})) continue;
      note(fmt::format("/protocol/{}/{}", i, line.ramp ? "ramp" : "tap"),
           "a tap has no meaning without gravity (fully_periodic): {\"dilate\": 0} only relaxes");
    }
  }

  void sampler_suits_the_move(const Relaxation& relax, const std::string& place) {
    if (relax.sampler == Sampler::exhaustive || !all_sound({place, "/container"})) return;
    const std::string instead = ": use \"exhaustive\"";
    if (is<FullyPeriodicBox>(scene_.container)) {
      note(place + "/sampler",
           "skipping needs trials that only fall, and without gravity "
           "(fully_periodic) none does" +
               instead);
    }
    const auto* move = std::get_if<MetropolisMove>(&relax.move);
    if (!move) return;
    if (!std::isinf(move->beta)) {
      note(place + "/sampler",
           "skipping needs trials that only fall, and a finite beta lets "
           "some rise" +
               instead);
    }
    if (move->adaptation && move->adaptation->base == AcceptanceBase::not_upward) {
      note(place + "/sampler",
           "skipping does not see the upward trials that the adaptation of the "
           "step leaves out (\"of\": \"not_upward\")" +
               instead);
    }
  }

  void relaxation_can_end(const Relaxation& relax, const std::string& place) {
    if (!all_sound({place})) return;
    const auto* fixed = std::get_if<SweepsStop>(&relax.stop.rule);
    if (fixed && fixed->sweeps > relax.stop.max_sweeps) {
      note(place + "/stop/sweeps", fmt::format("{} sweeps are more than the cap max_sweeps of {}: "
                                               "every relaxation would end capped",
                                               fixed->sweeps, relax.stop.max_sweeps));
    }
  }

  const Scene& scene_;
  std::vector<Fault>& faults_;
};

}  // namespace

void check_consistency(const Scene& scene, std::vector<Fault>& faults) {
  Check check(scene, faults);
  check.start_suits_container();
  check.fluid_has_no_gravity();
  check.relaxations_can_be();
  check.observables_have_names();
  check.snapshots_are_reached();
  check.fits_have_curves();
  check_until(scene, faults);
  check_analyses(scene, faults);
  check_structure(scene, faults);
}

}  // namespace jostle
