#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>

#include "engine/bed/boundary.hpp"
#include "engine/starts/parts.hpp"

namespace jostle::inline engine {

namespace {

// One direction of a lattice: `count` sites, `spacing` apart.
struct Rows {
  long count;
  double spacing;
};

// Rows `spacing` apart, their number a multiple of `multiple`, that fit into a period.
struct RowFit {
  Rows rows;
  bool whole;              // true if they fill the period
  double smaller, larger;  // the periods nearest below and above that they would fill
};

// Rounding of a width in its last digits is allowed for; a width that is too small by more would
// make the rows overlap, one that is too large by at most 1e-9 spaces them out invisibly.
RowFit fit_rows(double period, double spacing, long multiple) {
  constexpr double short_of = 5e-13, beyond = 1e-9;  // relative
  const double unit = spacing * static_cast<double>(multiple);
  const double units = std::floor(period / unit * (1 + short_of));
  const long count = multiple * static_cast<long>(units);
  const double filled = static_cast<double>(count) * spacing;
  const bool whole = count > 0 && std::abs(period - filled) <= beyond * period;
  return {{count, whole && std::abs(period - filled) <= 4e-16 * period
                      ? spacing
                      : period / static_cast<double>(std::max(count, 1L))},
          whole,
          filled,
          whole ? filled : filled + unit};
}

// Layers parallel to the floor, two kinds in turn: the second is shifted sideways.
struct CrystalPlan {
  Rows across, rows;  // along x; along y
  double row_shift;   // along x, of every second row
  double layer_shift_x, layer_shift_y;
  double layer_spacing;
};

// Spacings of the close-packed lattices.
const double hcp_row = std::sqrt(3.0) / 2, hcp_layer = std::sqrt(2.0 / 3);
const double fcc_layer = std::sqrt(0.5);

double row_spacing(Lattice lattice) {
  return lattice == Lattice::hcp ? hcp_row : 1;
}
const char* name(Lattice lattice) {
  return lattice == Lattice::hcp ? "hcp crystal" : "fcc crystal";
}

// Where rows are spaced out the next layer is at the point equidistant from three (hcp) or four
// (fcc) spheres, and sinks until it touches them or the layer two below.
CrystalPlan plan_layers(Lattice lattice, Rows across, Rows rows) {
  const double a = across.spacing, b = rows.spacing;
  if (lattice == Lattice::hcp) {
    const double y = (b * b - 0.25 * a * a) / (2 * b), radius = b - y;
    const bool close_packed = a == 1 && b == hcp_row;
    const double sunk = std::sqrt(std::max(0.25, 1 - radius * radius));
    return {across, rows, 0.5 * a, 0.5 * a, y, close_packed ? hcp_layer : sunk};
  }
  const bool close_packed = a == 1 && b == 1;
  const double sunk = std::sqrt(std::max(0.25, 1 - 0.25 * (a * a + b * b)));
  return {across, rows, 0, 0.5 * a, 0.5 * b, close_packed ? fcc_layer : sunk};
}

// The shortest text that reads back as x.
std::string number(double x) {
  std::array<char, 40> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), x);
  return {text.data(), end.ptr};
}

std::string footprint(double x, double y) {
  return number(x) + " x " + number(y);
}

// The widths that are periodic, as messages name them.
std::string periods(const Boundary& boundary, double x, double y) {
  if (boundary.periodic_sides()) return footprint(x, y);
  return boundary.periodic_x ? number(x) : number(y);
}

[[noreturn]] void refuse_footprint(const Crystal& crystal, const Boundary& boundary,
                                   const RowFit& across, const RowFit& rows) {
  const bool smaller_is_legal = (!boundary.periodic_x || across.smaller > least_periodic_width) &&
                                (!boundary.periodic_y || rows.smaller > least_periodic_width);
  throw StartError(
      std::string(name(crystal.lattice)) + ": whole rows do not fill the " +
      (boundary.periodic_sides() ? "footprint " : "period ") +
      periods(boundary, boundary.width_x, boundary.width_y) + "; the nearest that they fill are " +
      (smaller_is_legal ? periods(boundary, across.smaller, rows.smaller) + " and " : "") +
      periods(boundary, across.larger, rows.larger) +
      " diameters: take one of them, or stretch the rows");
}

// Rows along a direction that ends at walls: they keep their spacing, and sites beyond are left
// out.
RowFit beyond_walls(double width, double spacing) {
  return {{static_cast<long>(width / spacing) + 2, spacing}, true, width, width};
}

// Along a period rows fill it. Between walls the lattice is the perfect one, with a row along the
// walls x = 0 and y = 0, or with a site on the axis of a tube; sites too near a wall are left out.
CrystalPlan plan_crystal(const Crystal& crystal, const Boundary& boundary) {
  const double spacing = row_spacing(crystal.lattice);
  const RowFit across =
      boundary.periodic_x ? fit_rows(boundary.width_x, 1, 1) : beyond_walls(boundary.width_x, 1);
  const RowFit rows = boundary.periodic_y ? fit_rows(boundary.width_y, spacing,
                                                     crystal.lattice == Lattice::hcp ? 2 : 1)
                                          : beyond_walls(boundary.width_y, spacing);
  if (!crystal.stretch && !(across.whole && rows.whole))
    refuse_footprint(crystal, boundary, across, rows);
  return plan_layers(crystal.lattice, across.rows, rows.rows);
}

// The sites of layer 0 or 1, row by row, at height 0.
std::vector<Vec3> layer_sites(const CrystalPlan& plan, const Boundary& boundary, bool shifted) {
  const bool tube = boundary.tube;
  const double corner_x = tube ? boundary.axis() : boundary.margin_x();
  const double corner_y = tube ? boundary.axis() : boundary.margin_y();
  // Shifted rows and layers may have a site before the first one between walls.
  const auto first_of = [tube](const Rows& rows, bool periodic) {
    return tube ? -rows.count : (periodic ? 0L : -1L);
  };
  const long first = first_of(plan.across, boundary.periodic_x),
             first_row = first_of(plan.rows, boundary.periodic_y);
  std::vector<Vec3> sites;
  for (long j = first_row; j < plan.rows.count; ++j) {
    for (long i = first; i < plan.across.count; ++i) {
      const double x = static_cast<double>(i) * plan.across.spacing +
                       (j % 2 != 0 ? plan.row_shift : 0) + (shifted ? plan.layer_shift_x : 0);
      const double y =
          static_cast<double>(j) * plan.rows.spacing + (shifted ? plan.layer_shift_y : 0);
      const Vec3 site = wrapped(boundary, {corner_x + x, corner_y + y, sphere_radius});
      if (clear_of_boundaries(boundary, site)) sites.push_back(site);
    }
  }
  return sites;
}

// How many layers a fully periodic box holds.
long fit_layers(const Crystal& crystal, CrystalPlan& plan, double height) {
  const RowFit layers = fit_rows(height, plan.layer_spacing, 2);
  if (layers.rows.count == 0 || !(layers.whole || crystal.stretch)) {
    throw StartError(
        std::string(name(crystal.lattice)) + ": whole layers do not fill the height " +
        number(height) + "; the nearest that they fill are " +
        (layers.smaller > least_periodic_width ? number(layers.smaller) + " and " : "") +
        number(layers.larger) + " diameters: take one of them, or stretch the layers");
  }
  plan.layer_spacing = layers.rows.spacing;
  return layers.rows.count;
}

}  // namespace

std::optional<std::string> Crystal::container_fault(const Container& container) const {
  const Boundary boundary(container);
  if (boundary.periodic_x || boundary.periodic_y || !stretch) return std::nullopt;
  return "stretch spaces rows out to a period, and there is none between walls: leave it out or "
         "use periodic sides";
}

std::vector<Vec3> Crystal::place(const Placing& placing) const {
  const std::uint32_t n_spheres = placing.spheres.n;
  const Boundary boundary(placing.container);
  CrystalPlan plan = plan_crystal(*this, boundary);
  const std::vector<Vec3> kinds[2] = {layer_sites(plan, boundary, false),
                                      layer_sites(plan, boundary, true)};
  if (kinds[0].empty() || kinds[1].empty()) {
    throw StartError(std::string(name(lattice)) +
                     ": the container is too narrow for one of the two kinds of layers to have a "
                     "site; widen it, or pour the spheres");
  }
  if (boundary.periodic_z) {
    const long layers = fit_layers(*this, plan, boundary.height);
    const auto capacity = static_cast<std::size_t>(layers) * kinds[0].size();
    if (n_spheres > capacity) {
      throw StartError(std::string(name(lattice)) + ": the box has " + std::to_string(capacity) +
                       " sites for " + std::to_string(n_spheres) +
                       " spheres; enlarge it or take fewer spheres");
    }
  }
  std::vector<Vec3> centres;
  centres.reserve(n_spheres);
  for (long layer = 0; centres.size() < n_spheres; ++layer) {
    const double z = sphere_radius + static_cast<double>(layer) * plan.layer_spacing;
    for (const Vec3& site : kinds[layer % 2]) {
      if (centres.size() == n_spheres) break;
      centres.push_back(wrapped(boundary, {site.x, site.y, z}));
    }
  }
  return centres;
}

}  // namespace jostle::inline engine
