#include "engine/bed/container.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

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

std::optional<std::string> too_narrow(const char* what, double width, double least,
                                      bool exclusive) {
  if (std::isfinite(width) && (exclusive ? width > least : width >= least)) return std::nullopt;
  return std::string(what) + " is " + plain(width) + " diameters: the least is " + plain(least) +
         (exclusive ? " (exclusive), or a sphere would meet its own image"
                    : ", or no sphere fits inside");
}

struct WidthFault {
  std::optional<std::string> operator()(const PeriodicBox& box) const {
    return too_narrow("periodic width", std::min(box.width_x, box.width_y), least_periodic_width,
                      true);
  }
  std::optional<std::string> operator()(const WalledBox& box) const {
    return too_narrow("width between walls", std::min(box.width_x, box.width_y), least_walled_width,
                      false);
  }
  std::optional<std::string> operator()(const Cylinder& tube) const {
    return too_narrow("cylinder diameter", tube.diameter, least_walled_width, false);
  }
  std::optional<std::string> operator()(const FullyPeriodicBox& box) const {
    return too_narrow("periodic width or height", std::min({box.width_x, box.width_y, box.height}),
                      least_periodic_width, true);
  }
};

}  // namespace

std::optional<std::string> width_fault(const Container& container) {
  return std::visit(WidthFault{}, container);
}

double width_x(const Container& container) {
  return Boundary(container).width_x;
}

double width_y(const Container& container) {
  return Boundary(container).width_y;
}

double footprint_area(const Container& container) {
  const Boundary boundary(container);
  const double box = boundary.width_x * boundary.width_y;
  return boundary.sides == Sides::cylinder ? 0.25 * std::numbers::pi * box : box;
}

bool has_gravity(const Container& container) {
  return Boundary(container).floor;
}

}  // namespace jostle::inline engine
