#include "engine/discrete_element/grain_loop.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "engine/bed/boundary.hpp"
#include "engine/kernel_sets.hpp"

namespace jostle::inline engine {

namespace {

constexpr double deepest_possible =
    0.2;  // largest possible overlap of spheres that press on each other

GrainKernels kernels_of(GrainLaw law, GrainSizes sizes, InstructionSet set) {
  return function_for<GrainKernels(GrainLaw, GrainSizes)>(set, JOSTLE_EVERY_SET(grain_kernels))(
      law, sizes);
}

Vec3 spin_of(const SphereRow& row, double spin_z) {
  return {row.spin_x, row.spin_y, spin_z};
}

// Places in the order of cells as wide as two spheres, so that neighbours lie near in memory.
std::vector<std::uint32_t> sorted_numbers(const Boundary& boundary,
                                          const std::vector<GrainState>& grains) {
  const auto cell = [&](std::uint32_t i) {
    const Vec3 r = grains[i].centre;
    const auto cell_coordinate = [](double x, double period) {
      if (period > 0) x -= period * std::floor(x / period);
      return static_cast<std::int64_t>(std::floor(0.5 * x));
    };
    const Vec3 periods = boundary.periods();
    return std::tuple(cell_coordinate(r.z, 0), cell_coordinate(r.y, periods.y),
                      cell_coordinate(r.x, periods.x), i);
  };
  std::vector<std::uint32_t> numbers(grains.size());
  std::iota(numbers.begin(), numbers.end(), 0u);
  std::ranges::sort(numbers, {}, cell);
  return numbers;
}

}  // namespace

GrainLoop::GrainLoop(const Container& container, const ReducedSettings& settings,
                     InstructionSet set, std::shared_ptr<const Sizes> sizes)
    : container_(container),
      boundary_(container),
      settings_(settings),
      sizes_(std::move(sizes)),
      kernels_(kernels_of(settings.law, sizes_ ? GrainSizes::several : GrainSizes::equal, set)),
      lists_(container, kernels_.n_history, sizes_) {}

void GrainLoop::load(const Packing& bed) {
  const bool has_same_sizes = bed.sizes == sizes_ || (bed.sizes && sizes_ && *bed.sizes == *sizes_);
  if (!has_same_sizes || (sizes_ && sizes_->size() != bed.centres.size()))
    throw std::invalid_argument("a loop of grains takes beds of the sizes that it was made for");
  std::vector<GrainState> grains(bed.centres.size());
  for (std::size_t i = 0; i < grains.size(); ++i) grains[i].centre = bed.centres[i];
  lists_.keep({}, {});
  place(grains);
  motion_ = {};
  steps_ = 0;
  time_ = 0;
  floor_ = {};
  floor_work_ = floor_force_ = 0;
}

void GrainLoop::place(const std::vector<GrainState>& grains) {
  const std::size_t n = grains.size();
  numbers_ = sorted_numbers(boundary_, grains);
  place_of_.resize(n);
  rows_.assign(n + 2, {});
  spin_z_.assign(n + 2, 0);
  half_rows_.assign(kernels_.sees_full_step ? n + 2 : 0, {});
  half_spin_z_.assign(kernels_.sees_full_step ? n + 2 : 0, 0);
  dissipated_.resize(2 * n);
  const auto put = [](SphereRow& row, double& spin_z, Vec3 centre, Vec3 velocity, Vec3 spin) {
    row = {centre.x, centre.y, centre.z, spin.x, velocity.x, velocity.y, velocity.z, spin.y};
    spin_z = spin.z;
  };
  for (std::uint32_t index = 0; index < n; ++index) {
    const GrainState& grain = grains[numbers_[index]];
    place_of_[numbers_[index]] = index;
    dissipated_[2 * index] = grain.friction;
    dissipated_[2 * index + 1] = grain.latched;
    if (kernels_.sees_full_step) {
      put(rows_[index], spin_z_[index], grain.centre, grain.seen_velocity, grain.seen_spin);
      put(half_rows_[index], half_spin_z_[index], {}, grain.velocity, grain.spin);
    } else {
      put(rows_[index], spin_z_[index], grain.centre, grain.velocity, grain.spin);
    }
  }
  rows_[n].z = -1e3;  // the padding of blocks touches nothing
  rows_[n + 1].z = -2e3;
  if (sizes_) place_sizes();
  have_lists_ = false;
}

void GrainLoop::place_sizes() {
  mass_at_.clear();
  per_mass_at_.clear();
  for (const std::uint32_t number : numbers_) {
    mass_at_.push_back(mass_of(number));
    per_mass_at_.push_back(1 / mass_of(number));
  }
}

std::vector<GrainState> GrainLoop::grains() const {
  std::vector<GrainState> grains(numbers_.size());
  for (std::uint32_t index = 0; index < numbers_.size(); ++index) {
    GrainState& grain = grains[numbers_[index]];
    const SphereRow& seen = rows_[index];
    const bool has_half_rows = kernels_.sees_full_step;
    const SphereRow& moving = has_half_rows ? half_rows_[index] : seen;
    grain.centre = centre_of(seen);
    grain.velocity = velocity_of(moving);
    grain.spin = spin_of(moving, has_half_rows ? half_spin_z_[index] : spin_z_[index]);
    grain.seen_velocity = velocity_of(seen);
    grain.seen_spin = spin_of(seen, spin_z_[index]);
    grain.friction = dissipated_[2 * index];
    grain.latched = dissipated_[2 * index + 1];
  }
  return grains;
}

void GrainLoop::store(Packing& bed) const {
  bed.container = container_;
  bed.sizes = sizes_;
  bed.centres.resize(numbers_.size());
  const Vec3 periods = boundary_.periods();
  const auto wrapped_coordinate = [](double x, double period) {
    return period > 0 ? x - period * std::floor(x / period) : x;
  };
  for (std::uint32_t index = 0; index < numbers_.size(); ++index) {
    const Vec3 r = centre_of(rows_[index]);
    bed.centres[numbers_[index]] = wrapped(
        boundary_, {wrapped_coordinate(r.x, periods.x), wrapped_coordinate(r.y, periods.y), r.z});
  }
}

void GrainLoop::displace(const Packing& displaced) {
  Packing current;
  store(current);
  for (std::uint32_t i = 0; i < numbers_.size(); ++i) {
    const Vec3 displacement = separation(boundary_, displaced.centres[i], current.centres[i]);
    SphereRow& row = rows_[place_of_[i]];
    row.x += displacement.x;
    row.y += displacement.y;
    row.z += displacement.z;
  }
  have_lists_ = false;
}

void GrainLoop::begin_motion(const FloorMotion& motion) {
  motion_ = motion;
  steps_ = 0;
  time_ = 0;
}

SphereArrays GrainLoop::spheres() {
  return {.n = numbers_.size(),
          .rows = rows_.data(),
          .spin_z = spin_z_.data(),
          .half_rows = half_rows_.data(),
          .half_spin_z = half_spin_z_.data(),
          .dissipated = dissipated_.data(),
          .begin = lists_.begin().data(),
          .slot = lists_.slots().data(),
          .action = lists_.action(),
          .mass = mass_at_.data(),
          .per_mass = per_mass_at_.data()};
}

void GrainLoop::run(std::uint64_t steps) {
  for (std::uint64_t k = 0; k < steps; ++k) step();
}

// All of a step but what moves; the floor's work between the ends of a step is by the mean force.
void GrainLoop::find_forces() {
  const FloorMotion::Place floor_before = floor_;
  floor_ = motion_.place_at(time_);
  side_path_ += std::abs(floor_.height - floor_before.height);
  if (!near_lists_hold()) renew_lists();
  const std::span<const SphereRow> rows(rows_.data(), numbers_.size());
  lists_.measure_sides(rows, floor_.height);
  const SphereArrays grains = spheres();
  ContactArrays floor = lists_.floor();
  floor.side_velocity = floor_.velocity;
  kernels_.pairs(lists_.pairs(), grains, settings_.spheres);
  kernels_.sides(floor, grains, settings_.floor);
  kernels_.sides(lists_.sides(), grains, settings_.sides);
  if (floor_moves() || floor_.height != floor_before.height) {
    const double force = lists_.floor_force();
    floor_work_ += 0.5 * (floor_force_ + force) * (floor_.height - floor_before.height);
    floor_force_ = force;
  } else {
    floor_force_ = 0;
  }
}

void GrainLoop::step() {
  find_forces();
  pair_tests_ += lists_.n_near();
  Advance advance{.time_step = settings_.time_step,
                  .gravity = settings_.gravity,
                  .drift = {drift_.x, drift_.y, drift_.z}};
  SphereArrays grains = spheres();
  grains.acted_upon = lists_.acted_upon();
  kernels_.advance(grains, advance);
  const double path = settings_.time_step * std::sqrt(advance.fastest_squared);
  pair_path_ += 2 * path;
  side_path_ += path + settings_.time_step * std::sqrt(norm_squared(drift_));
  near_drift_ = near_drift_ + settings_.time_step * drift_;
  far_drift_ = far_drift_ + settings_.time_step * drift_;
  ++steps_;
  time_ = static_cast<double>(steps_) * settings_.time_step;
}

double GrainLoop::farthest_since(const std::vector<Vec3>& reference, const Vec3& drift) const {
  double farthest = 0;
  for (std::size_t index = 0; index < reference.size(); ++index)
    farthest = std::max(farthest, norm_squared(centre_of(rows_[index]) - reference[index] - drift));
  return std::sqrt(farthest);
}

// The paths bound how far spheres have come; where the bound is reached, the distance itself
// decides.
bool GrainLoop::near_lists_hold() {
  const double skin = ContactLists::near_skin * lists_.skin_unit();
  if (!have_lists_ || !(side_path_ < ContactLists::side_skin * lists_.skin_unit())) return false;
  if (pair_path_ < skin) return true;
  pair_path_ = 2 * farthest_since(near_reference_, near_drift_);
  return pair_path_ < 0.6 * skin;
}

void GrainLoop::renew_lists() {
  const double room = (ContactLists::far_skin - ContactLists::near_skin) * lists_.skin_unit();
  const bool far_holds = have_lists_ && 2 * farthest_since(far_reference_, far_drift_) < room;
  const std::size_t n = numbers_.size();
  if (!far_holds) {
    if (have_lists_) {
      lists_.keep(lists_.kept_pairs(), lists_.kept_sides());
      place(grains());
    }
    lists_.find_far({rows_.data(), n}, numbers_);
    far_reference_.resize(n);
    for (std::size_t index = 0; index < n; ++index) far_reference_[index] = centre_of(rows_[index]);
    far_drift_ = {};
  }
  lists_.find_near({rows_.data(), n}, floor_.height);
  near_reference_.resize(n);
  drift_ = {};
  for (std::size_t index = 0; index < n; ++index) {
    near_reference_[index] = centre_of(rows_[index]);
    drift_ = drift_ + velocity_of(rows_[index]);
  }
  drift_ = (1.0 / static_cast<double>(n)) * drift_;
  near_drift_ = {};
  pair_path_ = side_path_ = 0;
  have_lists_ = true;
}

double GrainLoop::kinetic_energy() const {
  double sum = 0;
  const bool has_half_rows = kernels_.sees_full_step;
  for (std::uint32_t number = 0; number < place_of_.size(); ++number) {
    const std::uint32_t index = place_of_[number];
    const SphereRow& row = has_half_rows ? half_rows_[index] : rows_[index];
    const double spin_z = has_half_rows ? half_spin_z_[index] : spin_z_[index];
    sum += mass_of(number) * norm_squared(velocity_of(row)) +
           inertia_of(number) * norm_squared(spin_of(row, spin_z));
  }
  return 0.5 * sum;
}

double GrainLoop::mass() const {
  if (!sizes_) return static_cast<double>(n_spheres());
  double sum = 0;
  for (const double mass : sizes_->masses()) sum += mass;
  return sum;
}

bool GrainLoop::is_sound() const {
  if (!(lists_.deepest() < deepest_possible)) return false;
  for (std::size_t index = 0; index < numbers_.size(); ++index) {
    const Vec3 r = centre_of(rows_[index]);
    const bool inside = r.z > floor_.height - 1 && r.z < widest_container &&
                        (boundary_.periodic_x || (r.x > -1 && r.x < boundary_.width_x + 1)) &&
                        (boundary_.periodic_y || (r.y > -1 && r.y < boundary_.width_y + 1));
    if (!inside || !std::isfinite(r.x + r.y)) return false;
  }
  return true;
}

std::size_t GrainLoop::bytes() const {
  return lists_.bytes() + (rows_.capacity() + half_rows_.capacity()) * sizeof(SphereRow);
}

GrainLoop::State GrainLoop::state() const {
  return {.grains = grains(),
          .pairs = lists_.kept_pairs(),
          .sides = lists_.kept_sides(),
          .motion = motion_,
          .steps = steps_,
          .floor_work = floor_work_,
          .floor_force = floor_force_,
          .greatest_overlap = lists_.deepest()};
}

void GrainLoop::restore(const State& state) {
  lists_.keep(state.pairs, state.sides);
  place(state.grains);
  motion_ = state.motion;
  steps_ = state.steps;
  time_ = static_cast<double>(steps_) * settings_.time_step;
  floor_ = steps_ > 0 ? motion_.place_at(static_cast<double>(steps_ - 1) * settings_.time_step)
                      : FloorMotion::Place{};
  floor_work_ = state.floor_work;
  floor_force_ = state.floor_force;
  lists_.set_deepest(state.greatest_overlap);
}

}  // namespace jostle::inline engine
