#include "structure/order/mixtures/footprint_pairs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace jostle::inline structure {
namespace {

constexpr double least_open_width = 1e-6, place_rounding = 1e-9;
constexpr double least_shared = 0.05;  // area over that of the smaller region, for products

/// Fractions of places that a displacement leaves inside, and what it leaves of the regions.
struct Fractions {
  double first = 0, second = 0;  // fraction of a kind inside the region of the other sphere
  double product = 0;            // mean of their product over two spheres
  double shared = 0;             // length or area that both regions share
};

/// Density of a displacement, over the lengths or areas of both regions.
double displacement_density(const Fractions& inside, double first_region, double second_region) {
  if (inside.shared >= least_shared * std::min(first_region, second_region))
    return inside.product / inside.shared;
  return 0.5 * (inside.first / second_region + inside.second / first_region);
}

/// The mean of a product over two different spheres of n of one kind.
double mean_product(double first, double second, double of_one_sphere, double n) {
  return n > 1 ? (first * second - of_one_sphere) / (n * (n - 1)) : 0;
}

/// Distribution of displacements along one direction, in either sense.
class DisplacementsAlong {
 public:
  /// Evenly spread over a period.
  explicit DisplacementsAlong(double period) : step_(0.5 * period), cumulative_{0, 1} {}

  /// Between planes; `half_first`, `half_second`: half the widths open to each sphere.
  DisplacementsAlong(const std::vector<double>& first, double half_first,
                     const std::vector<double>& second, double half_second, double farthest) {
    constexpr std::size_t n_steps = 1024;
    step_ = std::min(half_first + half_second, farthest) / n_steps;
    cumulative_.assign(1, 0);
    const bool is_one_kind = &first == &second;
    const auto density_at = [&](double d) {
      // From where a place leads into the other's region, relative to the own one.
      const double low = (-half_second - d) / half_first, high = (half_second - d) / half_first;
      const double low_back = (d - half_first) / half_second,
                   high_back = (d + half_first) / half_second;
      const double n_first = RelativePlaces::count_within(first, low, high);
      const double n_second = RelativePlaces::count_within(second, low_back, high_back);
      const auto n = static_cast<double>(first.size()), m = static_cast<double>(second.size());
      Fractions inside{
          n_first / n, n_second / m, n_first * n_second / (n * m),
          std::min(half_first, half_second - d) - std::max(-half_first, -half_second - d)};
      if (is_one_kind)
        inside.product = mean_product(
            n_first, n_second,
            RelativePlaces::count_within(first, std::max(low, low_back), std::min(high, high_back)),
            n);
      return displacement_density(inside, 2 * half_first, 2 * half_second);
    };
    for (std::size_t k = 0; k < n_steps; ++k) {
      const double d = (static_cast<double>(k) + 0.5) * step_;
      cumulative_.push_back(cumulative_.back() + step_ * (density_at(d) + density_at(-d)));
    }
  }

  double most() const { return step_ * static_cast<double>(cumulative_.size() - 1); }
  /// Probability of a displacement of at most d in either direction.
  double probability(double d) const {
    const double place = d / step_;
    const auto k = static_cast<std::size_t>(place);
    if (k + 1 >= cumulative_.size()) return cumulative_.back();
    return cumulative_[k] +
           (place - static_cast<double>(k)) * (cumulative_[k + 1] - cumulative_[k]);
  }

 private:
  double step_ = 0;
  std::vector<double> cumulative_;
};

/// Ends of the strips across a disc of radius 1: narrower where they change fast.
std::array<double, 80> strip_ends() {
  std::array<double, 80> ends;
  for (std::size_t k = 0; k < ends.size(); ++k)
    ends[k] = std::sin(0.5 * std::numbers::pi * static_cast<double>(k + 1) /
                       static_cast<double>(ends.size()));
  return ends;
}

/// Probability that a displacement from (0, 0) is at most `radius` long: over strips across x.
double within_disc(const DisplacementsAlong& x, const DisplacementsAlong& y, double radius) {
  static const auto ends = strip_ends();
  const double most = std::min(radius, x.most());
  double sum = 0, begin = 0, last = 0;
  for (const double relative_end : ends) {
    const double end = most * relative_end;
    const double up_to = x.probability(end), middle = 0.5 * (begin + end);
    sum +=
        (up_to - last) * y.probability(std::sqrt(std::max(0.0, radius * radius - middle * middle)));
    begin = end;
    last = up_to;
  }
  return sum;
}

/// Area that two discs share whose middles are d apart.
double shared_area(double d, double a, double b) {
  if (d >= a + b) return 0;
  const double least = std::min(a, b);
  if (d <= std::abs(a - b)) return std::numbers::pi * least * least;
  const double at_a = (d * d + a * a - b * b) / (2 * d), at_b = d - at_a;
  const double half_chord = std::sqrt(std::max(0.0, a * a - at_a * at_a));
  return a * a * std::atan2(half_chord, at_a) + b * b * std::atan2(half_chord, at_b) -
         d * half_chord;
}

/// Fraction of the directions in which a step of length d from `place` off the axis ends within
/// `radius`.
double inside_disc(double place, double d, double radius) {
  if (place + d <= radius * (1 + place_rounding)) return 1;
  if (std::abs(place - d) >= radius) return 0;
  const double cosine = (place * place + d * d - radius * radius) / (2 * place * d);
  return std::acos(std::clamp(cosine, -1.0, 1.0)) / std::numbers::pi;
}

/// Density of displacements of length d across a tube, per area.
double tube_density(const FootprintPairs::Spheres& first, const FootprintPairs::Spheres& second,
                    double d) {
  const double a = first.widths.tube, b = second.widths.tube;
  const double n = first.places.size(), m = second.places.size();
  const bool is_one_kind = &first.places == &second.places;
  double n_first = 0, n_second = 0, of_one_sphere = 0;
  for (const RelativePlaces::Ring& ring : first.places.rings()) {
    const double inside = inside_disc(ring.place * a, d, b);
    n_first += ring.count * inside;
    if (!is_one_kind) continue;
    const double back = a == b ? inside : inside_disc(ring.place * b, d, a);
    n_second += ring.count * back;
    of_one_sphere += ring.count * inside * back;
  }
  if (!is_one_kind) {
    for (const RelativePlaces::Ring& ring : second.places.rings())
      n_second += ring.count * inside_disc(ring.place * b, d, a);
  }
  const double product = is_one_kind ? mean_product(n_first, n_second, of_one_sphere, n)
                                     : n_first * n_second / (n * m);
  return displacement_density({n_first / n, n_second / m, product, shared_area(d, a, b)},
                              std::numbers::pi * a * a, std::numbers::pi * b * b);
}

}  // namespace

OpenWidths::OpenWidths(const Boundary& boundary, double radius) {
  const auto half_width = [radius](double width) {
    return std::max(0.5 * width - radius, least_open_width);
  };
  if (boundary.planes_x()) x = half_width(boundary.width_x);
  if (boundary.planes_y()) y = half_width(boundary.width_y);
  if (boundary.tube) tube = half_width(boundary.width_x);
}

void RelativePlaces::add(const Boundary& boundary, Vec3 centre, double radius) {
  // Soft spheres reach into walls.
  const auto relative = [](double place, double half_width) {
    return std::clamp(place / half_width, -1.0, 1.0);
  };
  const OpenWidths open(boundary, radius);
  const double x = centre.x - 0.5 * boundary.width_x, y = centre.y - 0.5 * boundary.width_y;
  if (boundary.planes_x()) x_.push_back(relative(x, open.x));
  if (boundary.planes_y()) y_.push_back(relative(y, open.y));
  if (boundary.tube) radial_.push_back(relative(std::hypot(x, y), open.tube));
  ++n_;
}

void RelativePlaces::finish() {
  constexpr std::size_t most_rings = 256;
  std::ranges::sort(x_);
  std::ranges::sort(y_);
  std::ranges::sort(radial_);
  std::size_t ring_of_last = most_rings;
  for (const double place : radial_) {
    const auto ring =
        std::min(static_cast<std::size_t>(place * place * most_rings), most_rings - 1);
    if (radial_.size() > most_rings && ring == ring_of_last) {
      Ring& last = rings_.back();
      last.place += (place - last.place) / ++last.count;
    } else {
      rings_.push_back({place, 1});
    }
    ring_of_last = ring;
  }
}

double RelativePlaces::count_within(const std::vector<double>& places, double low, double high) {
  const auto begin = std::ranges::lower_bound(places, low - place_rounding);
  const auto end = std::ranges::upper_bound(places, high + place_rounding);
  return end > begin ? static_cast<double>(end - begin) : 0;
}

FootprintPairs::FootprintPairs(const Boundary& boundary, const Spheres& first,
                               const Spheres& second, double farthest) {
  constexpr std::size_t n_steps = 800;
  const double step = farthest * farthest / n_steps;
  inverse_step_ = 1 / step;
  cumulative_.assign(1, 0);
  if (boundary.tube) {
    constexpr int n_radii = 512;
    const double most = std::min(farthest, first.widths.tube + second.widths.tube);
    std::vector<double> up_to{0};  // at even steps of the distance
    for (int k = 0; k < n_radii; ++k) {
      const double middle = (k + 0.5) * most / n_radii;
      up_to.push_back(up_to.back() + 2 * std::numbers::pi * middle * (most / n_radii) *
                                         tube_density(first, second, middle));
    }
    for (std::size_t k = 1; k <= n_steps; ++k) {
      const double place = std::sqrt(static_cast<double>(k) * step) * n_radii / most;
      const auto i = static_cast<std::size_t>(place);
      if (i >= n_radii) {
        cumulative_.push_back(up_to.back());
        continue;
      }
      // The density per area is even between two radii.
      const double inner = static_cast<double>(i), part = place * place - inner * inner;
      cumulative_.push_back(up_to[i] + part / (2 * inner + 1) * (up_to[i + 1] - up_to[i]));
    }
    return;
  }
  const auto displacements = [&](bool planes, double period,
                                 const std::vector<double>& places_first, double half_first,
                                 const std::vector<double>& places_second, double half_second) {
    return planes
               ? DisplacementsAlong(places_first, half_first, places_second, half_second, farthest)
               : DisplacementsAlong(period);
  };
  const DisplacementsAlong x =
      displacements(boundary.planes_x(), boundary.width_x, first.places.x(), first.widths.x,
                    second.places.x(), second.widths.x);
  const DisplacementsAlong y =
      displacements(boundary.planes_y(), boundary.width_y, first.places.y(), first.widths.y,
                    second.places.y(), second.widths.y);
  for (std::size_t k = 1; k <= n_steps; ++k)
    cumulative_.push_back(within_disc(x, y, std::sqrt(static_cast<double>(k) * step)));
}

}  // namespace jostle::inline structure
