#include "results/stored_realization.hpp"

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
    const auto from = record_.rows.begin() + static_cast<std::ptrdiff_t>(first * n_columns_);
    std::copy_n(from, rows.size(), rows.begin());
  }
  std::vector<SnapshotOutline> snapshots() override {
    std::vector<SnapshotOutline> outlines;
    for (const SnapshotRecord& one : record_.snapshots)
      outlines.push_back(
          {one.tap, static_cast<std::uint32_t>(one.centres.size()), one.coordination});
    return outlines;
  }
  std::vector<Vec3> centres(std::uint64_t tap) override { return at(tap).centres; }
  std::vector<double> height_histogram(std::uint64_t tap) override {
    return at(tap).height_histogram;
  }

 private:
  SnapshotRecord at(std::uint64_t tap) const {
    const auto found = std::ranges::find(record_.snapshots, tap, &SnapshotRecord::tap);
    return found == record_.snapshots.end() ? SnapshotRecord{} : *found;
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
  for (const SnapshotOutline& one : realization.snapshots()) {
    SnapshotRecord record{one.tap, realization.centres(one.tap), one.coordination,
                          realization.height_histogram(one.tap)};
    if (record.centres.empty() && !record.coordination && record.height_histogram.empty()) continue;
    records.push_back(std::move(record));
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
