#include "results/checkpoints/part_content.hpp"

#include <stdexcept>

namespace jostle::inline results {

namespace {

// Leads the bytes of a state; counts up when they change, from a number that no older state, which
// began with its rows, can begin with.
constexpr std::uint32_t state_format = 0xf0000004;

}  // namespace

std::size_t SeriesPiece::bytes() const {
  std::size_t n = rows.size() * sizeof(double);
  for (const SnapshotRecord& record : snapshots)
    n +=
        64 + record.centres.size() * sizeof(Vec3) + record.height_histogram.size() * sizeof(double);
  return n;
}

void put(ByteWriter& writer, const RealizationState& state) {
  writer.put(state_format);
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
}

RealizationState get_realization_state(ByteReader& reader) {
  if (reader.get<std::uint32_t>() != state_format)
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
  return state;
}

void put(ByteWriter& writer, const SeriesPiece& piece) {
  writer.put(piece.first_row);
  writer.put(piece.rows);
  writer.put<std::uint64_t>(piece.snapshots.size());
  for (const SnapshotRecord& record : piece.snapshots) {
    writer.put(record.tap);
    writer.put(record.centres);
    writer.put(record.coordination.has_value());
    writer.put(record.coordination.value_or(0));
    writer.put(record.height_histogram);
  }
}

SeriesPiece get_piece(ByteReader& reader) {
  SeriesPiece piece;
  piece.first_row = reader.get<std::uint64_t>();
  piece.rows = reader.get_vector<double>();
  const auto n_snapshots = reader.get<std::uint64_t>();
  for (std::uint64_t i = 0; i < n_snapshots; ++i) {
    SnapshotRecord record;
    record.tap = reader.get<std::uint64_t>();
    record.centres = reader.get_vector<Vec3>();
    const bool has_coordination = reader.get_flag();
    const double coordination = reader.get<double>();
    if (has_coordination) record.coordination = coordination;
    record.height_histogram = reader.get_vector<double>();
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
  const auto skip = [&]<class T>(std::uint64_t& at, T) {
    at = reader.position() + sizeof(std::uint64_t);
    return reader.skip_vector<T>();
  };
  PiecePlaces piece;
  piece.first_row = reader.get<std::uint64_t>();
  piece.n_numbers = skip(piece.rows_at, double{});
  const auto n_snapshots = reader.get<std::uint64_t>();
  for (std::uint64_t i = 0; i < n_snapshots; ++i) {
    SnapshotPlace place;
    place.tap = reader.get<std::uint64_t>();
    place.n_spheres = skip(place.centres_at, Vec3{});
    const bool has_coordination = reader.get_flag();
    const double coordination = reader.get<double>();
    if (has_coordination) place.coordination = coordination;
    place.n_bins = skip(place.histogram_at, double{});
    piece.snapshots.push_back(place);
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
