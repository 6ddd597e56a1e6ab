#pragma once

#include <array>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "results/content/record.hpp"

namespace jostle::inline results {

/// A snapshot without what of it takes room.
struct SnapshotOutline {
  std::uint64_t tap = 0;
  std::array<std::uint32_t, n_sphere_vectors> n_spheres{};  // number of spheres of each kept vector
  std::uint64_t n_contacts = 0;
  std::optional<double> coordination{};
  std::optional<BedForces> forces{};
};

/// Source of results files: all stored data of one realization. Its series and its
/// snapshots can be larger than memory and are read piece by piece. All throw ResultsError.
class StoredRealization {
 public:
  StoredRealization() = default;
  StoredRealization(const StoredRealization&) = delete;
  StoredRealization& operator=(const StoredRealization&) = delete;
  virtual ~StoredRealization() = default;

  /// Realizations with the same are quickest read one after another.
  virtual const void* source() const { return nullptr; }
  /// To be called once: its position is not kept.
  virtual RealizationHead head() = 0;
  virtual std::uint64_t n_rows() const = 0;
  /// Fills `rows`, [n, n_columns], with those from `first` on; they must be there.
  virtual void read_rows(std::uint64_t first, std::span<double> rows) = 0;
  /// With ascending taps.
  virtual std::vector<SnapshotOutline> snapshots() = 0;
  /// For a snapshot, sphere_vectors[which] and height_profiles[which]; empty where none was kept at
  /// that tap.
  virtual std::vector<Vec3> vectors(std::uint64_t tap, std::size_t index) = 0;
  virtual std::vector<double> profile(std::uint64_t tap, std::size_t index) = 0;
  virtual std::vector<Contact> contacts(std::uint64_t tap) = 0;
};

/// Receives the number of written realizations of a results file.
using StoringProgress = std::function<void(std::uint64_t done, std::uint64_t total)>;

/// One that is held in memory; by default one of which nothing is there.
std::unique_ptr<StoredRealization> in_memory(RealizationRecord record = {},
                                             std::size_t n_columns = 1);

/// All of it at once.
std::vector<SnapshotRecord> snapshots_of(StoredRealization& realization);
/// Its kept positions alone.
std::vector<SnapshotRecord> positions_of(StoredRealization& realization);
RealizationRecord record_of(StoredRealization& realization, std::size_t n_columns);

}  // namespace jostle::inline results
