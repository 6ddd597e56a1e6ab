#include <algorithm>

#include "config/parts/kinds.hpp"
#include "config/parts/parts.hpp"

namespace jostle::inline config {

namespace {

struct Widths {
  double x = 16, y = 16;
};

Widths read_widths(const Reader& in) {
  Widths widths;
  const auto width = in.find("width");
  if (!width) {
    in.missing("width", "a number, or a list of two, diameters");
    return widths;
  }
  if (!width->value().is_array()) {
    widths.x = width->number(above(0, widest_container)).value_or(widths.x);
    widths.y = widths.x;
  } else if (width->is_list(2, 2, "numbers")) {
    widths.x = width->element(0).number(above(0, widest_container)).value_or(widths.x);
    widths.y = width->element(1).number(above(0, widest_container)).value_or(widths.y);
  }
  return widths;
}

/// Notes the fault that the engine finds in the container's widths at the key they came from.
void check_width(const Reader& in, const std::string& key, const Container& container) {
  const auto member = in.find(key);
  if (!member || !member->sound()) return;
  if (const auto fault = width_fault(container)) member->fault(*fault);
}

Container read_cylinder(const Reader& in) {
  Cylinder tube;
  if (!in.is_object_of({"sides", "diameter"})) return tube;
  if (!in.find("diameter")) in.missing("diameter", "a number, diameters of a sphere");
  in.read("diameter", tube.diameter, above(0, widest_container));
  check_width(in, "diameter", tube);
  return tube;
}

Container read_fully_periodic(const Reader& in) {
  FullyPeriodicBox box;
  if (!in.is_object_of({"sides", "width", "height"})) return box;
  const Widths widths = read_widths(in);
  box.width_x = widths.x;
  box.width_y = widths.y;
  if (!in.find("height")) in.missing("height", "a number, diameters");
  in.read("height", box.height, above(0, widest_container));
  const double narrower = std::min(widths.x, widths.y);
  check_width(in, "width", FullyPeriodicBox{narrower, narrower, narrower});
  check_width(in, "height", FullyPeriodicBox{box.height, box.height, box.height});
  return box;
}

template <class Box>
Container read_box(const Reader& in) {
  Box box;
  if (!in.is_object_of({"sides", "width"})) return box;
  const Widths widths = read_widths(in);
  box.width_x = widths.x;
  box.width_y = widths.y;
  check_width(in, "width", box);
  return box;
}

Json written_widths(const char* sides, double x, double y) {
  return {{"sides", sides}, {"width", x == y ? plain_number(x) : written_bounds(x, y)}};
}

Json written_fully_periodic(const FullyPeriodicBox& box) {
  Json out = written_widths("fully_periodic", box.width_x, box.width_y);
  out["height"] = plain_number(box.height);
  return out;
}

constexpr Kinds<Container> container_kinds{
    {"periodic", read_box<PeriodicBox>,
     [](const PeriodicBox& box) { return written_widths("periodic", box.width_x, box.width_y); }},
    {"walls", read_box<WalledBox>,
     [](const WalledBox& box) { return written_widths("walls", box.width_x, box.width_y); }},
    {"cylinder", read_cylinder,
     [](const Cylinder& tube) -> Json {
       return {{"sides", "cylinder"}, {"diameter", plain_number(tube.diameter)}};
     }},
    {"fully_periodic", read_fully_periodic, written_fully_periodic}};

}  // namespace

Container read_container(const Reader& in) {
  const auto sides = in.find("sides");
  if (!sides) {
    if (in.is_object_of({"sides", "width", "height", "diameter"})) {
      in.missing("sides", "one of the strings " + listed(names_of(container_kinds)));
    }
    return {};
  }
  if (const auto kind = sides->one_of(names_of(container_kinds))) {
    return read_kind(container_kinds, Choice{*kind, in});
  }
  in.is_object_of({"sides", "width", "height", "diameter"});
  return {};
}

Json written(const Container& container) {
  return written_settings(container_kinds, container);
}

}  // namespace jostle::inline config
