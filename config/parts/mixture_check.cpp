#include <fmt/format.h>

#include <algorithm>

#include "config/parts/parts.hpp"
#include "engine/bed/boundary.hpp"
#include "ensemble/statistics/finite_text.hpp"
#include "structure/order/mixtures/partial_correlation.hpp"

namespace jostle::inline config {

namespace {

/// Notes what of a scene does not take spheres of several sizes.
class MixtureCheck {
 public:
  MixtureCheck(const Scene& scene, const DiameterRange& range, std::size_t n_kinds,
               std::vector<Fault>& faults)
      : scene_(scene), range_(range), n_kinds_(n_kinds), faults_(faults) {}

  void sizes_suit_container() {
    if (sound(faults_, "/container"))
      note_if("/container", width_fault(scene_.container, range_.greatest));
  }

  void engine_takes_sizes() {
    if (scene_.grains) return;  // discrete elements take any
    trials_take_sizes(scene_.relax, "/relax");
    if (scene_.relax_start) trials_take_sizes(*scene_.relax_start, "/relax_start");
  }

  void start_takes_sizes() {
    if (sound(faults_, "/start"))
      note_if("/start/" + key_of(scene_.start), mixture_fault(engine_start(scene_.start)));
  }

  void observables_take_sizes(const std::vector<std::string>& kinds) {
    for (std::size_t i = 0; i < scene_.observables.size(); ++i) {
      const std::string place = fmt::format("/observe/{}", i);
      if (sound(faults_, place)) note_if(place, mixture_fault(scene_.observables[i], kinds));
    }
  }

  void structure_takes_sizes() {
    if (!sound(faults_, "/structure")) return;
    for (const std::string& part : parts_of_equal_spheres(scene_.structure))
      note("/structure/" + part,
           "measures of " + part + " require equal spheres of diameter 1: leave them out");
    const auto& pairs = scene_.structure.pair_correlation;
    if (pairs && sound(faults_, "/container"))
      note_if("/structure/pair_correlation",
              partial_pairs_fault(scene_.container, range_.greatest, n_kinds_, pairs->r_max));
  }

  void analyses_take_sizes() {
    if (!scene_.analyse.volumes.empty())
      note("/analyse/volumes",
           "volumes per sphere and compactivity are defined for equal spheres: leave them out");
  }

 private:
  void trials_take_sizes(const Relaxation& relax, const std::string& place) {
    if (!sound(faults_, place)) return;
    const double step = std::visit([](const auto& move) { return move.max_step; }, relax.move);
    if (step > 2 * range_.least)
      note(fmt::format("{}/{}/max_step", place, name_of(relax.move)),
           finite_text("{} diameters is out of range: with spheres of {:.6g} a step must not "
                       "exceed {:.6g}, twice their diameter",
                       step, range_.least, 2 * range_.least));
  }

  void note(std::string pointer, std::string message) {
    faults_.push_back({std::move(pointer), std::move(message)});
  }
  void note_if(std::string pointer, std::optional<std::string> fault) {
    if (fault) note(std::move(pointer), std::move(*fault));
  }

  const Scene& scene_;
  const DiameterRange range_;
  const std::size_t n_kinds_;
  std::vector<Fault>& faults_;
};

/// Why a sphere of the kind cannot be let fall above its place; nothing if it can.
std::optional<std::string> place_fault(const MixtureKind& kind, const Container& container) {
  const Boundary boundary(container);
  const double radius = 0.5 * range_of(kind.diameter).greatest;
  const auto [x, y] = *kind.place;
  const bool is_in =
      x <= boundary.width_x && y <= boundary.width_y && in_footprint(boundary, {x, y, 0}, radius);
  if (is_in) return std::nullopt;
  return finite_text(
      "a sphere of {:.6g} diameters above ({}, {}) does not lie within the container: move it "
      "inwards",
      2 * radius, x, y);
}

}  // namespace

void check_kinds(const Scene& scene, std::vector<Fault>& faults) {
  if (!sound(faults, "/spheres")) return;
  std::vector<std::string> names;
  for (const MixtureKind& kind : scene.kinds) names.push_back(kind.name);
  if (!scene.kinds.empty()) return check_mixture(scene, range_of(scene.kinds), names, faults);
  if (scene.pour_order != PourOrder::random && sound(faults, "/pour_order"))
    faults.push_back({"/pour_order",
                      "equal spheres have no order: leave it out, or list kinds of spheres under "
                      "\"spheres\""});
  // Those of a file are not known yet.
  if (std::holds_alternative<PackingFile>(scene.start)) return;
  for (std::size_t i = 0; i < scene.observables.size(); ++i) {
    const std::string place = fmt::format("/observe/{}", i);
    const auto fault = equal_spheres_fault(scene.observables[i]);
    if (fault && sound(faults, place)) faults.push_back({place, *fault});
  }
}

void check_mixture(const Scene& scene, const DiameterRange& range,
                   const std::vector<std::string>& kinds, std::vector<Fault>& faults) {
  MixtureCheck check(scene, range, kinds.size(), faults);
  check.sizes_suit_container();
  check.start_takes_sizes();
  check.engine_takes_sizes();
  check.observables_take_sizes(kinds);
  check.structure_takes_sizes();
  check.analyses_take_sizes();
  const bool is_poured = std::holds_alternative<SteepestDescentPour>(scene.start);
  if (scene.pour_order != PourOrder::random && !is_poured && sound(faults, "/pour_order"))
    faults.push_back({"/pour_order",
                      "an order is that of poured spheres: leave it out, or use {\"pour\": "
                      "\"steepest_descent\"}"});
  if (!sound(faults, "/container")) return;
  for (std::size_t i = 0; i < scene.kinds.size(); ++i) {
    if (!scene.kinds[i].place) continue;
    const std::string place = fmt::format("/spheres/{}/place", i);
    if (!is_poured)
      faults.push_back({place,
                        "a place is that of a poured sphere: leave it out, or use {\"pour\": "
                        "\"steepest_descent\"}"});
    else if (const auto fault = place_fault(scene.kinds[i], scene.container))
      faults.push_back({place, *fault});
  }
}

}  // namespace jostle::inline config
