#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <string>

#include "engine/engines.hpp"
#include "engine/starts/starts.hpp"

using namespace jostle;

namespace {

constexpr std::uint32_t n_spheres = 60;
const Container narrow_box = PeriodicBox{3.5, 3.5};

Packing column(const Container& container, std::uint32_t n) {
  RandomStream random(stream_key(20260107, 0, 0, Purpose::start));
  return make_start(RandomSettle{0.2}, container, n, random);
}

/// A bed of grains by the columns that are recorded of its taps.
class Bed {
 public:
  Bed(const DiscreteElement& settings, const Packing& start)
      : dynamics_(make_dynamics(EngineSettings{settings}, {})) {
    for (const Column& column : columns(EngineSettings{settings})) names_.push_back(column.name);
    dynamics_->load(start);
    dynamics_->settle(RandomSettle{});
    rest();
  }
  void tap(const Tap& tap) {
    RandomStream random(stream_key(1, 0, 0, Purpose::tap));
    dynamics_->tap(tap, random);
    rest();
  }
  double operator[](const std::string& name) const { return values_.at(name); }
  Packing packing() const {
    Packing bed;
    dynamics_->store(bed);
    return bed;
  }
  double mean_height() const {
    double sum = 0;
    const Packing bed = packing();
    for (const Vec3& r : bed.centres) sum += r.z;
    return sum / static_cast<double>(bed.centres.size());
  }
  double highest_since = 0;  // mean height, in the last tap

 private:
  void rest() {
    highest_since = 0;
    while (dynamics_->advance(50'000) == DynamicsStatus::running)
      highest_since = std::max(highest_since, mean_height());
    const std::vector<double> values = dynamics_->diagnostics();
    for (std::size_t k = 0; k < values.size(); ++k) values_[names_[k]] = values[k];
  }

  std::unique_ptr<Dynamics> dynamics_;
  std::vector<std::string> names_;
  std::map<std::string, double> values_;
};

// Came to rest, with the energy accounted for.
void check_sound(const Bed& bed, double ledger = 5e-3) {
  CHECK(bed["capped"] == 0);
  CHECK(std::abs(bed["ledger_error"]) < ledger);
  CHECK(bed["greatest_overlap"] < 0.2);
  CHECK(bed["kinetic_energy"] < QuietRest{}.kinetic_energy);
}

}  // namespace

TEST_CASE("grains with every friction from none to ten come to rest and are tapped") {
  double previous = 1;
  for (const double friction : {0.0, 1.0, 10.0}) {
    CAPTURE(friction);
    DiscreteElement settings;
    settings.spheres = WaltonBraun{.friction = friction};
    Bed bed(settings, column(narrow_box, n_spheres));
    check_sound(bed);
    CHECK(bed["contacts"] > 3);
    CHECK((bed["friction_energy"] > 0) == (friction > 0));
    bed.tap(HalfSine{0.4413, 7.5});
    check_sound(bed);
    previous = bed.mean_height();
  }
  CHECK(previous > 1);
}

TEST_CASE("grains of a stiffness over four decades") {
  double overlap = 1;
  for (const double stiffness : {3e3, 3e4, 3e5, 3e6, 3e7}) {
    CAPTURE(stiffness);
    DiscreteElement settings;
    settings.spheres = WaltonBraun{.stiffness = stiffness};
    Bed bed(settings, column(narrow_box, 24));
    check_sound(bed);
    CHECK(bed["greatest_overlap"] <
          0.5 * overlap);  // in proportion to the root of the stiffness at equal speeds
    overlap = bed["greatest_overlap"];
  }
}

TEST_CASE("grains that hardly rebound, and grains that lose nothing") {
  DiscreteElement settings;
  settings.spheres = WaltonBraun{.restitution = 0.05};
  settings.most_seconds = 0.8;
  // In steps of a twentieth. K2 is 400 K1: of few spheres on the floor what was latched rings on,
  // and quiet is not reached.
  Bed bed(settings, column(narrow_box, 8));
  for (int tap = 0; tap < 2; ++tap) {
    CHECK(std::abs(bed["ledger_error"]) < 5e-3);
    CHECK(bed["greatest_overlap"] < 0.2);
    CHECK(bed["kinetic_energy"] < 5e-3);
    bed.tap(HalfSine{0.4413, 7.5});
  }
  // Elastic and without friction: never at rest, its energy stays.
  settings.spheres = WaltonBraun{.restitution = 1, .friction = 0};
  settings.most_seconds = 1;
  Bed elastic(settings, column(narrow_box, n_spheres));
  CHECK(elastic["capped"] == 1);
  CHECK(elastic["latched_energy"] == 0);
  CHECK(elastic["friction_energy"] == 0);
  CHECK(std::isnan(elastic["ledger_error"]));
  double potential = 0;
  for (const Vec3& r : column(narrow_box, n_spheres).centres) potential += r.z / n_spheres;
  const double held = elastic.mean_height() + elastic["kinetic_energy"] + elastic["elastic_energy"];
  CHECK(held == Approx(potential).epsilon(2e-3));
}

TEST_CASE("one grain and two") {
  for (const std::uint32_t n : {1u, 2u}) {
    for (const ContactLaw& law : {ContactLaw{WaltonBraun{}}, ContactLaw{LinearSpringDashpot{}}}) {
      CAPTURE(n, law.index());
      DiscreteElement settings;
      settings.spheres = law;
      settings.most_seconds = 20;
      Bed bed(settings, column(narrow_box, n));
      CHECK(bed["capped"] == 0);
      CHECK(bed.mean_height() == Approx(0.5).margin(2e-3));
      bed.tap(HalfSine{0.4413, 7.5});
      CHECK(bed["capped"] == 0);
      CHECK(bed["input_energy"] > 0);
      CHECK(bed.mean_height() == Approx(0.5).margin(2e-3));
    }
  }
}

// The corner of the range of Rosato et al. 2010, fig. 15: Gamma = 313.
TEST_CASE("grains shaken at 90 Hz by half a diameter") {
  DiscreteElement settings;
  Bed bed(settings, column(narrow_box, n_spheres));
  bed.tap(Vibration{0.48, 90, 30});
  check_sound(bed);
  CHECK(bed["input_energy"] > 10);  // m g d a sphere
  CHECK(bed.highest_since > 2 * bed.mean_height());
}

// At the bottom of its path the floor is further below its place than a sphere may fall through it.
TEST_CASE("grains on a floor that goes two diameters down and up") {
  DiscreteElement settings;
  Bed bed(settings, column(narrow_box, n_spheres));
  bed.tap(Vibration{2, 4, 10});
  check_sound(bed);
  CHECK(bed["capped"] == 0);
  CHECK(bed["input_energy"] > 0);
}

TEST_CASE("a bed without a lid that is thrown a hundred diameters high comes down") {
  DiscreteElement settings;
  settings.spheres = WaltonBraun{.stiffness = 1e6};
  settings.most_seconds = 10;
  Bed bed(settings, column(narrow_box, n_spheres));
  // Speed sqrt(2 x 100 g d) and more at once: a 2 pi f.
  bed.tap(HalfSine{5, 10.5});
  check_sound(bed);
  CHECK(bed.highest_since > 100);
  CHECK(bed.mean_height() < 4);
}

TEST_CASE("a grain that breaks through a wall ends its realization with a reason") {
  DiscreteElement settings;
  settings.spheres = WaltonBraun{.stiffness = 100};
  const Container duct = WalledBox{3.5, 3.5};
  Bed bed(settings, {duct, {{1, 1, 0.5}, {2.4, 1, 0.5}}});
  CHECK_THROWS_WITH(bed.tap(HalfSine{90, 2}), Catch::Contains("left the container") &&
                                                  Catch::Contains("raise the stiffness"));
}

TEST_CASE("grains at rest for ten million steps stay where they are", "[nightly]") {
  DiscreteElement settings;
  const double step = contact_times(settings).step_seconds;
  settings.rest = TimedRest{3};
  settings.most_seconds = 1e4;
  const Bed settled(settings, column(narrow_box, n_spheres));
  settings.rest = TimedRest{3 + 1e7 * step};
  const Bed bed(settings, column(narrow_box, n_spheres));
  CHECK(bed.mean_height() == Approx(settled.mean_height()).margin(1e-6));
  // It loses what still rings, and gains nothing.
  const auto held = [](const Bed& sample) {
    return sample.mean_height() + sample["kinetic_energy"] + sample["elastic_energy"];
  };
  CHECK(held(bed) <= held(settled));
  CHECK(held(settled) - held(bed) < 1e-4);
  const Packing a = settled.packing(), b = bed.packing();
  double farthest = 0;
  for (std::size_t i = 0; i < a.centres.size(); ++i)
    farthest = std::max(farthest, std::abs(a.centres[i].z - b.centres[i].z));
  CHECK(farthest < 1e-3);
}
