#include "engine/discrete_element/contact_lists.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace jostle::inline engine {

namespace {

constexpr std::uint32_t none = 0xffffffff;

std::int32_t turns_of(double x, double period) {
  return period > 0 ? static_cast<std::int32_t>(std::floor(x / period)) : 0;
}

auto order(const KeptPair& pair) {
  return std::tuple(pair.first, pair.second, pair.turns);
}

}  // namespace

ContactLists::ContactLists(const Container& container, int n_history,
                           std::shared_ptr<const Sizes> sizes)
    : boundary_(container),
      faces_(boundary_),
      container_(container),
      n_history_(n_history),
      sizes_(std::move(sizes)),
      skin_unit_(sizes_ ? 2 * sizes_->smallest_radius() : 1) {}

void ContactLists::find_far(std::span<const SphereRow> rows,
                            std::span<const std::uint32_t> numbers) {
  if (n_spheres_ > 0) {  // else what is to be kept waits already
    waiting_pairs_ = kept_pairs();
    waiting_sides_ = kept_sides();
  }
  n_spheres_ = static_cast<std::uint32_t>(numbers.size());
  numbers_.assign(numbers.begin(), numbers.end());
  radii_.clear();
  if (sizes_)
    for (const std::uint32_t number : numbers_) radii_.push_back(sizes_->radius(number));
  near_ = {};
  floor_ = {};
  sides_ = {};
  near_of_.clear();

  find_far_pairs(rows);
  make_far_slots();
}

// Classes from the largest spheres down, one for each factor of two (Krijgsman, Ogarko & Luding,
// Comput. Part. Mech. 1, 357, 2014).
std::vector<ContactLists::SizeClass> ContactLists::size_classes(double top) const {
  const double largest = sizes_ ? sizes_->largest_radius() : sphere_radius;
  std::vector<std::vector<std::uint32_t>> places;
  for (std::uint32_t i = 0; i < n_spheres_; ++i) {
    std::size_t number = 0;
    for (double r = 0.5 * largest; radius_at(i) <= r; r *= 0.5) ++number;
    if (places.size() <= number) places.resize(number + 1);
    places[number].push_back(i);
  }
  std::vector<SizeClass> classes;
  for (std::vector<std::uint32_t>& of_class : places) {
    if (of_class.empty()) continue;
    double widest = 0;
    for (const std::uint32_t i : of_class) widest = std::max(widest, radius_at(i));
    const auto n = static_cast<std::uint32_t>(of_class.size());
    classes.push_back(
        {widest, std::move(of_class), SphereCells(container_, n, top + 1, 2 * widest)});
  }
  return classes;
}

// Each pair, and each of its images, from the first of its two places, or from the larger sphere.
void ContactLists::find_far_pairs(std::span<const SphereRow> rows) {
  const Vec3 periods = boundary_.periods();
  double top = 1;
  for (std::uint32_t i = 0; i < n_spheres_; ++i) top = std::max(top, rows[i].z);
  std::vector<SizeClass> classes = size_classes(top);
  std::vector<std::array<std::int32_t, 2>> home(n_spheres_);
  std::vector<Vec3> inside(n_spheres_);
  for (std::uint32_t i = 0; i < n_spheres_; ++i) {
    Vec3 r = centre_of(rows[i]);
    home[i] = {turns_of(r.x, periods.x), turns_of(r.y, periods.y)};
    r.x -= home[i][0] * periods.x;
    r.y -= home[i][1] * periods.y;
    // Rounding may leave a coordinate at the far end of the box.
    inside[i] = wrapped(boundary_, {r.x, r.y, std::max(r.z, 0.0)});
  }
  for (SizeClass& of_class : classes)
    for (const std::uint32_t i : of_class.places) of_class.cells.insert(inside[i]);
  far_.clear();
  const auto add = [&](std::uint32_t i, std::uint32_t j, Vec3 image) {
    const auto turn = [&](int axis, double length, double coordinate, double own) {
      if (length == 0) return 0;
      const auto images = static_cast<std::int32_t>(std::lround((coordinate - own) / length));
      return home[i][axis] - home[j][axis] + images;
    };
    const std::array<std::int32_t, 2> turns = {turn(0, periods.x, image.x, inside[j].x),
                                               turn(1, periods.y, image.y, inside[j].y)};
    if (numbers_[i] < numbers_[j]) {
      far_.push_back({i, j, turns});
    } else {
      far_.push_back({j, i, {-turns[0], -turns[1]}});
    }
  };
  const double skin = far_skin * skin_unit_;
  for (auto own = classes.begin(); own != classes.end(); ++own) {
    for (auto partner = own; partner != classes.end(); ++partner) {
      for (const std::uint32_t i : own->places) {
        const double reach = radius_at(i) + partner->largest_radius + skin;
        partner->cells.any_near(inside[i], reach, [&](std::uint32_t k, Vec3 image) {
          const std::uint32_t j = partner->places[k];
          if (partner == own && j <= i) return false;
          const double cutoff = radius_at(i) + radius_at(j) + skin;
          if (norm_squared(inside[i] - image) < cutoff * cutoff) add(i, j, image);
          return false;
        });
      }
    }
  }
}

// The far pairs of every sphere, in the order of the other spheres' numbers.
void ContactLists::make_far_slots() {
  far_begin_.assign(n_spheres_ + 1, 0);
  for (const FarPair& pair : far_) {
    ++far_begin_[pair.first + 1];
    ++far_begin_[pair.second + 1];
  }
  for (std::uint32_t i = 0; i < n_spheres_; ++i) far_begin_[i + 1] += far_begin_[i];
  far_slots_.resize(2 * far_.size());
  std::vector<std::uint32_t> next(far_begin_.begin(), far_begin_.end() - 1);
  for (std::uint32_t p = 0; p < far_.size(); ++p) {
    far_slots_[next[far_[p].first]++] = {p, 0};
    far_slots_[next[far_[p].second]++] = {p, 1};
  }
  const auto key = [&](const FarSlot& slot) {
    const FarPair& pair = far_[slot.pair];
    return std::tuple(numbers_[slot.second ? pair.first : pair.second], pair.turns);
  };
  for (std::uint32_t i = 0; i < n_spheres_; ++i) {
    std::sort(far_slots_.begin() + far_begin_[i], far_slots_.begin() + far_begin_[i + 1],
              [&](const FarSlot& a, const FarSlot& b) { return key(a) < key(b); });
  }
}

void ContactLists::find_near(std::span<const SphereRow> rows, double floor_height) {
  find_pairs(rows);
  find_sides(rows, floor_height);
  make_slots();
}

void ContactLists::fill(Near& near, std::size_t n) const {
  near.n = n;
  const std::size_t padded = (n + block_size - 1) / block_size * block_size;
  near.first.resize(padded, n_spheres_);
  near.second.resize(padded, n_spheres_ + 1);
  near.source.resize(padded, none);
  for (auto& values : near.shift) values.resize(padded, 0.0);
  for (auto& values : near.side) values.resize(padded, 1.0);
  if (sizes_)
    for (auto& values : near.size) values.assign(padded, 1.0);
  for (int k = 0; k < n_history_; ++k) near.history[k].resize(padded, 0.0);
}

void ContactLists::find_pairs(std::span<const SphereRow> rows) {
  const Near old = std::exchange(near_, {});
  const std::vector<std::uint32_t> old_near_of = std::exchange(near_of_, {});
  near_of_.assign(far_.size(), none);
  const double skin = near_skin * skin_unit_;
  const Vec3 periods = boundary_.periods();
  const auto add = [&](std::uint32_t p, const FarPair& pair) {
    near_of_[p] = static_cast<std::uint32_t>(near_.first.size());
    near_.first.push_back(pair.first);
    near_.second.push_back(pair.second);
    near_.source.push_back(p);
    near_.shift[0].push_back(pair.turns[0] * periods.x);
    near_.shift[1].push_back(pair.turns[1] * periods.y);
  };
  // Those that touch now come first: blocks of the others are idle.
  std::vector<std::uint32_t> separated;
  for (std::uint32_t p = 0; p < far_.size(); ++p) {
    const FarPair& pair = far_[p];
    const SphereRow &a = rows[pair.first], &b = rows[pair.second];
    const double x = a.x - b.x - pair.turns[0] * periods.x;
    const double y = a.y - b.y - pair.turns[1] * periods.y, z = a.z - b.z;
    const double distance2 = x * x + y * y + z * z;
    const double touches = touching(pair), reach = touches + skin;
    if (distance2 < touches * touches) {
      add(p, pair);
    } else if (distance2 < reach * reach) {
      separated.push_back(p);
    }
  }
  first_idle_ = near_.first.size();
  for (const std::uint32_t p : separated) add(p, far_[p]);
  fill(near_, near_.first.size());
  if (sizes_) measure_sizes(near_);
  carry_pairs(old, old_near_of);
  first_idle_ = (first_idle_ + block_size - 1) / block_size * block_size;
}

void ContactLists::measure_sizes(Near& pairs) const {
  for (std::size_t index = 0; index < pairs.n; ++index) {
    const std::uint32_t first = pairs.first[index], second = pairs.second[index];
    const double a = radii_[first], b = radii_[second];
    const double m = sizes_->mass(numbers_[first]), n = sizes_->mass(numbers_[second]);
    pairs.size[touching_distance][index] = a + b;
    pairs.size[per_diameter][index] = 1 / (a + b);
    pairs.size[mass_root][index] = std::sqrt(2 * m * n / (m + n));
    pairs.size[per_smaller_diameter][index] = 0.5 / std::min(a, b);
  }
}

// From the near pairs before, or from those that wait; those that remember are not idle.
void ContactLists::carry_pairs(const Near& old, std::span<const std::uint32_t> old_near_of) {
  const auto set = [&](std::size_t index, const ContactHistory& history) {
    if (history == ContactHistory{}) return;
    for (int k = 0; k < n_history_; ++k) near_.history[k][index] = history[k];
    first_idle_ = std::max(first_idle_, index + 1);
  };
  if (!old_near_of.empty()) {
    for (std::size_t index = 0; index < near_.n; ++index) {
      const std::uint32_t old_index = old_near_of[near_.source[index]];
      if (old_index != none) set(index, history_of(old, old_index));
    }
    return;
  }
  std::ranges::sort(waiting_pairs_, {}, [](const KeptPair& pair) { return order(pair); });
  for (std::size_t index = 0; index < near_.n && !waiting_pairs_.empty(); ++index) {
    const FarPair& pair = far_[near_.source[index]];
    const auto key = std::tuple(numbers_[pair.first], numbers_[pair.second], pair.turns);
    const auto found = std::ranges::lower_bound(
        waiting_pairs_, key, {}, [](const KeptPair& kept_pair) { return order(kept_pair); });
    if (found != waiting_pairs_.end() && order(*found) == key) set(index, found->history);
  }
  waiting_pairs_.clear();
}

ContactHistory ContactLists::history_of(const Near& near, std::size_t index) const {
  ContactHistory history{};
  for (int k = 0; k < n_history_; ++k) history[k] = near.history[k][index];
  return history;
}

void ContactLists::keep(std::vector<KeptPair> pairs, std::vector<KeptSide> sides) {
  n_spheres_ = 0;
  near_ = {};
  floor_ = {};
  sides_ = {};
  waiting_pairs_ = std::move(pairs);
  waiting_sides_ = std::move(sides);
}

std::vector<KeptPair> ContactLists::near_pairs() const {
  std::vector<KeptPair> kept = waiting_pairs_;
  for (std::size_t index = 0; index < near_.n; ++index) {
    const FarPair& pair = far_[near_.source[index]];
    kept.push_back(
        {numbers_[pair.first], numbers_[pair.second], pair.turns, history_of(near_, index)});
  }
  std::ranges::sort(kept, {}, [](const KeptPair& pair) { return order(pair); });
  return kept;
}

std::vector<KeptPair> ContactLists::kept_pairs() const {
  std::vector<KeptPair> kept = near_pairs();
  std::erase_if(kept, [](const KeptPair& pair) { return pair.history == ContactHistory{}; });
  return kept;
}

// The contacts of every sphere: its pairs by the other's number, then the floor, then the sides.
void ContactLists::make_slots() {
  const auto padded = [](const Near& near) {
    return static_cast<std::uint32_t>(near.first.size());
  };
  const std::uint32_t floor_at = padded(near_), sides_at = floor_at + padded(floor_);
  action_.assign(sides_at + padded(sides_), {});
  idle_.assign(action_.size(), 0);
  for (std::size_t index = first_idle_; index < floor_at; ++index) idle_[index] = 1;
  // [sphere][0]: floor; the others: up to two planes are near at once, four in a narrow box.
  std::vector<std::array<std::uint32_t, 5>> of_sides(n_spheres_, {none, none, none, none, none});
  for (std::uint32_t k = 0; k < floor_.n; ++k) of_sides[floor_.first[k]][0] = floor_at + k;
  for (std::uint32_t k = 0; k < sides_.n; ++k)
    of_sides[sides_.first[k]][sides_.source[k]] = sides_at + k;
  begin_.resize(n_spheres_ + 1);
  slots_.clear();
  for (std::uint32_t i = 0; i < n_spheres_; ++i) {
    begin_[i] = static_cast<std::uint32_t>(slots_.size());
    for (std::uint32_t s = far_begin_[i]; s < far_begin_[i + 1]; ++s) {
      const std::uint32_t contact = near_of_[far_slots_[s].pair];
      if (contact != none) slots_.push_back(2 * contact + far_slots_[s].second);
    }
    for (const std::uint32_t contact : of_sides[i])
      if (contact != none) slots_.push_back(2 * contact);
  }
  begin_[n_spheres_] = static_cast<std::uint32_t>(slots_.size());
}

ContactArrays ContactLists::arrays(Near& near, std::size_t action_at) {
  ContactArrays arrays;
  arrays.n = near.first.size();
  arrays.first = near.first.data();
  arrays.second = near.second.data();
  for (int k = 0; k < 2; ++k) arrays.shift[k] = near.shift[k].data();
  for (int k = 0; k < 4; ++k) arrays.side[k] = near.side[k].data();
  for (std::size_t k = 0; k < n_contact_sizes; ++k) arrays.size[k] = near.size[k].data();
  for (int k = 0; k < n_history_; ++k) arrays.history[k] = near.history[k].data();
  arrays.action = action_.data() + action_at;
  arrays.idle = idle_.data() + action_at;
  arrays.deepest = &deepest_;
  return arrays;
}

ContactArrays ContactLists::pairs() {
  return arrays(near_, 0);
}
ContactArrays ContactLists::floor() {
  return arrays(floor_, near_.first.size());
}
ContactArrays ContactLists::sides() {
  return arrays(sides_, near_.first.size() + floor_.first.size());
}

const std::uint8_t* ContactLists::acted_upon() {
  if (!mostly_idle()) return nullptr;
  acted_upon_.assign(n_spheres_ + 2, 0);
  for (std::size_t index = 0; index < near_.first.size(); index += smallest_block) {
    if (idle_[index] != 0) continue;
    for (std::size_t k = index; k < index + smallest_block; ++k) {
      acted_upon_[near_.first[k]] = 1;
      acted_upon_[near_.second[k]] = 1;
    }
  }
  for (const Near* near : {&floor_, &sides_})
    for (const std::uint32_t sphere : near->first) acted_upon_[sphere] = 1;
  return acted_upon_.data();
}

// With fewer than seven eighths, saying who is acted upon costs more than the sums it saves.
bool ContactLists::mostly_idle() const {
  std::size_t idle = 0;
  for (std::size_t index = 0; index < near_.first.size(); index += block_size) idle += idle_[index];
  return 8 * idle * block_size > 7 * near_.first.size();
}

std::size_t ContactLists::bytes() const {
  return far_.capacity() * sizeof(FarPair) + far_slots_.capacity() * sizeof(FarSlot) +
         near_of_.capacity() * sizeof(std::uint32_t) + action_.capacity() * sizeof(ActionRow) +
         near_.first.capacity() *
             (3 * sizeof(std::uint32_t) +
              (2 + most_history + (sizes_ ? n_contact_sizes : 0)) * sizeof(double));
}

}  // namespace jostle::inline engine
