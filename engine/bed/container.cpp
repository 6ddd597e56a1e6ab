#include "engine/bed/container.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "engine/bed/boundary.hpp"

namespace jostle::inline engine {

namespace {

// Shortest text that names the number without noise in messages ("2", "1.5").
std::string plain(double value) {
  std::string text = std::to_string(value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

std::optional<std::string> too_narrow(const char* side_name, double width, double least,
                                      bool exclusive) {
  if (std::isfinite(width) && (exclusive ? width > least : width >= least)) return std::nullopt;
  return std::string(side_name) + " is " + plain(width) + " diameters: the least is " +
         plain(least) +
         (exclusive ? " (exclusive), or a sphere would meet its own image"
                    : ", or no sphere fits inside");
}

/// Returns the least width along the chosen directions: infinite if none is chosen, NaN if one of
/// them is NaN.
double least_of(Vec3 extent, bool x, bool y, bool z) {
  constexpr double none = std::numeric_limits<double>::infinity();
  double least = none;
  for (const auto& [counts, width] : {std::pair(x, extent.x), {y, extent.y}, {z, extent.z}})
    if (counts && (std::isnan(width) || width < least)) least = width;
  return least;
}

}  // namespace

std::optional<std::string> width_fault(const Container& container) {
  const Boundary boundary(container);
  const Vec3 size = extent(container);
  if (boundary.tube) return too_narrow("cylinder diameter", size.x, least_walled_width, false);
  const char* const periodic = boundary.periodic_z ? "periodic width or height" : "periodic width";
  const auto walled = [&] {
    return too_narrow("width between walls",
                      least_of(size, boundary.planes_x(), boundary.planes_y(), false),
                      least_walled_width, false);
  };
  if (!boundary.periodic_x && !boundary.periodic_y) return walled();
  const auto fault = too_narrow(
      periodic, least_of(size, boundary.periodic_x, boundary.periodic_y, boundary.periodic_z),
      least_periodic_width, true);
  return fault || !boundary.has_walls() ? fault : walled();
}

std::string name_of(const Container& container) {
  return std::visit([](const auto& box) { return std::string(box.description.name); }, container);
}

namespace {

/// Calls act(Box{}) for every kind of container.
template <class Act, std::size_t... k>
void for_each_kind(const Act& act, std::index_sequence<k...>) {
  (act(std::variant_alternative_t<k, Container>{}), ...);
}
template <class Act>
void for_each_kind(const Act& act) {
  for_each_kind(act, std::make_index_sequence<std::variant_size_v<Container>>());
}

}  // namespace

std::vector<std::string> container_names() {
  std::vector<std::string> names;
  for_each_kind([&](const auto& kind) { names.emplace_back(kind.description.name); });
  return names;
}

std::optional<Container> container_of(std::string_view name, Vec3 extent) {
  std::optional<Container> found;
  for_each_kind([&](const auto& kind) {
    if (name == kind.description.name) found = kind.with_extent(extent);
  });
  return found;
}

Vec3 extent(const Container& container) {
  return std::visit([](const auto& box) { return box.extent(); }, container);
}

double width_x(const Container& container) {
  return extent(container).x;
}

double width_y(const Container& container) {
  return extent(container).y;
}

double footprint_area(const Container& container) {
  return footprint_area(Boundary(container), 0);
}

bool has_one_width(const Container& container) {
  const Vec3 size = extent(container);
  const Container longer = *container_of(name_of(container), {size.x, 2 * size.y, size.z});
  return width_y(longer) == size.y;
}

bool has_gravity(const Container& container) {
  return Boundary(container).has_floor();
}

}  // namespace jostle::inline engine
