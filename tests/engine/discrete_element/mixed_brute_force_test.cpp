// Beds of spheres of several sizes against mechanics that look at all pairs.
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <tuple>

#include "engine/discrete_element/kernel/contact_law.hpp"
#include "tests/engine/discrete_element/grain_cases.hpp"
#include "tests/engine/sample_packings.hpp"

using namespace jostle;
using namespace jostle::grain_cases;

namespace {

using Vector = Vector3<double>;

/// The mechanics of a mixture without any list, vector or sorting: every pair is looked at in every
/// step.
template <class Law>
class BruteForce {
 public:
  BruteForce(const WalledBox& box, const ReducedSettings& settings, const Packing& start)
      : box_(box), settings_(settings), sizes_(*start.sizes) {
    for (const Vec3& centre : start.centres) grains_.push_back(grain(centre));
  }

  const std::vector<GrainState>& grains() const { return grains_; }

  void step() {
    const std::size_t n = grains_.size();
    force_.clear();
    for (std::size_t i = 0; i < n; ++i)
      force_.push_back({0, 0, 0 - settings_.gravity * sizes_.mass(i)});
    torque_.assign(n, {0, 0, 0});
    // Every sphere sums by the number of the other, then the floor, then the sides.
    for (std::uint32_t i = 0; i < n; ++i)
      for (std::uint32_t j = 0; j < n; ++j)
        if (i != j) add_pair(i, j);
    for (std::uint32_t i = 0; i < n; ++i) {
      const Vec3 r = grains_[i].centre;
      add_side(i, 0, {0, 0, 1}, r.z, settings_.floor);
      add_side(i, 1, {1, 0, 0}, r.x, settings_.sides);
      add_side(i, 2, {-1, 0, 0}, box_.width_x - r.x, settings_.sides);
      add_side(i, 3, {0, 1, 0}, r.y, settings_.sides);
      add_side(i, 4, {0, -1, 0}, box_.width_y - r.y, settings_.sides);
    }
    const double dt = settings_.time_step;
    for (std::size_t i = 0; i < n; ++i) {
      const double per_mass = 1 / sizes_.mass(i);
      const double kick = per_mass * dt, turn = per_mass * (2.5 * dt);
      GrainState& grain = grains_[i];
      const Vec3 kicked = {force_[i].x * kick, force_[i].y * kick, force_[i].z * kick};
      const Vec3 turned = {torque_[i].x * turn, torque_[i].y * turn, torque_[i].z * turn};
      grain.velocity = grain.velocity + kicked;
      grain.spin = grain.spin + turned;
      grain.centre = grain.centre + dt * grain.velocity;
      grain.seen_velocity = grain.velocity;
      grain.seen_spin = grain.spin;
      if (!Law::sees_full_step) continue;
      grain.seen_velocity = grain.velocity + 0.5 * kicked;
      grain.seen_spin = grain.spin + 0.5 * turned;
    }
  }

 private:
  static Vector vector_of(Vec3 a) { return {a.x, a.y, a.z}; }

  void add_pair(std::uint32_t i, std::uint32_t j) {
    const auto key = std::pair(std::min(i, j), std::max(i, j));
    if (i < j) {
      const GrainState &a = grains_[i], &b = grains_[j];
      const double reach = sizes_.radius(i) + sizes_.radius(j);
      const double m = sizes_.mass(i), n = sizes_.mass(j);
      const Vector branch = vector_of(a.centre) - vector_of(b.centre);
      const double distance = std::sqrt(dot(branch, branch));
      SizedMeeting<double> meeting;
      meeting.per_diameter = 1 / reach;
      meeting.mass_root = std::sqrt(2 * m * n / (m + n));
      meeting.normal = scaled(1.0 / distance, branch);
      meeting.overlap = reach - distance;
      meeting.arm = Law::arm_is_radius ? meeting.normal : scaled(meeting.per_diameter, branch);
      meeting.velocity = vector_of(a.seen_velocity) - vector_of(b.seen_velocity);
      meeting.spin = vector_of(a.seen_spin) + vector_of(b.seen_spin);
      acts_[key] = laws_[{i, j, 0}](meeting, settings_.spheres);
    }
    const ContactAction<double>& act = acts_[key];
    force_[i] = i < j ? force_[i] + act.force : force_[i] - act.force;
    torque_[i] = torque_[i] + act.torque;
  }

  void add_side(std::uint32_t i, std::uint32_t side, Vector normal, double distance,
                const LawConstants& constants) {
    SizedMeeting<double> meeting;
    meeting.per_diameter = 0.5 / sizes_.radius(i);
    meeting.mass_root = std::sqrt(sizes_.mass(i));
    meeting.normal = normal;
    meeting.overlap = sizes_.radius(i) - distance;
    meeting.arm =
        Law::arm_is_radius ? normal : scaled((2.0 * meeting.per_diameter) * distance, normal);
    meeting.velocity = vector_of(grains_[i].seen_velocity);
    meeting.spin = vector_of(grains_[i].seen_spin);
    const ContactAction<double> act = laws_[{i, i, 1 + side}](meeting, constants);
    force_[i] = force_[i] + act.force;
    torque_[i] = torque_[i] + act.torque;
  }

  WalledBox box_;
  ReducedSettings settings_;
  const Sizes& sizes_;
  std::vector<GrainState> grains_;
  std::vector<Vector> force_, torque_;
  std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>, Law> laws_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, ContactAction<double>> acts_;
};

template <class Law>
void compare_with_brute_force(const ContactLaw& law, double ratio) {
  const WalledBox box{3.1, 3.6};
  const Packing start = random_mixture(box, graded_diameters(18, 2 / ratio, ratio), 14, 7);
  const ReducedSettings units = settings_for(law, start);
  BruteForce<Law> brute(box, units, start);
  // Until they lie, as far as a small sphere's step allows.
  const std::uint64_t steps = std::min<std::uint64_t>(steps_of(8, units), 35'000);
  for (std::uint64_t k = 0; k < steps; ++k) brute.step();
  for (const InstructionSet set : instruction_sets()) {
    CAPTURE(name(set), ratio, law.index());
    GrainLoop loop = loop_for(start, units, set);
    loop.run(steps);
    const auto grains = loop.state().grains;
    bool equal = true;
    for (std::size_t i = 0; i < grains.size(); ++i)
      equal = equal && grains[i].centre == brute.grains()[i].centre &&
              grains[i].velocity == brute.grains()[i].velocity &&
              grains[i].spin == brute.grains()[i].spin;
    CHECK(equal);
    CHECK(loop.greatest_overlap() > 0);
    CHECK(loop.is_sound());
  }
}

}  // namespace

TEST_CASE("a mixture falls between walls as by brute force, to the bit, on every instruction set") {
  for (const double ratio : {1.4, 10.0}) {
    compare_with_brute_force<WaltonBraunLaw<double, true>>(
        WaltonBraun{.stiffness = 5e3, .friction = 0.3}, ratio);
    compare_with_brute_force<LinearLaw<double, true>>(
        LinearSpringDashpot{.stiffness = 5e3, .friction = 0.3}, ratio);
  }
}
