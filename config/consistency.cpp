#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <type_traits>

#include "config/grids.hpp"
#include "config/json/suggestion.hpp"
#include "config/parts/parts.hpp"
#include "ensemble/sink.hpp"

namespace jostle::inline config {

namespace {

/// Notes faults between parts, each only where the parts it joins have none of their own. The
/// engine reports invalid combinations; this function adds their place in the scene.
class Check {
 public:
  Check(const Scene& scene, std::vector<Fault>& faults) : scene_(scene), faults_(faults) {}

  void start_suits_container() {
    if (!all_sound({"/start", "/container", "/spheres"})) return;
    const Start start = engine_start(scene_.start);
    if (const auto overlapping = engine_start_fault(engine_of(scene_), start)) {
      note("/start/" + key_of(scene_.start) + "/overlap", *overlapping);
    } else if (const auto fault = start_fault(start, scene_.container)) {
      // Without gravity hardly any start does: the fault is not that of one.
      const bool of_one = has_gravity(scene_.container);
      note(of_one ? "/start/" + key_of(scene_.start) : "/start", *fault);
    } else if (scene_.n_spheres == 0) {
      return;  // not a scene at all, which is noted
    } else if (const auto too_many = n_spheres_fault(start, scene_.container, scene_.n_spheres)) {
      note("/spheres", *too_many);
    }
  }

  void observables_have_a_floor() {
    if (!all_sound({"/container", "/observe"})) return;
    for (const Observable& observable : scene_.observables) {
      const auto fault = observable_fault(observable, scene_.container);
      if (fault) return note("/observe", *fault);
    }
  }

  /// For a ramp the tap of its greatest strength.
  static Tap strongest_tap(const ProtocolLine& line) {
    Tap tap = line.tap;
    if (line.ramp) strength(tap) = std::max(line.ramp->start, line.ramp->end);
    return tap;
  }

  void taps_suit_container() {
    if (!all_sound({"/container", "/protocol"})) return;
    for (std::size_t i = 0; i < scene_.protocol.size(); ++i) {
      note_if(pointer_to_tap(i), tap_fault(strongest_tap(scene_.protocol[i]), scene_.container));
    }
  }

  void engine_suits() {
    if (!all_sound({"/engine"})) return;
    if (scene_.grains && all_sound({"/container"}))
      note_if("/engine/discrete_element", engine_fault(*scene_.grains, scene_.container));
    if (!all_sound({"/protocol"})) return;
    const LightestMasses lightest =
        all_sound({"/spheres"}) ? lightest_masses(scene_.kinds) : LightestMasses{};
    for (std::size_t i = 0; i < scene_.protocol.size(); ++i) {
      note_if(pointer_to_tap(i),
              engine_tap_fault(engine_of(scene_), strongest_tap(scene_.protocol[i]), lightest));
    }
  }

  std::string pointer_to_tap(std::size_t i) const {
    return fmt::format("/protocol/{}/{}", i, scene_.protocol[i].ramp ? "ramp" : "tap");
  }

  void spheres_can_be_tried() {
    if (scene_.grains || !all_sound({"/container", "/spheres", "/protocol"})) return;
    const bool tries = total_taps(scene_.protocol) > 0 || scene_.relax_start ||
                       std::holds_alternative<RandomSettle>(scene_.start);
    const double largest = scene_.kinds.empty() ? 1 : range_of(scene_.kinds).greatest;
    if (tries) note_if("/container", room_fault(scene_.container, largest));
  }

  void relaxations_can_be() {
    if (scene_.grains) return;
    relaxation_can_be(scene_.relax, "/relax");
    if (!scene_.relax_start) return;
    relaxation_can_be(*scene_.relax_start, "/relax_start");
    if (!all_sound({"/start"})) return;
    if (const auto fault = settling_fault(engine_start(scene_.start))) note("/relax_start", *fault);
  }

  void observables_have_names() {
    // Columns of every sweep point besides the observables.
    std::map<std::string, std::string> taken;
    for (const Column& column : columns(engine_of(scene_)))
      taken[column.name] = "a column of every series";
    for (const std::string reserved : names_beside_series)
      taken[reserved] = "what is stored beside the observables";
    for (std::size_t i = 0; i < scene_.observables.size(); ++i) {
      const std::string name = label(scene_.observables[i]).name;
      const std::string pointer = fmt::format("/observe/{}", i);
      if (!all_sound({pointer})) continue;
      const auto [entry, is_new] = taken.emplace(name, pointer);
      if (is_new) continue;
      note(pointer, fmt::format("the name \"{}\" is taken by {}", name, entry->second));
    }
  }

  void fits_have_curves() {
    if (!all_sound({"/observe"})) return;
    std::vector<std::string> names;
    for (const Observable& observable : scene_.observables) names.push_back(label(observable).name);
    for (std::size_t i = 0; i < scene_.fits.size(); ++i) {
      const FitRequest& fit = scene_.fits[i];
      const std::string place = fmt::format("/fits/{}", i);
      const bool is_read = !fit.observable.empty() && all_sound({place + "/observable"});
      if (is_read && std::ranges::find(names, fit.observable) == names.end()) {
        note(place + "/observable",
             fmt::format("\"{}\" is not observed (observed: {}).{}", fit.observable, listed(names),
                         did_you_mean(fit.observable, names)));
      }
      if (all_sound({place + "/range", "/protocol"}) && fit.first > total_taps(scene_.protocol)) {
        note(place + "/range", fmt::format("begins at tap {}, after the last one, {}", fit.first,
                                           total_taps(scene_.protocol)));
      }
    }
  }

  void snapshots_suit_engine() {
    if (all_sound({"/snapshots", "/engine"}))
      note_if("/snapshots/keep", keep_fault(scene_.snapshots, scene_.grains.has_value()));
  }

  void snapshots_are_reached() {
    if (!all_sound({"/snapshots", "/protocol"})) return;
    const std::uint64_t last = total_taps(scene_.protocol);
    if (const auto every = scene_.snapshots.every;
        every && last / *every >= most_snapshots_by_rule) {
      note("/snapshots/every",
           fmt::format("every {} of {} taps are {} snapshots per realization, and at most {} are "
                       "possible: give {} or more",
                       *every, last, last / *every + 1, most_snapshots_by_rule,
                       last / most_snapshots_by_rule + 1));
    }
    const std::vector<std::uint64_t> taps = chosen_taps(scene_.snapshots.taps);
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
  void note_if(std::string pointer, std::optional<std::string> fault) {
    if (fault) note(std::move(pointer), std::move(*fault));
  }

  void relaxation_can_be(const Relaxation& relax, const std::string& place) {
    if (!all_sound({place})) return;
    if (all_sound({"/container"})) {
      const Container& container = scene_.container;
      note_if(place, move_fault(relax.move, container));
      note_if(place + "/stop", stop_fault(relax.stop.rule, container));
      note_if(place + "/sampler", sampler_fault(relax.sampler, relax.move, container));
    }
    note_if(place + "/stop/sweeps", cap_fault(relax.stop));
  }

  const Scene& scene_;
  std::vector<Fault>& faults_;
};

}  // namespace

void check_consistency(const Scene& scene, std::vector<Fault>& faults) {
  Check check(scene, faults);
  check_kinds(scene, faults);
  check.start_suits_container();
  check.engine_suits();
  check.spheres_can_be_tried();
  check.relaxations_can_be();
  check.observables_have_a_floor();
  check.taps_suit_container();
  check.observables_have_names();
  check.snapshots_suit_engine();
  check.snapshots_are_reached();
  check.fits_have_curves();
  check_until(scene, faults);
  check_analyses(scene, faults);
  check_motion(scene, faults);
  check_structure(scene, faults);
}

}  // namespace jostle::inline config
