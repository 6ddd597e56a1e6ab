#include "structure/order/accessible.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/bed/slab.hpp"
#include "engine/numbers.hpp"

namespace jostle::inline structure {

namespace {

constexpr double period_rounding = 1e-9;

/// Area that two equal discs share, their middles `distance`.
double lens_area(double distance, double radius) {
  if (distance >= 2 * radius) return 0;
  const double half = 0.5 * distance;
  return 2 * (radius * radius * std::acos(half / radius) -
              half * std::sqrt(radius * radius - half * half));
}

bool within_period(double displacement, double period) {
  return std::abs(displacement) <= 0.5 * period * (1 + period_rounding);
}

}  // namespace

HeightWindow accessible_heights(const Packing& packing) {
  if (Boundary(packing.container).periodic_z) return {-infinite, infinite};
  double lowest = sphere_radius;
  for (const Vec3& r : packing.centres) lowest = std::min(lowest, r.z);
  return {lowest, std::min(top_height(packing), 2 * mean_height(packing) - sphere_radius)};
}

AccessibleFootprint::AccessibleFootprint(const Packing& packing) : boundary_(packing.container) {
  low_x_ = boundary_.margin_x();
  low_y_ = boundary_.margin_y();
  high_x_ = boundary_.width_x - low_x_;
  high_y_ = boundary_.width_y - low_y_;
  const double axis = boundary_.axis();
  if (boundary_.tube) radius_ = axis - sphere_radius;
  for (const Vec3& r : packing.centres) {
    if (boundary_.tube) radius_ = std::max(radius_, std::hypot(r.x - axis, r.y - axis));
    if (boundary_.planes_x()) {
      low_x_ = std::min(low_x_, r.x);
      high_x_ = std::max(high_x_, r.x);
    }
    if (boundary_.planes_y()) {
      low_y_ = std::min(low_y_, r.y);
      high_y_ = std::max(high_y_, r.y);
    }
  }
  area_ = boundary_.tube ? std::numbers::pi * radius_ * radius_
                         : (high_x_ - low_x_) * (high_y_ - low_y_);
}

double AccessibleFootprint::depth(double x, double y) const {
  if (boundary_.tube) return radius_ - std::hypot(x - boundary_.axis(), y - boundary_.axis());
  double depth = infinite;
  if (boundary_.planes_x()) depth = std::min({depth, x - low_x_, high_x_ - x});
  if (boundary_.planes_y()) depth = std::min({depth, y - low_y_, high_y_ - y});
  return depth;
}

double AccessibleFootprint::overlap(double dx, double dy) const {
  if (boundary_.tube) return lens_area(std::sqrt(dx * dx + dy * dy), radius_) / area_;
  const auto share = [](bool periodic, double displacement, double low, double high) {
    if (periodic) return within_period(displacement, high) ? 1.0 : 0.0;
    return std::max(0.0, high - low - std::abs(displacement)) / (high - low);
  };
  return share(boundary_.periodic_x, dx, low_x_, high_x_) *
         share(boundary_.periodic_y, dy, low_y_, high_y_);
}

StepTable::StepTable(double reach)
    : reach_(reach + step), values_(static_cast<std::size_t>(2 * reach_ / step) + 2, 0.0) {}

StepTable shares_inside(const std::vector<double>& coordinates, double low, double high,
                        double reach) {
  StepTable shares(reach);
  const auto n = static_cast<double>(coordinates.size());
  // A lattice may end at the bounds: points within a step of them count as inside.
  std::size_t outside_low = coordinates.size(), inside_high = coordinates.size();
  for (std::size_t k = 0; k < shares.size(); ++k) {
    const double least = low - StepTable::step - shares.middle(k);
    const double most = high + StepTable::step - shares.middle(k);
    while (outside_low > 0 && coordinates[outside_low - 1] >= least) --outside_low;
    while (inside_high > 0 && coordinates[inside_high - 1] > most) --inside_high;
    shares.value(k) =
        inside_high > outside_low ? static_cast<double>(inside_high - outside_low) / n : 0;
  }
  return shares;
}

FootprintShares::FootprintShares(const AccessibleFootprint& footprint,
                                 const std::vector<Vec3>& centres, double reach)
    : footprint_(footprint),
      shape_(footprint.boundary_),
      n_centres_(centres.size()),
      reach_(reach) {
  if (shape_.tube) fill_disc(footprint, centres);
  const auto range_along = [&](double Vec3::*axis, double low, double high) {
    std::vector<double> coordinates;
    for (const Vec3& r : centres) coordinates.push_back(r.*axis);
    std::ranges::sort(coordinates);
    return shares_inside(coordinates, low, high, reach);
  };
  if (shape_.planes_x()) x_ = range_along(&Vec3::x, footprint.low_x_, footprint.high_x_);
  if (shape_.planes_y()) y_ = range_along(&Vec3::y, footprint.low_y_, footprint.high_y_);
}

void FootprintShares::fill_disc(const AccessibleFootprint& footprint,
                                const std::vector<Vec3>& centres) {
  constexpr double finest = 0.05, most_looks = 5e7;  // wider steps where centres are many
  const auto n = static_cast<double>(centres.size());
  // A whole number of steps to either side: 0 is one of the places.
  const double wanted = std::max(finest, 2 * reach_ * std::sqrt(n / most_looks));
  const auto half = static_cast<std::size_t>(std::ceil(reach_ / wanted));
  step_ = wanted;
  reach_ = static_cast<double>(half) * step_;
  n_steps_ = 2 * half + 2;
  disc_.assign(n_steps_ * n_steps_, 0.0);
  const double axis = footprint.boundary_.axis();
  const double most = std::pow(footprint.radius_ + StepTable::step, 2);
  for (const Vec3& r : centres) {
    for (std::size_t i = 0; i < n_steps_; ++i) {
      const double x = r.x - axis + static_cast<double>(i) * step_ - reach_;
      double* const row = &disc_[i * n_steps_];
      for (std::size_t j = 0; j < n_steps_; ++j) {
        const double y = r.y - axis + static_cast<double>(j) * step_ - reach_;
        row[j] += x * x + y * y <= most ? 1 : 0;
      }
    }
  }
  for (double& share : disc_) share /= n;
}

double FootprintShares::operator()(double dx, double dy, double overlap) const {
  if (!shape_.has_walls()) return overlap;
  if (!shape_.tube) {
    const double in_period = overlap > 0 ? 1 : 0;
    return (shape_.planes_x() ? x_(dx) : in_period) * (shape_.planes_y() ? y_(dy) : in_period);
  }
  const double x = (dx + reach_) / step_, y = (dy + reach_) / step_;
  const auto i = static_cast<std::size_t>(x), j = static_cast<std::size_t>(y);
  const double u = x - static_cast<double>(i), v = y - static_cast<double>(j);
  const double* const row = &disc_[i * n_steps_ + j];
  const double* const next = row + n_steps_;
  return (1 - u) * ((1 - v) * row[0] + v * row[1]) + u * ((1 - v) * next[0] + v * next[1]);
}

double FootprintShares::without_pair(double dx, double dy, double overlap, double x,
                                     double y) const {
  if (!shape_.has_walls() || n_centres_ <= 2) return overlap;
  const auto n = static_cast<double>(n_centres_);
  const auto pair_share = [n](double share, bool latter_inside) {
    return std::max(0.0, (n * share - 1 - (latter_inside ? 1 : 0)) / (n - 2));
  };
  if (shape_.tube) {
    return pair_share((*this)(dx, dy, overlap), footprint_.depth(x + dx, y + dy) >= 0);
  }
  const double in_period = overlap > 0 ? 1 : 0;
  const auto share_along = [&](bool planes, const StepTable& table, double displacement,
                               double start, double low, double high) {
    if (!planes) return in_period;
    return pair_share(table(displacement),
                      low <= start + displacement && start + displacement <= high);
  };
  return share_along(shape_.planes_x(), x_, dx, x, footprint_.low_x_, footprint_.high_x_) *
         share_along(shape_.planes_y(), y_, dy, y, footprint_.low_y_, footprint_.high_y_);
}

std::vector<Vec3> even_directions(int n) {
  std::vector<Vec3> all;
  for (int k = 0; k < n; ++k) {
    const double z = (2 * k + 1.0) / n - 1, across = std::sqrt(1 - z * z);
    const double turned = 2 * std::numbers::pi * std::numbers::phi * k;
    all.push_back({across * std::cos(turned), across * std::sin(turned), z});
  }
  return all;
}

ShellPart::ShellPart(const Container& container)
    : boundary_(container), directions_(even_directions(500)) {}

double ShellPart::operator()(Vec3 centre, double radius, double partner_radius) const {
  if (!boundary_.has_floor() && !boundary_.has_walls()) return 1;
  // boundary_depth() is how deep a sphere of diameter 1 reaches beyond floor or sides.
  const double deepest = sphere_radius - partner_radius;
  if (boundary_depth(boundary_, centre) <= deepest - radius) return 1;
  double inside = 0;
  for (const Vec3& direction : directions_) {
    inside += boundary_depth(boundary_, centre + radius * direction) <= deepest ? 1 : 0;
  }
  return std::max(inside, 1.0) / static_cast<double>(directions_.size());
}

}  // namespace jostle::inline structure
