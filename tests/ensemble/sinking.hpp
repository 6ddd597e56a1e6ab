#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "engine/bytes.hpp"
#include "engine/column.hpp"
#include "engine/dynamics.hpp"
#include "ensemble/plan.hpp"

namespace jostle {

/// An engine of one dimension, for tests of the seam: spheres in a single file sink through a
/// viscous fluid. A unit is a step, in which every gap below a sphere shrinks to a random share of
/// itself; the file is at rest once all gaps together are below 1e-6 diameters.
class Sinking final : public Dynamics {
 public:
  static constexpr std::uint32_t version = 0x53000001;
  static std::vector<Column> columns() {
    return {{.name = "steps",
             .units = "1",
             .long_name = "steps until at rest",
             .source = "tests",
             .shown = Shown::mean,
             .decimals = 1},
            {.name = "late",
             .units = "1",
             .long_name = "1 where 100 steps were too few",
             .source = "tests",
             .shown = Shown::count,
             .if_any = "{} taps were late",
             .if_none = "no tap was late"}};
  }

  explicit Sinking(StreamKey key) : key_(key), random_(key) {}

  void load(const Packing& bed) override { bed_ = bed; }
  void settle(const Start&) override { begin(); }
  void tap(const Tap& tap, RandomStream& random) override {
    excite(bed_, tap, random);
    begin();
  }
  DynamicsStatus advance(std::uint64_t units) override {
    for (; status_ == DynamicsStatus::running && units > 0; --units) step();
    return status_;
  }
  void store(Packing& bed) const override { bed = bed_; }
  std::vector<double> diagnostics() const override {
    return {static_cast<double>(steps_), status_ == DynamicsStatus::capped ? 1.0 : 0.0};
  }
  Effort effort() const override { return effort_; }
  std::uint64_t units_per_slice() const override { return 10; }
  std::size_t bytes() const override { return bed_.centres.size() * sizeof(Vec3); }

  std::vector<std::byte> save() const override {
    ByteWriter writer;
    writer.put(version);
    writer.put(status_);
    writer.put(steps_);
    writer.put(random_.position());
    return std::move(writer.bytes());
  }
  void restore(std::span<const std::byte> state) override {
    ByteReader reader(state);
    if (state.size() != 24 || reader.get<std::uint32_t>() != version) {
      throw StateError("not a state of sinking spheres");
    }
    status_ = reader.get_enum(DynamicsStatus::capped);
    steps_ = reader.get<std::uint64_t>();
    random_ = RandomStream(key_, reader.get<std::uint64_t>());
  }

 private:
  void begin() {
    status_ = DynamicsStatus::running;
    steps_ = 0;
  }

  void step() {
    double depth = -sphere_radius, sunk = 0, gaps = 0;
    for (Vec3& r : bed_.centres) {
      const double gap = r.z - sunk - (depth + 1);
      const double left = gap * random_.uniform();
      r.z -= sunk += gap - left;
      gaps += left;
      depth = r.z;
      ++effort_.pair_tests;
    }
    ++steps_;
    ++effort_.units;
    if (gaps < 1e-6) {
      status_ = DynamicsStatus::settled;
    } else if (steps_ == 100) {
      status_ = DynamicsStatus::capped;
    }
  }

  Packing bed_;
  StreamKey key_;
  RandomStream random_;
  DynamicsStatus status_ = DynamicsStatus::running;
  std::uint64_t steps_ = 0;  // steps of this tap
  Effort effort_;
};

/// A file of eight spheres, lifted and stretched; its mean height is observed.
inline Plan sinking_plan() {
  Plan plan;
  plan.container = Cylinder{1.5};
  plan.n_spheres = 8;
  auto file = std::make_shared<std::vector<Vec3>>();
  for (int i = 0; i < 8; ++i) file->push_back({0.75, 0.75, 0.6 + 1.1 * i});
  plan.start = GivenPacking{file};
  plan.protocol = {{Lift{0.25}, 3}, {Dilate{0.1}, 3}};
  plan.observables = {MeanHeight{}};
  plan.snapshots.taps = {0, 4};
  return plan;
}

inline std::unique_ptr<Dynamics> sinking(const Plan& plan, std::uint32_t realization) {
  return std::make_unique<Sinking>(
      stream_key(plan.seed, plan.point_id, realization, Purpose::trials));
}

}  // namespace jostle
