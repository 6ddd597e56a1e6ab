#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "engine/bed/geometry.hpp"
#include "engine/monte_carlo/kernel/neighbour_lists.hpp"
#include "engine/monte_carlo/kernel/packed_geometry.hpp"
#include "engine/monte_carlo/rejection_free/place_grid.hpp"
#include "engine/monte_carlo/rejection_free/rejection_free_kernels.hpp"
#include "engine/monte_carlo/rejection_free/weight_tree.hpp"

namespace jostle::inline engine {

/// For every sphere and direction bin a length beyond which a step is certainly rejected. A
/// function of the centres alone: neither lists nor the order and history of moves change anything.
template <class Box, class Directions, class Spheres = EqualSpheres>
class BoundTables {
 public:
  using Index = std::uint32_t;
  using Bins = typename Directions::Bins;
  using Row = BoundRow<Directions::n_sectors>;

  BoundTables(const Box& box, const RejectionFreeKernels& kernels)
      : box_(box),
        packed_box_(box),
        grid_(box),
        kernels_(Spheres::several ? kernels.several : kernels.equal),
        make_bounds_(Directions::bounds(kernels_)) {}

  /// Builds everything.
  void build(const Bins& bins, std::vector<PackedCentre> centres) {
    bins_ = bins;
    centres_ = std::move(centres);
    see_sizes();
    const double coarsest = grid_.coarsest() / std::min(1.0, least_touching_);
    for (float& spread : bins_.spread) spread += 2 * static_cast<float>(coarsest);
    limits_ = limits();
    places_.resize(centres_.size());
    std::ranges::transform(centres_, places_.begin(), place_in(grid_));
    build_lists();
    rows_.resize(centres_.size());
    stale_.clear();
    for (Index i = 0; i < centres_.size(); ++i) stale_.push_back(i);
    make_rows();
    std::vector<std::uint32_t> weights(centres_.size());
    for (const BoundedSphere& made : made_) weights[made.sphere] = made.weight;
    tree_.assign(std::move(weights));
  }

  /// Moves sphere j, and brings its bounds and those of its neighbours up to date.
  void move(Index j, const PackedCentre& centre) {
    centres_[j] = centre;
    const GridPlace former = std::exchange(places_[j], place_in(grid_)(centre));
    stale_.assign(1, j);
    if (distance_squared(packed_box_, centre, lists_.origins()[j]) > spare_ * spare_) {
      renew_list(j);
    } else {
      stale_.resize(1 + most_listed(j) + 3);
      stale_.resize(1 + kernels_.seen_by(limits_, sphere_lists(), j, former, stale_.data() + 1));
    }
    for (const Index i : stale_) {
      prefetch(i);
      tree_.prefetch(i);
    }
    make_rows();
    for (const BoundedSphere& made : made_) tree_.set(made.sphere, made.weight);
  }

  const std::vector<PackedCentre>& centres() const { return centres_; }
  const Bins& bins() const { return bins_; }
  const WeightTree& weights() const { return tree_; }
  const Row& row(Index i) const { return rows_[i]; }
  std::uint64_t rows_made() const { return rows_made_; }

  /// True if another sphere overlaps sphere i placed at `target`, one step away from its centre.
  bool blocked(Index i, Vec3 step, const PackedCentre& target, std::uint64_t& tests) const {
    tests += *lists_.row(i);
    const StepOutcome outcome =
        kernels_.try_step(limits_, sphere_lists(), i, step.x, step.y, step.z);
    return outcome == StepOutcome::unsure ? blocked(i, target, tests)
                                          : outcome == StepOutcome::blocked;
  }

  std::size_t bytes() const {
    return lists_.bytes() + sizeof(PackedCentre) * centres_.capacity() +
           sizeof(GridPlace) * places_.capacity() + sizeof(Row) * rows_.capacity() + tree_.bytes();
  }

  void prefetch(Index i) const {
    const char* const row = reinterpret_cast<const char*>(&rows_[i]);
    for (std::size_t line = 0; line < sizeof(Row); line += 64) __builtin_prefetch(row + line);
    __builtin_prefetch(&centres_[i]);
    __builtin_prefetch(&lists_.origins()[i]);
    __builtin_prefetch(lists_.row(i));
  }

 private:
  // How far a sphere may be from where its list was made, diameters of the smallest sphere.
  static constexpr double spare_per_diameter = 0.06;
  // For numbers near 1 in single precision, after a few operations.
  static constexpr double rounding = 2e-6;
  // Steps of this many sums of radii pass a sphere by.
  static constexpr double too_long = 1.99;
  // Obstacles are at most this many sums of radii away: the margins are made for it.
  static constexpr double farthest_seen = 1.3;

  // In double precision, which decides.
  [[gnu::noinline]] bool blocked(Index i, const PackedCentre& target, std::uint64_t& tests) const {
    const Index* const row = lists_.row(i);
    for (const Index *j = row + 1, *const last = j + *row; j != last; ++j) {
      ++tests;
      const PackedCentre& neighbour = centres_[*j];
      if (distance_squared(packed_box_, target, neighbour) <
          Spheres::touching_squared(target, neighbour)) {
        return true;
      }
    }
    return false;
  }

  template <class Visit>
  void for_each_listed(Index i, Visit&& visit) const {
    const Index* const row = lists_.row(i);
    for (const Index *j = row + 1, *const last = j + *row; j != last; ++j) visit(*j);
  }

  // The extremes of the sums of two radii.
  void see_sizes() {
    least_touching_ = greatest_touching_ = 1;
    if constexpr (Spheres::several) {
      const auto [smallest, largest] =
          std::ranges::minmax(centres_, {}, [](const PackedCentre& c) { return c.radius; });
      least_touching_ = 2 * smallest.radius;
      greatest_touching_ = 2 * largest.radius;
    }
    spare_ = spare_per_diameter * least_touching_;
  }

  // An obstacle is up to `beyond` from contact, and what counts grows with the step. Then
  // |r| <= s + beyond, that is c <= 2 beyond / s + (beyond / s)^2. A step as long as a sphere is
  // wide may pass it by: then no bound holds.
  ObstacleLimits limits() const {
    const double longest = bins_.longest;
    const double beyond = std::min(Directions::obstacle_reach * longest, farthest_seen - 1);
    const double farthest = longest < too_long ? 1 + beyond : 0;
    const Vec3 unit = grid_.unit();
    ObstacleLimits limits{.unit = {static_cast<float>(unit.x), static_cast<float>(unit.y),
                                   static_cast<float>(-unit.z), 0},
                          .margin = static_cast<float>(rounding + 8 * grid_.coarsest()),
                          .doubt = 0,
                          .highest = static_cast<float>(Directions::highest_obstacle),
                          .farthest = static_cast<float>(farthest * farthest - 1),
                          .farthest_per_s = static_cast<float>(2 * beyond),
                          .farthest_per_s_squared = 0,
                          .most_c = static_cast<float>(farthest_seen * farthest_seen - 1),
                          .least_s = static_cast<float>(longest / too_long)};
    limits.farthest_per_s_squared =
        static_cast<float>((1 + beyond) * (1 + beyond) - 1) - limits.farthest_per_s;
    constexpr double longest_seen = 8;
    limits.doubt = longest < longest_seen && single_images()
                       ? static_cast<float>(2 * (1 + longest)) * limits.margin
                       : std::numeric_limits<float>::infinity();
    return limits;
  }

  // True if a step meets a sphere only in the image that is nearest before the step: kernels look
  // at no other.
  bool single_images() const {
    const double narrow = 2 * (greatest_touching_ + bins_.longest) + rounding;
    const Vec3 extent = box_.extent();
    return !(Box::shape().periodic_x && extent.x < narrow) &&
           !(Box::shape().periodic_y && extent.y < narrow);
  }

  void build_lists() {
    lists_.build(box_, centres_, bins_.longest + 2 * spare_ + rounding,
                 {0, 0, -0.43 * bins_.longest});
  }

  // Returns the function that takes a centre to its place.
  static auto place_in(const PlaceGrid& grid) {
    return [&grid](const PackedCentre& centre) { return grid.place<Spheres>(centre); };
  }

  // Room for the list of sphere i.
  std::size_t most_listed(Index i) const {
    if constexpr (Spheres::several) {
      return *lists_.row(i);
    } else {
      return lists_.stride();
    }
  }

  // Makes the list of sphere j at its place. The bounds of all that were or are in it are stale.
  [[gnu::noinline]] void renew_list(Index j) {
    for_each_listed(j, [&](Index i) { stale_.push_back(i); });
    if (!lists_.renew(box_, j, centres_[j])) build_lists();
    for_each_listed(j, [&](Index i) { stale_.push_back(i); });
  }

  // For the stale spheres.
  void make_rows() {
    made_.resize(stale_.size());
    for (std::size_t k = 0; k < stale_.size(); ++k) {
      const PackedCentre& own = centres_[stale_[k]];
      made_[k].sphere = stale_[k];
      made_[k].planes.n = 0;
      add_plane(made_[k].planes, {0, 0, 1}, own.z - Spheres::radius(own) + rounding);
      add_sides(made_[k].planes, own);
    }
    make_bounds_(bins_, limits_, sphere_lists(), made_.data(), made_.size(), rows_.data());
    rows_made_ += made_.size();
  }

  SphereLists sphere_lists() const {
    const auto rows = lists_.rows_place();
    if constexpr (Spheres::several) {
      return {places_.data(), rows.first, 0, rows.offsets};
    } else {
      return {places_.data(), rows.first, rows.stride, nullptr};
    }
  }

  void add_plane(Planes& planes, Vec3 normal, double gap) const {
    static_assert(Planes::most >= most_faces);
    if (gap > bins_.longest) return;
    const std::uint32_t w = planes.n++;
    planes.x[w] = static_cast<float>(normal.x);
    planes.y[w] = static_cast<float>(normal.y);
    planes.z[w] = static_cast<float>(normal.z);
    planes.gap[w] = static_cast<float>(gap);
  }

  void add_sides(Planes& planes, const PackedCentre& own) const {
    const Vec3 extent = box_.extent();
    const double radius = Spheres::radius(own), beyond = rounding - radius;
    if constexpr (Box::shape().planes_x()) {
      add_plane(planes, {-1, 0, 0}, own.xy[0] + beyond);
      add_plane(planes, {1, 0, 0}, extent.x - own.xy[0] + beyond);
    }
    if constexpr (Box::shape().planes_y()) {
      add_plane(planes, {0, -1, 0}, own.xy[1] + beyond);
      add_plane(planes, {0, 1, 0}, extent.y - own.xy[1] + beyond);
    }
    if constexpr (Box::shape().tube) {  // it is within every plane that touches it
      const double axis = 0.5 * extent.x;
      const double x = own.xy[0] - axis, y = own.xy[1] - axis;
      const double distance = std::sqrt(x * x + y * y);
      if (distance < 1e-3) return;
      add_plane(planes, {x / distance, y / distance, 0}, axis - radius - distance + rounding);
    }
  }

  Box box_;
  PackedBox<Box, Spheres> packed_box_;
  PlaceGrid grid_;
  BoundKernels kernels_;
  BoundsKernel<Directions::n_sectors> make_bounds_;
  double least_touching_ = 1, greatest_touching_ = 1, spare_ = spare_per_diameter;
  Bins bins_{};
  ObstacleLimits limits_{};
  std::vector<PackedCentre> centres_;
  std::vector<GridPlace> places_;
  NeighbourListsOf<Spheres> lists_;
  std::vector<Row> rows_;
  WeightTree tree_;
  std::vector<Index> stale_;
  std::vector<BoundedSphere> made_;  // last
  std::uint64_t rows_made_ = 0;
};

}  // namespace jostle::inline engine
