#include "results/content/stored_realization.hpp"

#include <algorithm>
#include <utility>

namespace jostle::inline results {
namespace {

class InMemory : public StoredRealization {
 public:
  InMemory(RealizationRecord record, std::size_t n_columns)
      : record_(std::move(record)), n_columns_(n_columns) {}

  RealizationHead head() override { return record_; }
  std::uint64_t n_rows() const override { return record_.rows.size() / n_columns_; }
  void read_rows(std::uint64_t first, std::span<double> rows) override {
    const auto begin = record_.rows.begin() + static_cast<std::ptrdiff_t>(first * n_columns_);
    std::copy_n(begin, rows.size(), rows.begin());
  }
  std::vector<SnapshotOutline> snapshots() override {
    std::vector<SnapshotOutline> outlines;
    for (const SnapshotRecord& snapshot : record_.snapshots) {
      SnapshotOutline outline{.tap = snapshot.tap,
                              .n_contacts = snapshot.contacts.size(),
                              .coordination = snapshot.coordination,
                              .forces = snapshot.forces};
      for (std::size_t k = 0; k < n_sphere_vectors; ++k)
        outline.n_spheres[k] =
            static_cast<std::uint32_t>((snapshot.*sphere_vectors[k].values).size());
      outlines.push_back(std::move(outline));
    }
    return outlines;
  }
  std::vector<Vec3> vectors(std::uint64_t tap, std::size_t index) override {
    return values_at(tap, sphere_vectors[index].values);
  }
  std::vector<double> profile(std::uint64_t tap, std::size_t index) override {
    return values_at(tap, height_profiles[index].values);
  }
  std::vector<Contact> contacts(std::uint64_t tap) override {
    return values_at(tap, &SnapshotRecord::contacts);
  }

 private:
  template <class T>
  std::vector<T> values_at(std::uint64_t tap, std::vector<T> SnapshotRecord::*values) const {
    const auto found = std::ranges::find(record_.snapshots, tap, &SnapshotRecord::tap);
    return found == record_.snapshots.end() ? std::vector<T>{} : (*found).*values;
  }

  RealizationRecord record_;
  std::size_t n_columns_;
};

}  // namespace

std::unique_ptr<StoredRealization> in_memory(RealizationRecord record, std::size_t n_columns) {
  return std::make_unique<InMemory>(std::move(record), n_columns);
}

std::vector<SnapshotRecord> snapshots_of(StoredRealization& realization) {
  std::vector<SnapshotRecord> records;
  for (const SnapshotOutline& outline : realization.snapshots()) {
    SnapshotRecord record{.tap = outline.tap,
                          .centres = {},
                          .coordination = outline.coordination,
                          .height_histogram = {}};
    bool kept = outline.coordination || outline.forces;
    for (std::size_t k = 0; k < n_sphere_vectors; ++k) {
      record.*sphere_vectors[k].values = realization.vectors(outline.tap, k);
      kept = kept || !(record.*sphere_vectors[k].values).empty();
    }
    for (std::size_t k = 0; k < n_height_profiles; ++k) {
      record.*height_profiles[k].values = realization.profile(outline.tap, k);
      kept = kept || !(record.*height_profiles[k].values).empty();
    }
    record.contacts = realization.contacts(outline.tap);
    record.forces = outline.forces;
    if (kept) records.push_back(std::move(record));
  }
  return records;
}

std::vector<SnapshotRecord> positions_of(StoredRealization& realization) {
  std::vector<SnapshotRecord> records;
  for (const SnapshotOutline& outline : realization.snapshots()) {
    if (outline.n_spheres[kept_positions] == 0) continue;
    SnapshotRecord& record = records.emplace_back();
    record.tap = outline.tap;
    record.centres = realization.vectors(outline.tap, kept_positions);
  }
  return records;
}

RealizationRecord record_of(StoredRealization& realization, std::size_t n_columns) {
  RealizationRecord record{realization.head(), {}, snapshots_of(realization)};
  record.rows.resize(realization.n_rows() * n_columns);
  realization.read_rows(0, record.rows);
  return record;
}

}  // namespace jostle::inline results
