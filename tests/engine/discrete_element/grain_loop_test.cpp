#include "engine/discrete_element/grain_loop.hpp"

#include <catch2/catch.hpp>
#include <map>
#include <tuple>

#include "engine/bed/boundary.hpp"
#include "engine/discrete_element/kernel/contact_law.hpp"
#include "tests/engine/discrete_element/grain_cases.hpp"

using namespace jostle;
using namespace jostle::grain_cases;

namespace {

using Law = WaltonBraunLaw<double, true>;
using Vector = Vector3<double>;

/// The mechanics without any list, vector or sorting: every pair is tested in every step.
class BruteForce {
 public:
  BruteForce(const WalledBox& box, const ReducedSettings& settings, std::vector<GrainState> grains)
      : box_(box), settings_(settings), grains_(std::move(grains)) {}

  const std::vector<GrainState>& grains() const { return grains_; }

  void step() {
    const std::size_t n = grains_.size();
    force_.assign(n, {0, 0, -settings_.gravity});
    torque_.assign(n, {0, 0, 0});
    // Every sphere sums by the number of the other, then the floor, then the sides: as here.
    for (std::uint32_t i = 0; i < n; ++i)
      for (std::uint32_t j = 0; j < n; ++j)
        if (i != j) add_pair(i, j);
    for (std::uint32_t i = 0; i < n; ++i) {
      const GrainState& grain = grains_[i];
      add_side(i, 0, {0, 0, 1}, grain.centre.z, settings_.floor);
      add_side(i, 1, {1, 0, 0}, grain.centre.x, settings_.sides);
      add_side(i, 2, {-1, 0, 0}, box_.width_x - grain.centre.x, settings_.sides);
      add_side(i, 3, {0, 1, 0}, grain.centre.y, settings_.sides);
      add_side(i, 4, {0, -1, 0}, box_.width_y - grain.centre.y, settings_.sides);
    }
    const double dt = settings_.time_step;
    for (std::size_t i = 0; i < n; ++i) {
      GrainState& grain = grains_[i];
      grain.velocity = grain.velocity + Vec3{force_[i].x * dt, force_[i].y * dt, force_[i].z * dt};
      grain.spin = grain.spin + Vec3{torque_[i].x * (10 * dt), torque_[i].y * (10 * dt),
                                     torque_[i].z * (10 * dt)};
      grain.centre = grain.centre + dt * grain.velocity;
    }
  }

 private:
  static Vector vector_of(Vec3 a) { return {a.x, a.y, a.z}; }

  // The lower number is the first; each pair is computed once, and kept for the other.
  void add_pair(std::uint32_t i, std::uint32_t j) {
    const auto key = std::pair(std::min(i, j), std::max(i, j));
    if (i < j) {
      const GrainState &a = grains_[i], &b = grains_[j];
      const Vector branch = vector_of(a.centre) - vector_of(b.centre);
      const double distance = std::sqrt(dot(branch, branch));
      Meeting<double> meeting;
      meeting.normal = scaled(1.0 / distance, branch);
      meeting.overlap = 1.0 - distance;
      meeting.arm = scaled(0.5, branch);
      meeting.velocity = vector_of(a.velocity) - vector_of(b.velocity);
      meeting.spin = vector_of(a.spin) + vector_of(b.spin);
      acts_[key] = laws_[{i, j, 0}](meeting, settings_.spheres);
    }
    const ContactAction<double>& act = acts_[key];
    force_[i] = i < j ? force_[i] + act.force : force_[i] - act.force;
    torque_[i] = torque_[i] + act.torque;
  }

  void add_side(std::uint32_t i, std::uint32_t side, Vector normal, double distance,
                const LawConstants& constants) {
    Meeting<double> meeting;
    meeting.normal = normal;
    meeting.overlap = 0.5 - distance;
    meeting.arm = scaled(distance, normal);
    meeting.velocity = vector_of(grains_[i].velocity);
    meeting.spin = vector_of(grains_[i].spin);
    const ContactAction<double> act = laws_[{i, i, 1 + side}](meeting, constants);
    force_[i] = force_[i] + act.force;
    torque_[i] = torque_[i] + act.torque;
  }

  WalledBox box_;
  ReducedSettings settings_;
  std::vector<GrainState> grains_;
  std::vector<Vector> force_, torque_;
  std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>, Law> laws_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, ContactAction<double>> acts_;
};

bool is_same(const std::vector<GrainState>& a, const std::vector<GrainState>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!(a[i].centre == b[i].centre && a[i].velocity == b[i].velocity && a[i].spin == b[i].spin))
      return false;
  }
  return a.size() == b.size();
}

std::vector<GrainState> fallen_grains(const Container& container, std::uint32_t n) {
  std::vector<GrainState> grains;
  for (const Vec3 centre : dilute_column(container, n, 5).centres) grains.push_back(grain(centre));
  return grains;
}

// Input by the floor and by gravity, less what is held and what contacts dissipated.
double missing_of_tap(const PeriodicBox& box, std::uint32_t n, double fall, const ContactLaw& law,
                      double finer) {
  const ReducedSettings units = settings(law, 1, finer);
  GrainLoop loop(box, units);
  loop.load(dilute_column(box, n, 3));
  const auto run = [&](double time) {
    loop.run(static_cast<std::uint64_t>(time / units.time_step));
  };
  run(fall);
  const Energies energies_before = loop.energies();
  loop.begin_motion({0.4413, 7.5 * units.seconds, 1});
  run(6);
  const Energies energies_after = loop.energies();
  const double dissipated = energies_after.dissipated() - energies_before.dissipated();
  const double came = energies_after.floor_work - energies_before.floor_work +
                      energies_before.held() - energies_after.held();
  REQUIRE(energies_after.floor_work > energies_before.floor_work + n / 3);
  REQUIRE(dissipated > n / 3);
  return std::abs(came - dissipated) / dissipated;
}

}  // namespace

TEST_CASE("a bed falls between walls as by brute force, to the bit, on every instruction set") {
  const WalledBox box{3, 3.5};
  const ReducedSettings units = settings(WaltonBraun{.friction = 0.3}, 1);
  const std::vector<GrainState> start = fallen_grains(box, 24);
  BruteForce brute(box, units, start);
  const int steps = 25'000;
  for (int k = 0; k < steps; ++k) brute.step();
  for (const InstructionSet set : instruction_sets()) {
    CAPTURE(name(set));
    GrainLoop loop = loop_of(box, units, start, set);
    loop.run(steps);
    CHECK(is_same(loop.state().grains, brute.grains()));
    CHECK(loop.census().contacts > 1);
  }
}

TEST_CASE("a bed continues from any step of a tap as if it had not been stopped") {
  for (const Container& container :
       {Container{PeriodicBox{4, 4}}, Container{WalledBox{4, 4}}, Container{Cylinder{4.5}},
        Container{PeriodicBox{2.05, 6}}, Container{Plates{4, 3.5}}}) {
    for (const ContactLaw& law :
         {ContactLaw{WaltonBraun{}}, ContactLaw{WaltonBraun{.friction = 0}},
          ContactLaw{LinearSpringDashpot{}}, ContactLaw{LinearSpringDashpot{.friction = 0}}}) {
      CAPTURE(container.index(), law.index());
      const ReducedSettings units = settings(law, 1);
      GrainLoop straight = loop_of(container, units, fallen_grains(container, 90));
      straight.run(8000);
      straight.begin_motion({0.4, 0.35, 1});
      for (const int steps : {1, 399, 2000, 1801}) {
        const GrainLoop::State saved = straight.state();
        GrainLoop resumed(container, units);
        resumed.restore(saved);
        straight.run(static_cast<std::uint64_t>(steps));
        resumed.run(static_cast<std::uint64_t>(steps));
        CHECK(is_same(resumed.state().grains, straight.state().grains));
        CHECK(resumed.energies().friction == straight.energies().friction);
        CHECK(resumed.energies().latched == straight.energies().latched);
        CHECK(resumed.energies().floor_work == straight.energies().floor_work);
        CHECK(resumed.greatest_overlap() == straight.greatest_overlap());
      }
      CHECK(straight.is_sound());
    }
  }
}

TEST_CASE("the ledger of a tap closes to a thousandth") {
  CHECK(missing_of_tap({6, 6}, 300, 12, WaltonBraun{}, 1) < 1e-3);
}

TEST_CASE("the ledger of a tap closes, and better as the step shrinks", "[slow]") {
  const PeriodicBox box{6, 6};
  const auto missing = [&](const ContactLaw& law, double finer) {
    return missing_of_tap(box, 300, 12, law, finer);
  };
  const WaltonBraun latched{};
  const double coarse = missing(latched, 1), fine = missing(latched, 8);
  CAPTURE(coarse, fine);
  CHECK(coarse < 1e-3);
  CHECK(fine < coarse / 16);  // second order: 64
  CHECK(missing(LinearSpringDashpot{}, 1) < 2e-3);
}

TEST_CASE("the ledger of a tap of 3456 grains closes to a thousandth", "[nightly]") {
  const auto missing = [](double finer) {
    return missing_of_tap({12, 12}, 3456, 20, WaltonBraun{}, finer);
  };
  const double coarse = missing(1), fine = missing(2);
  CAPTURE(coarse, fine);
  CHECK(coarse < 1e-3);
  CHECK(fine < coarse);
}

TEST_CASE("a sphere in the hollow of three stays there") {
  const ReducedSettings units = settings(WaltonBraun{.friction = 0.6}, 1);
  const PeriodicBox box{8, 8};
  const double side = 1.02, depth = std::sqrt(1 - side * side / 3);
  GrainLoop loop = loop_of(box, units,
                           {grain({3, 3, 0.5}), grain({3 + side, 3, 0.5}),
                            grain({3 + 0.5 * side, 3 + 0.5 * std::sqrt(3.0) * side, 0.5}),
                            grain({3 + 0.5 * side, 3 + side / (2 * std::sqrt(3.0)), 0.5 + depth})});
  loop.run(50'000);
  const auto settled = loop.state().grains;
  loop.run(1'000'000);
  const auto state_after = loop.state().grains;
  for (int i = 0; i < 4; ++i) CHECK(length(state_after[i].centre - settled[i].centre) < 1e-4);
  CHECK(state_after[3].centre.z > 0.5 + 0.9 * depth);
}

TEST_CASE("a bed at rest stays as it is") {
  const PeriodicBox box{5, 5};
  const ReducedSettings units = settings(WaltonBraun{}, 1);
  GrainLoop loop(box, units);
  loop.load(dilute_column(box, 200, 11));
  loop.run(120'000);
  Packing packing_before, packing_after;
  loop.store(packing_before);
  const double held = loop.energies().held();
  loop.run(200'000);
  loop.store(packing_after);
  CHECK(std::abs(mean_height(packing_after) - mean_height(packing_before)) < 2e-5);
  CHECK(loop.energies().held() <= held * (1 + 1e-9));
}

// Latched springs ring on, by some 1e-5 of a diameter: where a bed is, is the mean over many
// periods.
double mean_height_while_ringing(GrainLoop& loop) {
  constexpr int looks = 400;
  double sum = 0;
  for (int k = 0; k < looks; ++k) {
    loop.run(50);
    Packing bed;
    loop.store(bed);
    sum += mean_height(bed);
  }
  return sum / looks;
}

TEST_CASE("a bed left alone for a million steps stays where it is", "[slow]") {
  const PeriodicBox box{5, 5};
  for (const double friction : {0.0, 0.1, 0.5}) {
    CAPTURE(friction);
    GrainLoop loop(box, settings(WaltonBraun{.friction = friction}, 1));
    loop.load(dilute_column(box, 200, 11));
    loop.run(300'000);
    const double previous = mean_height_while_ringing(loop);
    const double held = loop.energies().held();
    loop.run(980'000);
    CHECK(std::abs(mean_height_while_ringing(loop) - previous) < 1e-6);
    CHECK(loop.energies().held() <= held);
  }
}

TEST_CASE("without friction nothing spins") {
  const PeriodicBox box{4, 4};
  GrainLoop loop(box, settings(WaltonBraun{.friction = 0}, 1));
  loop.load(dilute_column(box, 60, 2));
  loop.run(10'000);
  for (const GrainState& grain : loop.state().grains) CHECK(grain.spin == Vec3{});
  CHECK(loop.energies().friction == 0);
}

TEST_CASE("spheres that start deep in each other are found where no sphere can be") {
  const WalledBox box{4, 4};
  const ReducedSettings units = settings(WaltonBraun{}, 1);
  GrainLoop loop = loop_of(box, units, {grain({2, 2, 2}), grain({2, 2, 2.0001})});
  loop.run(5000);
  CHECK_FALSE(loop.is_sound());
}
