#include "results/checkpoints/part_content.hpp"

#include <stdexcept>
#include <utility>

namespace jostle::inline results {

namespace {

// Leads the bytes of a state; counts up when they change, from a number that no older state, which
// began with its rows, can begin with.
constexpr std::uint32_t state_format = 0xf0000004, state_format_with_motion = 0xf0000005;
// States of mixtures with drawn diameters, which follow all else.
constexpr std::uint32_t state_format_with_diameters = 0xf0000006,
                        state_format_with_motion_and_diameters = 0xf0000007;

std::uint32_t format_of(const RealizationState& state) {
  if (state.diameters.empty()) return state.motion ? state_format_with_motion : state_format;
  return state.motion ? state_format_with_motion_and_diameters : state_format_with_diameters;
}

}  // namespace

std::size_t SeriesPiece::bytes() const {
  std::size_t n = rows.size() * sizeof(double);
  for (const SnapshotRecord& record : snapshots) {
    n += 512 + record.contacts.size() * sizeof(Contact);
    for (const SphereVector& vector : sphere_vectors)
      n += (record.*vector.values).size() * sizeof(Vec3);
    for (const HeightProfile& profile : height_profiles)
      n += (record.*profile.values).size() * sizeof(double);
  }
  return n;
}

namespace {

void put(ByteWriter& writer, const MotionState& motion) {
  writer.put(motion.unwrapped);
  writer.put(motion.largest_step);
  writer.put<std::uint64_t>(motion.origins.size());
  for (const MotionOrigin& origin : motion.origins) {
    writer.put(origin.tap);
    writer.put(origin.centres);
    writer.put(origin.values);
  }
}

MotionState get_motion(ByteReader& reader) {
  MotionState motion;
  motion.unwrapped = reader.get_vector<Vec3>();
  motion.largest_step = reader.get<double>();
  const auto n_origins = reader.get<std::uint64_t>();
  for (std::uint64_t i = 0; i < n_origins; ++i) {
    MotionOrigin origin;
    origin.tap = reader.get<std::uint64_t>();
    origin.centres = reader.get_vector<Vec3>();
    origin.values = reader.get_vector<double>();
    motion.origins.push_back(std::move(origin));
  }
  return motion;
}

}  // namespace

void put(ByteWriter& writer, const RealizationState& state) {
  writer.put(format_of(state));
  writer.put(state.rows);
  writer.put(state.relaxing);
  writer.put(state.engine);
  writer.put(state.tap_stream_position);
  writer.put(state.observable_windows);
  writer.put(state.fitting.has_value());
  for (const FittingColumn& column : fitting_columns) {
    if (state.fitting) writer.put((*state.fitting).*column.field);
  }
  writer.put(state.centres);
  if (state.motion) put(writer, *state.motion);
  if (!state.diameters.empty()) writer.put(state.diameters);
}

RealizationState get_realization_state(ByteReader& reader) {
  const auto format = reader.get<std::uint32_t>();
  if (format < state_format || format > state_format_with_motion_and_diameters)
    throw std::out_of_range("a state of another version of the program");
  RealizationState state;
  state.rows = reader.get<std::uint64_t>();
  state.relaxing = reader.get_flag();
  state.engine = reader.get_vector<std::byte>();
  state.tap_stream_position = reader.get<std::uint64_t>();
  state.observable_windows = reader.get_vector<HeightWindow>();
  if (reader.get_flag()) {
    state.fitting.emplace();
    for (const FittingColumn& column : fitting_columns)
      (*state.fitting).*column.field = reader.get<double>();
  }
  state.centres = reader.get_vector<Vec3>();
  const bool has_motion =
      format == state_format_with_motion || format == state_format_with_motion_and_diameters;
  if (has_motion) state.motion = get_motion(reader);
  if (format >= state_format_with_diameters) state.diameters = reader.get_vector<double>();
  return state;
}

void put(ByteWriter& writer, const SeriesPiece& piece) {
  writer.put(piece.first_row);
  writer.put(piece.rows);
  writer.put<std::uint64_t>(piece.snapshots.size());
  for (const SnapshotRecord& record : piece.snapshots) {
    writer.put(record.tap);
    for (const SphereVector& vector : sphere_vectors) writer.put(record.*vector.values);
    for (const HeightProfile& profile : height_profiles) writer.put(record.*profile.values);
    writer.put(record.contacts);
    writer.put(record.coordination.has_value());
    if (record.coordination) writer.put(*record.coordination);
    writer.put(record.forces.has_value());
    if (!record.forces) continue;
    for (const double value : record.forces->moment) writer.put(value);
    writer.put(record.forces->walls);
  }
}

namespace {

/// Small data, which follow the rest.
template <class Snapshot>
void get_small(ByteReader& reader, Snapshot& snapshot) {
  if (reader.get_flag()) snapshot.coordination = reader.get<double>();
  if (!reader.get_flag()) return;
  snapshot.forces.emplace();
  for (double& value : snapshot.forces->moment) value = reader.get<double>();
  snapshot.forces->walls = reader.get_vector<WallForce>();
}

}  // namespace

SeriesPiece get_piece(ByteReader& reader) {
  SeriesPiece piece;
  piece.first_row = reader.get<std::uint64_t>();
  piece.rows = reader.get_vector<double>();
  const auto n_snapshots = reader.get<std::uint64_t>();
  for (std::uint64_t i = 0; i < n_snapshots; ++i) {
    SnapshotRecord record;
    record.tap = reader.get<std::uint64_t>();
    for (const SphereVector& vector : sphere_vectors)
      record.*vector.values = reader.get_vector<Vec3>();
    for (const HeightProfile& profile : height_profiles)
      record.*profile.values = reader.get_vector<double>();
    record.contacts = reader.get_vector<Contact>();
    get_small(reader, record);
    piece.snapshots.push_back(std::move(record));
  }
  return piece;
}

void put(ByteWriter& writer, const PartState& part) {
  writer.put(part.base_rows);
  writer.put(part.n_segments);
  put(writer, part.tail);
  writer.put(part.status);
  writer.put(part.reason);
  writer.put(part.work.seconds);
  writer.put(part.work.start_seconds);
  writer.put(part.work.effort.units);
  writer.put(part.work.effort.pair_tests);
  writer.put(part.state.has_value());
  if (part.state) put(writer, *part.state);
}

PiecePlaces get_piece_places(ByteReader& reader) {
  // Behind its length, which comes first.
  const auto skip = [&]<class T>(T) {
    const std::uint64_t offset = reader.position() + sizeof(std::uint64_t);
    return Extent{reader.skip_vector<T>(), offset};
  };
  PiecePlaces piece;
  piece.first_row = reader.get<std::uint64_t>();
  const Extent rows = skip(double{});
  piece.n_numbers = rows.n;
  piece.rows_at = rows.offset;
  const auto n_snapshots = reader.get<std::uint64_t>();
  for (std::uint64_t i = 0; i < n_snapshots; ++i) {
    SnapshotPlace place;
    place.tap = reader.get<std::uint64_t>();
    for (Extent& vector : place.vectors) vector = skip(Vec3{});
    for (Extent& profile : place.profiles) profile = skip(double{});
    place.contacts = skip(Contact{});
    get_small(reader, place);
    piece.snapshots.push_back(std::move(place));
  }
  return piece;
}

namespace {

void get_after_tail(ByteReader& reader, PartState& part) {
  part.status = reader.get_enum(RealizationStatus::failed);
  part.reason = reader.get_string();
  part.work.seconds = reader.get<double>();
  part.work.start_seconds = reader.get<double>();
  part.work.effort.units = reader.get<std::uint64_t>();
  part.work.effort.pair_tests = reader.get<std::uint64_t>();
  if (reader.get_flag()) part.state = get_realization_state(reader);
}

}  // namespace

PartState get_part_state(ByteReader& reader) {
  PartState part;
  part.base_rows = reader.get<std::uint64_t>();
  part.n_segments = reader.get<std::uint32_t>();
  part.tail = get_piece(reader);
  get_after_tail(reader, part);
  return part;
}

PartOutline get_part_outline(ByteReader& reader) {
  PartOutline outline;
  outline.part.base_rows = reader.get<std::uint64_t>();
  outline.part.n_segments = reader.get<std::uint32_t>();
  outline.tail = get_piece_places(reader);
  get_after_tail(reader, outline.part);
  return outline;
}

}  // namespace jostle::inline results
