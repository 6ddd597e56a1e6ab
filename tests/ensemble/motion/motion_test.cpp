#include "ensemble/motion/motion.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>

#include "engine/bed/boundary.hpp"
#include "ensemble/motion/motion_records.hpp"
#include "ensemble/realization.hpp"
#include "tests/ensemble/bits.hpp"
#include "tests/ensemble/noise.hpp"
#include "tests/ensemble/small_plans.hpp"

using namespace jostle;

namespace {

// Spheres that are moved by hand, and followed as they are in a run.
class Moved {
 public:
  Moved(const MotionSettings& settings, Packing bed) : settings_(settings), bed_(std::move(bed)) {
    follow_motion(settings_, bed_, 0, state_);
  }

  template <class Step>
  void tap(const Step& step) {
    const Boundary boundary(bed_.container);
    for (std::size_t i = 0; i < bed_.centres.size(); ++i)
      bed_.centres[i] = wrapped(boundary, bed_.centres[i] + step(i));
    follow_motion(settings_, bed_, ++taps_, state_);
  }

  const MotionState& state() const { return state_; }
  MotionRecords records() const {
    MotionRecords found(settings_, static_cast<std::uint32_t>(bed_.centres.size()), 1);
    found.add(0, state_, bed_.container);
    return found;
  }

 private:
  MotionSettings settings_;
  Packing bed_;
  MotionState state_;
  std::uint64_t taps_ = 0;
};

Packing scattered(const Container& container, std::size_t n, Vec3 size, RandomStream& random) {
  Packing bed{container, {}};
  for (std::size_t i = 0; i < n; ++i)
    bed.centres.push_back(
        {size.x * random.uniform(), size.y * random.uniform(), size.z * random.uniform()});
  return bed;
}

MotionSettings settings_for(const Plan& plan) {
  MotionSettings settings{
      .origins = {0, 1, 3}, .lags = {1, 2, 4}, .overlap_lengths = {0.05, 0.2}, .layers = 4};
  std::erase_if(settings.lags, [&](std::uint64_t lag) { return lag > total_taps(plan); });
  return settings;
}

// Keeps positions of every tap, and computes the results from them by sums of nearest-image steps.
class Twin {
 public:
  Twin(const Plan& plan, const std::vector<SnapshotRecord>& snapshots) : boundary_(plan.container) {
    for (const SnapshotRecord& snapshot : snapshots) positions_.push_back(snapshot.centres);
  }

  std::vector<Vec3> displacements(std::uint64_t origin, std::uint64_t lag) const {
    std::vector<Vec3> sums(positions_.front().size());
    for (std::uint64_t tap = origin; tap < origin + lag; ++tap)
      for (std::size_t i = 0; i < sums.size(); ++i)
        sums[i] = sums[i] + separation(boundary_, positions_.at(tap + 1)[i], positions_.at(tap)[i]);
    return sums;
  }
  double height(std::uint64_t tap, std::size_t i) const { return positions_[tap][i].z; }

 private:
  Boundary boundary_;
  std::vector<std::vector<Vec3>> positions_;
};

template <class Of>
double mean(const std::vector<Vec3>& displacements, const Of& value_of) {
  double sum = 0;
  for (const Vec3& d : displacements) sum += value_of(d);
  return sum / static_cast<double>(displacements.size());
}

void check_bed(const MotionRecords& found, const std::vector<Vec3>& moved, std::size_t o,
               std::size_t l) {
  const auto value = [&](const char* name, std::size_t place = 0) {
    return found.row(name, o, l, place)[0];
  };
  const double settling = mean(moved, [](Vec3 d) { return d.z; });
  CHECK(value("mean_displacement", 0) ==
        Approx(mean(moved, [](Vec3 d) { return d.x; })).margin(1e-12));
  CHECK(value("mean_displacement", 2) == Approx(settling).margin(1e-12));
  CHECK(value("square_displacement", 1) ==
        Approx(mean(moved, [](Vec3 d) { return d.y * d.y; })).margin(1e-12));
  CHECK(value("square_displacement", 2) ==
        Approx(mean(moved, [](Vec3 d) { return d.z * d.z; })).margin(1e-12));
  const auto lateral = [](Vec3 d) { return std::hypot(d.x, d.y); };
  CHECK(value("lateral_quartic") ==
        Approx(mean(moved, [&](Vec3 d) { return std::pow(lateral(d), 4); })).margin(1e-12));
  CHECK(value("vertical_quartic") ==
        Approx(mean(moved, [&](Vec3 d) { return std::pow(d.z - settling, 4); })).margin(1e-12));
  for (std::size_t a = 0; a < found.settings.overlap_lengths.size(); ++a) {
    const double length = found.settings.overlap_lengths[a];
    CHECK(value("lateral_overlap", a) ==
          Approx(mean(moved, [&](Vec3 d) { return lateral(d) < length ? 1.0 : 0.0; })));
    CHECK(value("overlap", a) == Approx(mean(moved, [&](Vec3 d) {
            return std::hypot(d.x, d.y, d.z) < length ? 1.0 : 0.0;
          })));
  }
}

void check_layer_shapes(const MotionRecords& found, const std::vector<Vec3>& moved, std::size_t o,
                        std::size_t l, std::size_t layer) {
  const double settling = mean(moved, [](Vec3 d) { return d.z; });
  const auto lateral = [](Vec3 d) { return std::hypot(d.x, d.y); };
  CHECK(found.row("layer_lateral_quartic", o, l, layer)[0] ==
        Approx(mean(moved, [&](Vec3 d) { return std::pow(lateral(d), 4); })).margin(1e-12));
  CHECK(found.row("layer_vertical_quartic", o, l, layer)[0] ==
        Approx(mean(moved, [&](Vec3 d) { return std::pow(d.z - settling, 4); })).margin(1e-12));
  const auto& lengths = found.settings.overlap_lengths;
  for (std::size_t a = 0; a < lengths.size(); ++a) {
    const std::size_t place = lengths.size() * layer + a;
    CHECK(found.row("layer_lateral_overlap", o, l, place)[0] ==
          Approx(mean(moved, [&](Vec3 d) { return lateral(d) < lengths[a] ? 1.0 : 0.0; })));
    CHECK(found.row("layer_overlap", o, l, place)[0] == Approx(mean(moved, [&](Vec3 d) {
            return std::hypot(d.x, d.y, d.z) < lengths[a] ? 1.0 : 0.0;
          })));
  }
}

void check_layers(const MotionRecords& found, const Twin& twin, const std::vector<Vec3>& moved,
                  std::size_t o, std::size_t l) {
  const std::uint64_t origin = found.settings.origins[o];
  const std::size_t n = moved.size(), n_layers = found.settings.layers;
  std::vector<std::pair<double, std::size_t>> by_height;
  for (std::size_t i = 0; i < n; ++i) by_height.emplace_back(twin.height(origin, i), i);
  std::ranges::sort(by_height);
  for (std::size_t k = 0; k < n_layers; ++k) {
    std::vector<Vec3> of_layer;
    double height = 0;
    for (std::size_t rank = k * n / n_layers; rank < (k + 1) * n / n_layers; ++rank) {
      of_layer.push_back(moved[by_height[rank].second]);
      height += by_height[rank].first;
    }
    CHECK(found.layer_heights(o, k)[0] ==
          Approx(height / static_cast<double>(of_layer.size())).margin(1e-12));
    CHECK(found.row("layer_settling", o, l, k)[0] ==
          Approx(mean(of_layer, [](Vec3 d) { return d.z; })).margin(1e-12));
    CHECK(found.row("layer_square_displacement", o, l, 3 * k)[0] ==
          Approx(mean(of_layer, [](Vec3 d) { return d.x * d.x; })).margin(1e-12));
    CHECK(found.row("layer_square_displacement", o, l, 3 * k + 2)[0] ==
          Approx(mean(of_layer, [](Vec3 d) { return d.z * d.z; })).margin(1e-12));
    check_layer_shapes(found, of_layer, o, l, k);
  }
}

}  // namespace

TEST_CASE("Spheres that move straight on are followed through periodic sides") {
  RandomStream random = test_stream(1);
  const MotionSettings settings{
      .origins = {0, 7}, .lags = {1, 10, 100}, .overlap_lengths = {0.5}, .layers = 2};
  const FullyPeriodicBox box{4, 5, 6};
  Moved bed(settings, scattered(box, 30, {4, 5, 6}, random));
  const Vec3 velocity{0.9, -1.1, 0.4};
  for (int tap = 0; tap < 110; ++tap) bed.tap([&](std::size_t) { return velocity; });
  const MotionRecords found = bed.records();
  for (std::size_t o = 0; o < 2; ++o)
    for (std::size_t l = 0; l < 3; ++l) {
      if (settings.origins[o] + settings.lags[l] > 110) continue;
      const auto t = static_cast<double>(settings.lags[l]);
      CHECK(found.row("mean_displacement", o, l, 0)[0] == Approx(0.9 * t));
      CHECK(found.row("square_displacement", o, l, 1)[0] == Approx(1.21 * t * t));
      CHECK(found.row("square_displacement", o, l, 2)[0] == Approx(0.16 * t * t));
      CHECK(found.row("vertical_quartic", o, l)[0] == Approx(0).margin(1e-9));
      CHECK(found.row("lateral_overlap", o, l)[0] == 0);
      CHECK(found.row("layer_settling", o, l, 1)[0] == Approx(0.4 * t));
    }
  CHECK(bed.state().largest_step == Approx(0.225));
}

TEST_CASE(
    "A step of more than half a period is taken for a shorter one, and the longest is reported") {
  RandomStream random = test_stream(2);
  const MotionSettings settings{.origins = {0}, .lags = {1}, .overlap_lengths = {0.5}, .layers = 1};
  Moved far(settings, scattered(PeriodicBox{4, 4}, 5, {4, 4, 2}, random));
  far.tap([](std::size_t) { return Vec3{0, 2.2, 30}; });
  CHECK(far.records().row("mean_displacement", 0, 0, 1)[0] == Approx(-1.8));
  CHECK(far.records().row("mean_displacement", 0, 0, 2)[0] == Approx(30));
  CHECK(far.state().largest_step == Approx(0.45));
  Moved walled(settings, scattered(WalledBox{9, 9}, 5, {4, 4, 2}, random));
  walled.tap([](std::size_t) { return Vec3{0, 4.8, 0}; });
  CHECK(walled.records().row("mean_displacement", 0, 0, 1)[0] == Approx(4.8));
  CHECK(walled.state().largest_step == 0);
}

// Means over n independent spheres: standard errors from the moments of the normal law.
TEST_CASE("Random walks have the mean squares, overlaps and moments of theory") {
  constexpr std::size_t n = 20'000;
  constexpr double step = 0.05;
  RandomStream random = test_stream(3);
  const MotionSettings settings{
      .origins = {0, 20}, .lags = {1, 4, 16, 64}, .overlap_lengths = {0.1, 0.3}, .layers = 5};
  Moved bed(settings, scattered(PeriodicBox{6, 7}, n, {6, 7, 10}, random));
  for (int tap = 0; tap < 84; ++tap)
    bed.tap([&](std::size_t) {
      return Vec3{step * noise(random), step * noise(random), step * noise(random)};
    });
  const MotionRecords found = bed.records();
  const auto within_3 = [](double value, double expected, double error) {
    CHECK(std::abs(value - expected) <= 3 * error);
  };
  const auto fraction_within_3 = [&](double value, double p) {
    within_3(value, p, std::sqrt(p * (1 - p) / n) + 1e-12);
  };
  for (std::size_t o = 0; o < 2; ++o)
    for (std::size_t l = 1; l < 4; ++l) {
      const double variance = step * step * static_cast<double>(settings.lags[l]);  // 2 D t
      CAPTURE(o, l);
      for (std::size_t k = 0; k < 3; ++k)
        within_3(found.row("square_displacement", o, l, k)[0], variance,
                 variance * std::sqrt(2.0 / n));
      for (std::size_t layer = 0; layer < 5; ++layer)
        within_3(found.row("layer_square_displacement", o, l, 3 * layer)[0], variance,
                 variance * std::sqrt(10.0 / n));
      // <r^4> = 8 s^4, <r^8> = 384 s^8; <z^4> = 3 s^4, <z^8> = 105 s^8. The sums of twelve uniform
      // numbers have the fourth cumulant -s^4 / (10 t), in two directions.
      const double v2 = variance * variance, excess = 0.1 / static_cast<double>(settings.lags[l]);
      within_3(found.row("lateral_quartic", o, l)[0], v2 * (8 - 2 * excess),
               v2 * std::sqrt(320.0 / n));
      within_3(found.row("vertical_quartic", o, l)[0], v2 * (3 - excess), v2 * std::sqrt(96.0 / n));
      if (settings.lags[l] < 16) continue;  // where twelve uniform numbers pass for normal ones
      for (std::size_t a = 0; a < 2; ++a) {
        const double x = settings.overlap_lengths[a] / std::sqrt(variance);
        fraction_within_3(found.row("lateral_overlap", o, l, a)[0], 1 - std::exp(-x * x / 2));
        fraction_within_3(
            found.row("overlap", o, l, a)[0],
            std::erf(x / std::sqrt(2.0)) - std::sqrt(2 / M_PI) * x * std::exp(-x * x / 2));
      }
    }
}

TEST_CASE("The motion that a run records follows from the positions of every tap") {
  for (auto& [name, plan] : various_plans()) {
    CAPTURE(name);
    plan.motion = settings_for(plan);
    plan.snapshots.taps.clear();
    for (std::uint64_t tap = 0; tap <= total_taps(plan); ++tap) plan.snapshots.taps.push_back(tap);
    std::vector<SnapshotRecord> snapshots;
    Realization realization(plan, 0);
    while (!realization.finished()) {
      Slice slice = realization.advance(1'000'000);
      if (slice.snapshot) snapshots.push_back(std::move(*slice.snapshot));
    }
    const Twin twin(plan, snapshots);
    MotionRecords found(*plan.motion, plan.n_spheres, 1);
    found.add(0, *realization.state().motion, plan.container);
    for (std::size_t o = 0; o < plan.motion->origins.size(); ++o)
      for (std::size_t l = 0; l < plan.motion->lags.size(); ++l) {
        const std::uint64_t origin = plan.motion->origins[o], lag = plan.motion->lags[l];
        if (origin + lag > total_taps(plan)) {
          CHECK(std::isnan(found.row("lateral_quartic", o, l)[0]));
          continue;
        }
        const std::vector<Vec3> moved = twin.displacements(origin, lag);
        CHECK(mean(moved, [](Vec3 d) { return norm_squared(d); }) > 0);
        check_bed(found, moved, o, l);
        check_layers(found, twin, moved, o, l);
      }
  }
}

TEST_CASE("Following the motion changes nothing else, and continues bit for bit") {
  RandomStream random(stream_key(8, 0, 0, Purpose::start));
  for (auto& [name, plan] : various_plans()) {
    CAPTURE(name);
    Realization plain(plan, 0);
    while (!plain.finished()) plain.advance(1'000'000);
    plan.motion = settings_for(plan);
    Realization straight(plan, 0);
    while (!straight.finished()) straight.advance(1'000'000);
    RealizationState bare = straight.state();
    bare.motion.reset();
    Bits all, equal_bits;
    all.add(plain.state());
    equal_bits.add(bare);
    CHECK(all == equal_bits);
    auto interrupted = std::make_unique<Realization>(plan, 0);
    while (!interrupted->finished()) {
      interrupted->advance(random.integer_below(20 * plan.n_spheres));
      if (random.integer_below(3) == 0)
        interrupted = std::make_unique<Realization>(plan, 0, interrupted->state());
    }
    CHECK(interrupted->state().motion == straight.state().motion);
  }
}

TEST_CASE("More taps later give what they give at once") {
  Plan plan = small_plan();
  plan.motion =
      MotionSettings{.origins = {0, 1}, .lags = {1, 2}, .overlap_lengths = {0.1}, .layers = 3};
  Plan longer = plan;
  longer.protocol.push_back({Lift{.gamma = 0.2}, 3});
  longer.motion->origins.push_back(6);
  longer.motion->lags.push_back(7);
  Realization first(plan, 0);
  while (!first.finished()) first.advance(1'000'000);
  Realization resumed(longer, 0, first.state()), straight(longer, 0);
  while (!resumed.finished()) resumed.advance(1'000'000);
  while (!straight.finished()) straight.advance(1'000'000);
  CHECK(resumed.state().motion == straight.state().motion);
  CHECK(straight.state().motion->origins.size() == 3);
  CHECK(straight.state().motion->origins[1].values.size() == 3 * n_motion_values(*longer.motion));
}

TEST_CASE("Layers have the sizes of their spheres' ranks") {
  for (const std::uint64_t n : {1u, 7u, 48u, 100u})
    for (const std::uint32_t n_layers : {1u, 3u, 7u, 12u}) {
      std::vector<std::uint64_t> counted(n_layers);
      for (const std::uint32_t layer : layers_of(std::vector<double>(n), n_layers))
        ++counted[layer];
      CHECK(layer_sizes(n, n_layers) == counted);
    }
}
