#include "engine/starts/starts.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <span>
#include <utility>

#include "engine/bed/mixture.hpp"
#include "engine/starts/parts.hpp"

namespace jostle::inline engine {

namespace {

std::optional<double> solid_volume_of(const std::shared_ptr<const Sizes>& sizes) {
  if (!sizes) return std::nullopt;
  return solid_volume({PeriodicBox{}, std::vector<Vec3>(sizes->size()), sizes});
}

}  // namespace

std::optional<std::string> gravity_fault(const Container& container) {
  if (has_gravity(container)) return std::nullopt;
  return "a fully_periodic container has neither floor nor gravity: start it with grow, with a "
         "crystal or from a file";
}

std::optional<std::string> start_fault(const Start& start, const Container& container) {
  return std::visit([&](const auto& chosen) { return chosen.container_fault(container); }, start);
}

std::optional<std::string> n_spheres_fault(const Start& start, const Container& container,
                                           std::uint32_t n_spheres,
                                           std::optional<double> solid_volume) {
  if (n_spheres == 0) return "no spheres are asked for: ask for at least one";
  const auto* box = std::get_if<FullyPeriodicBox>(&container);
  if (box == nullptr || !std::holds_alternative<Grow>(start)) return std::nullopt;
  const double volume = box->width_x * box->width_y * box->height;
  const double fraction = solid_volume.value_or(n_spheres * sphere_volume) / volume;
  if (fraction <= densest_growth) return std::nullopt;
  char text[160];
  if (solid_volume) {
    std::snprintf(text, sizeof text,
                  "the spheres fill %.4f of the box: growing without order ends at %g; take fewer "
                  "spheres or a larger box",
                  fraction, densest_growth);
    return text;
  }
  std::snprintf(text, sizeof text,
                "%u spheres fill %.4f of the box: growing without order ends at %g, that is %.0f "
                "spheres",
                n_spheres, fraction, densest_growth,
                std::floor(densest_growth * volume / sphere_volume));
  return text;
}

std::optional<std::string> settling_fault(const Start& start) {
  if (std::visit([](const auto& chosen) { return chosen.may_move; }, start)) return std::nullopt;
  return "this start is at rest from the beginning: only random_settle and a fitted pour can be "
         "relaxed before tap 0";
}

std::vector<std::uint32_t> pour_sequence(const StartSpheres& spheres, RandomStream& random) {
  std::vector<std::uint32_t> sequence;
  std::vector<bool> has_place(spheres.n, false);
  for (const PlacedSphere& placed : spheres.placed) {
    sequence.push_back(placed.sphere);
    has_place.at(placed.sphere) = true;
  }
  const auto first_free = static_cast<std::ptrdiff_t>(sequence.size());
  for (std::uint32_t sphere = 0; sphere < spheres.n; ++sphere) {
    if (!has_place[sphere]) sequence.push_back(sphere);
  }
  if (!spheres.sizes) return sequence;
  const std::span free_spheres(sequence.begin() + first_free, sequence.end());
  const auto radius = [&](std::uint32_t sphere) { return spheres.sizes->radius(sphere); };
  switch (spheres.order) {
    case PourOrder::random:  // Fisher & Yates
      for (std::size_t left = free_spheres.size(); left > 1; --left)
        std::swap(free_spheres[left - 1], free_spheres[random.integer_below(left)]);
      break;
    case PourOrder::as_listed:
      break;
    case PourOrder::large_first:
      std::ranges::stable_sort(free_spheres, std::greater{}, radius);
      break;
    case PourOrder::small_first:
      std::ranges::stable_sort(free_spheres, std::less{}, radius);
      break;
  }
  return sequence;
}

std::optional<std::string> mixture_fault(const Start& start) {
  const char* equal = std::visit([](const auto& chosen) { return chosen.of_equal_spheres; }, start);
  if (equal == nullptr) return std::nullopt;
  return std::string(equal) +
         " requires equal spheres of diameter 1: start a mixture with a steepest-descent pour, "
         "random_settle or grow, or from a file that holds its packing";
}

Packing make_start(const Start& start, const Container& container, std::uint32_t n_spheres,
                   RandomStream& random, const StopAsked& stop, Packing* before_fitting) {
  return make_start(start, container, StartSpheres{n_spheres}, random, stop, before_fitting);
}

Packing make_start(const Start& start, const Container& container, const StartSpheres& spheres,
                   RandomStream& random, const StopAsked& stop, Packing* before_fitting) {
  const auto& sizes = spheres.sizes;
  if (sizes && sizes->size() != spheres.n)
    throw StartError("start: " + std::to_string(spheres.n) +
                     " spheres are asked for, and sizes of " + std::to_string(sizes->size()) +
                     " are given: give one per sphere");
  for (const auto& fault :
       {sizes ? width_fault(container, 2 * sizes->largest_radius()) : width_fault(container),
        sizes ? mixture_fault(start) : std::nullopt, start_fault(start, container),
        n_spheres_fault(start, container, spheres.n, solid_volume_of(sizes))}) {
    if (fault) throw StartError("start: " + *fault);
  }
  const Placing placing{container, spheres, random, stop, before_fitting};
  return {container, std::visit([&](const auto& chosen) { return chosen.place(placing); }, start),
          sizes};
}

}  // namespace jostle::inline engine
