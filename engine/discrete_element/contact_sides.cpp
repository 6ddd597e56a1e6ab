#include <algorithm>
#include <tuple>

#include "engine/discrete_element/contact_lists.hpp"

namespace jostle::inline engine {

namespace {

auto order(const KeptSide& side) {
  return std::tuple(side.sphere, side.side);
}

}  // namespace

void ContactLists::find_sides(std::span<const SphereRow> rows, double floor_height) {
  std::vector<KeptSide> kept = kept_sides();
  waiting_sides_.clear();
  floor_ = {};
  sides_ = {};
  const double skin = side_skin * skin_unit_;
  const auto add = [](Near& near, std::uint32_t place, std::uint32_t side) {
    near.first.push_back(place);
    near.source.push_back(side);
  };
  std::vector<std::uint32_t> by_number(n_spheres_);
  for (std::uint32_t i = 0; i < n_spheres_; ++i) by_number[numbers_[i]] = i;
  for (const std::uint32_t i : by_number) {
    const Vec3 r = centre_of(rows[i]);
    const double reach = radius_at(i) + skin;
    if (r.z - floor_height < reach) add(floor_, i, 0);
    for (std::uint32_t k = 1; k < faces_.size(); ++k)
      if (faces_[k].distance(r) < reach) add(sides_, i, k);
  }
  fill(floor_, floor_.first.size());
  fill(sides_, sides_.first.size());
  if (sizes_) {
    measure_side_sizes(floor_);
    measure_side_sizes(sides_);
  }
  carry_sides(floor_, kept);
  carry_sides(sides_, kept);
}

void ContactLists::measure_side_sizes(Near& sides) const {
  for (std::size_t index = 0; index < sides.n; ++index) {
    const double radius = radii_[sides.first[index]];
    sides.size[touching_distance][index] = radius;
    sides.size[per_diameter][index] = sides.size[per_smaller_diameter][index] = 0.5 / radius;
    sides.size[mass_root][index] = std::sqrt(sizes_->mass(numbers_[sides.first[index]]));
  }
}

void ContactLists::carry_sides(Near& sides, const std::vector<KeptSide>& kept) const {
  for (std::size_t index = 0; index < sides.n && !kept.empty(); ++index) {
    const auto key = std::tuple(numbers_[sides.first[index]], sides.source[index]);
    const auto found =
        std::ranges::lower_bound(kept, key, {}, [](const KeptSide& side) { return order(side); });
    if (found == kept.end() || order(*found) != key) continue;
    for (int k = 0; k < n_history_; ++k) sides.history[k][index] = found->history[k];
  }
}

void ContactLists::add_sides(const Near& near, std::vector<KeptSide>& kept) const {
  for (std::size_t index = 0; index < near.n; ++index)
    kept.push_back({numbers_[near.first[index]], near.source[index], history_of(near, index)});
}

std::vector<KeptSide> ContactLists::near_sides() const {
  std::vector<KeptSide> kept = waiting_sides_;
  add_sides(floor_, kept);
  add_sides(sides_, kept);
  std::ranges::sort(kept, {}, [](const KeptSide& side) { return order(side); });
  return kept;
}

std::vector<KeptSide> ContactLists::kept_sides() const {
  std::vector<KeptSide> kept = near_sides();
  std::erase_if(kept, [](const KeptSide& side) { return side.history == ContactHistory{}; });
  return kept;
}

void ContactLists::measure_sides(std::span<const SphereRow> rows, double floor_height) {
  // Where the numbers of a contact go: normal, distance.
  struct Columns {
    double *x, *y, *z, *distance;
    explicit Columns(Near& near)
        : x(near.side[0].data()),
          y(near.side[1].data()),
          z(near.side[2].data()),
          distance(near.side[3].data()) {}
    void set(std::size_t index, Vec3 normal, double from_side) const {
      x[index] = normal.x;
      y[index] = normal.y;
      z[index] = normal.z;
      distance[index] = from_side;
    }
  };
  const Columns floor(floor_), sides(sides_);
  for (std::size_t index = 0; index < floor_.n; ++index)
    floor.set(index, {0, 0, 1}, rows[floor_.first[index]].z - floor_height);
  for (std::size_t index = 0; index < sides_.n; ++index) {
    const Face& face = faces_[sides_.source[index]];
    const Vec3 r = centre_of(rows[sides_.first[index]]);
    if (face.is_tube) {
      const auto [distance, normal] = face.nearest(r);
      sides.set(index, normal, distance);
    } else {  // a plane's normal goes from the face to its place
      sides.set(index, face.inward, face.distance(r));
    }
  }
}

double ContactLists::floor_force() const {
  double sum = 0;
  for (std::size_t index = 0; index < floor_.n; ++index)
    sum += action_[near_.first.size() + index].force_z;
  return sum;
}

}  // namespace jostle::inline engine
