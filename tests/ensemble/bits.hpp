#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "memory_sink.hpp"

namespace jostle {

/// All numbers of a record as their bits, NaN included, so that equal vectors are equal bytes.
class Bits {
 public:
  void add(std::uint64_t value) { bits_.push_back(value); }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  void add(const std::vector<double>& values) {
    add(std::uint64_t{values.size()});
    for (const double value : values) add(value);
  }
  void add(const std::vector<Vec3>& centres) {
    add(std::uint64_t{centres.size()});
    for (const Vec3& r : centres) {
      add(r.x);
      add(r.y);
      add(r.z);
    }
  }
  void add(const TapRow& row) {
    add(row.tap);
    add(row.observables);
    add(row.diagnostics);
  }
  void add(const SnapshotRecord& snapshot) {
    add(snapshot.tap);
    add(snapshot.centres);
    add(snapshot.coordination.value_or(-1));
    add(snapshot.height_histogram);
    add(snapshot.velocities);
    add(snapshot.spins);
    add(std::uint64_t{snapshot.contacts.size()});
    for (const Contact& contact : snapshot.contacts) {
      add(std::uint64_t{contact.first});
      add(std::uint64_t{contact.second});
      add(std::vector<double>{contact.overlap, contact.normal_force});
      add(std::vector<Vec3>{contact.normal, contact.tangential_force});
    }
    add(snapshot.temperature_lateral);
    add(snapshot.temperature_vertical);
    add(snapshot.driven_fraction);
    add(snapshot.driven_lateral);
    add(snapshot.driven_vertical);
    if (!snapshot.forces) return;
    for (const double value : snapshot.forces->moment) add(value);
    for (const WallForce& wall : snapshot.forces->walls) {
      add(wall.normal);
      add(std::vector<Vec3>{wall.friction});
    }
  }
  void add(const RealizationState& state) {
    add(state.rows);
    add(std::uint64_t{state.relaxing});
    for (const std::byte byte : state.engine) add(std::to_integer<std::uint64_t>(byte));
    add(state.tap_stream_position);
    for (const HeightWindow& window : state.observable_windows) {
      add(window.low);
      add(window.high);
    }
    for (const FittingColumn& column : fitting_columns) {
      if (state.fitting) add((*state.fitting).*column.field);
    }
    add(state.centres);
  }

  bool operator==(const Bits&) const = default;

 private:
  std::vector<std::uint64_t> bits_;
};

/// Data of a realization in a record, without those of the run: costs and checkpoints.
inline Bits bits(const RecordedRealization& record) {
  Bits all;
  for (const TapRow& row : record.rows) all.add(row);
  for (const SnapshotRecord& snapshot : record.snapshots) all.add(snapshot);
  if (record.state) all.add(*record.state);
  return all;
}

}  // namespace jostle
