#include "synthetic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace jostle::synthetic {
namespace {

constexpr std::uint64_t steps_a_tap = 3;

double noise(std::uint64_t a, std::uint64_t b) {
  std::uint64_t h = a * 0x9e3779b97f4a7c15u ^ (b + 0x165667b19e3779f9u);
  h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9u;
  h = (h ^ (h >> 27)) * 0x94d049bb133111ebu;
  return static_cast<double>((h ^ (h >> 31)) >> 11) * 0x1p-53;
}

/// The engine of these realizations, as the bytes that a state keeps of it.
struct Engine {
  std::uint64_t steps = 0;  // since the tap
  std::uint64_t next_trial = 0;
  double step = 0.1;
};

Engine engine_of(const RealizationState& state) {
  Engine engine;
  std::memcpy(&engine, state.engine.data(), sizeof engine);
  return engine;
}

void keep(RealizationState& state, const Engine& engine) {
  state.engine.resize(sizeof engine);
  std::memcpy(state.engine.data(), &engine, sizeof engine);
}

RealizationState begin_state(const StudyPoint& point, RealizationId id) {
  RealizationState state;
  for (std::uint32_t i = 0; i < point.n_spheres; ++i)
    state.centres.push_back({noise(i, id.realization), noise(i, point.id), 0.5 + i});
  if (point.mixture && point.mixture->drawn())
    for (std::uint32_t i = 0; i < point.n_spheres; ++i)
      state.diameters.push_back(0.8 + 0.4 * noise(1000 + i, 7 * point.id + id.realization));
  keep(state, {});
  state.observable_windows = {{0, 0}, {1, 3}};
  state.fitting = {.spheres_moved = 3.0 + id.realization,
                   .mean_rise = 1.5,
                   .corrected_fraction_before = 0.58,
                   .corrected_fraction_after = 0.51,
                   .central_fraction_before = std::nan(""),
                   .central_fraction_after = noise(id.realization, point.id)};
  return state;
}

/// One step of a relaxation, by numbers that the state alone decides.
void step(RealizationState& state) {
  Engine engine = engine_of(state);
  for (Vec3& r : state.centres) {
    r.x = noise(++engine.next_trial, static_cast<std::uint64_t>(1e6 * r.x));
    r.z *= 1 + 1e-3 * (r.x - 0.5);
  }
  engine.step *= 0.995;
  ++engine.steps;
  keep(state, engine);
}

TapRow row_of(const RealizationState& state) {
  TapRow row{.tap = state.rows, .observables = {0, 0}, .diagnostics = {}};
  for (const Vec3 r : state.centres) {
    row.observables[0] += r.z;
    row.observables[1] += r.x;
  }
  const Engine engine = engine_of(state);
  row.diagnostics = {static_cast<double>(engine.steps),
                     state.rows == 0 ? -std::nan("") : engine.step, 0,
                     0.125 * static_cast<double>(state.rows)};
  return row;
}

SnapshotRecord snapshot_of(const RealizationState& state) {
  SnapshotRecord record{
      state.rows, state.centres, state.centres[0].x, {0.25, 0, state.centres[1].x}};
  const auto n = static_cast<std::uint32_t>(state.centres.size());
  for (const Vec3& r : state.centres) {
    record.velocities.push_back({r.x - 0.5, -r.x, 1e-3 * r.z});
    record.spins.push_back({r.z, 0, -r.x});
  }
  // Any number, also none.
  const auto n_contacts = static_cast<std::uint32_t>(static_cast<double>(n) * state.centres[0].x);
  for (std::uint32_t i = 0; i < n_contacts; ++i)
    record.contacts.push_back({i,
                               i % 2 == 0 ? i + 1 : n,
                               1e-4 * state.centres[i].x,
                               1.0 + i,
                               {0, 0, -1},
                               {state.centres[i].x, 0.25, 0}});
  const double nan = std::nan("");
  record.temperature_lateral = {nan, state.centres[0].x};
  record.temperature_vertical = {nan, 2 * state.centres[0].x};
  record.driven_fraction = {0.5, 0, state.centres[0].x};
  record.driven_lateral = {nan, 3 * state.centres[0].x};
  record.driven_vertical = {4 * state.centres[0].x};
  record.forces.emplace();
  for (std::size_t k = 0; k < 9; ++k)
    record.forces->moment[k] = static_cast<double>(k) + state.centres[0].x;
  record.forces->walls = {{5.5, {0.5, state.centres[0].x, 0}}};
  return record;
}

/// Records the tap that is due and leaves the state between relaxations.
void record(Sink& sink, const StudyPoint& point, RealizationId id, RealizationState& state) {
  const auto& taps = point.snapshots.taps;
  if (std::binary_search(taps.begin(), taps.end(), state.rows))
    sink.snapshot(id, snapshot_of(state));
  sink.append(id, row_of(state));
  ++state.rows;
  state.relaxing = false;
  Engine engine = engine_of(state);
  engine.steps = 0;
  keep(state, engine);
}

class Rows : public Sink {
 public:
  std::optional<RealizationState> begin(RealizationId) override { return std::nullopt; }
  void append(RealizationId, const TapRow& row) override { rows.push_back(row); }
  void snapshot(RealizationId, const SnapshotRecord&) override {}
  void checkpoint(RealizationId, const RealizationState&, const Work&) override {}
  void end(RealizationId, const RealizationState&, const Outcome&) override {}

  std::vector<TapRow> rows;
};

}  // namespace

namespace {

std::shared_ptr<const PointSpheres> spheres(const StudySize& sizes) {
  if (sizes.kinds == StudySpheres::equal) return nullptr;
  PointSpheres spheres{{{"small", 1}, {"large", 2.5}}, {}, {}};
  for (std::uint32_t i = 0; i < sizes.spheres; ++i) {
    spheres.kind_of.push_back(i % 2);
    if (sizes.kinds == StudySpheres::fixed) spheres.diameters.push_back(1 + 0.4 * (i % 2));
  }
  return std::make_shared<const PointSpheres>(std::move(spheres));
}

}  // namespace

Study study(const StudySize& sizes) {
  const auto mixture = spheres(sizes);
  Study study;
  study.scene = "{\"name\": \"synthetic\"} // as typed, with an \xc3\xbc\n";
  study.resolved_scene = fmt::format("taps {}, realizations {}", sizes.taps, sizes.realizations);
  study.realizations = sizes.realizations;
  for (std::uint32_t p = 0; p < sizes.points; ++p) {
    StudyPoint point{.label = fmt::format("epsilon = {}", p),
                     .sweep_values = {{"/tap/epsilon", fmt::format("{}", p)}},
                     .id = 0xfedcba9876543210u + p,
                     .seed = 7,
                     .container = PeriodicBox{4, 5},
                     .n_spheres = sizes.spheres,
                     .taps = sizes.taps,
                     .observables = {{"mean_height", "diameter", "mean height", "a paper"},
                                     {"bulk_fraction", "1", "bulk fraction", "another"}},
                     .diagnostics = columns(MonteCarlo{}),
                     .snapshots = {}};
    point.snapshots.taps = sizes.snapshot_taps;
    point.snapshots.velocities = point.snapshots.contacts = true;
    point.snapshots.granular_temperature = point.snapshots.forces = true;
    point.snapshots.driven_temperature = true;
    point.mixture = mixture;
    study.points.push_back(point);
  }
  return study;
}

void run(Sink& sink, const Study& study, RealizationId id, const Conduct& conduct) {
  const StudyPoint& point = study.points[id.point];
  const auto last = sink.begin(id);
  RealizationState state = last ? *last : begin_state(point, id);
  if (!last) record(sink, point, id, state);
  std::uint64_t steps = 0;
  while (state.rows <= point.taps) {
    if (state.rows == conduct.fail_at_tap)
      return sink.end(
          id, state, {RealizationStatus::failed, "requested by the test", {0.5, 0.25, {steps, 0}}});
    if (steps == conduct.steps) {
      if (conduct.leave_without_end) return;
      return sink.end(id, state, {RealizationStatus::running, "", {0.5, 0.25, {steps, 0}}});
    }
    state.relaxing = true;
    step(state);
    if (engine_of(state).steps == steps_a_tap) record(sink, point, id, state);
    if (++steps % conduct.checkpoint_every == 0)
      sink.checkpoint(id, state, {0.0625 * double(steps), 0.03125, {steps, 0}});
  }
  sink.end(id, state, {RealizationStatus::done, "", {0.5, 0.25, {steps, 2 * steps}}});
}

TapRow expected_row(const Study& study, RealizationId id, std::uint64_t tap) {
  Rows rows;
  run(rows, study, id);
  return rows.rows.at(tap);
}

Provenance provenance() {
  Provenance provenance = provenance_of_this_machine();
  provenance.version = std::string("0");
  provenance.command_line = "test";
  return provenance;
}

}  // namespace jostle::synthetic
