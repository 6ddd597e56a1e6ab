#include "results/run/run_parts.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <utility>

#include "results/disk/error.hpp"
#include "results/disk/input_file.hpp"
#include "results/disk/output_path.hpp"
#include "results/disk/publish.hpp"

namespace jostle::inline results {
namespace {

enum class Kind { state, segment, temporary };
struct PartName {
  Kind kind;
  RealizationId id;
  std::uint32_t segment = 0;
};

std::optional<PartName> parse_name(const std::string& name) {
  PartName part{Kind::state, {}, 0};
  int end = 0;
  const char* text = name.c_str();
  if (std::sscanf(text, "p%u_r%u.%n", &part.id.point, &part.id.realization, &end) != 2 || end == 0)
    return std::nullopt;
  const std::string ending = name.substr(static_cast<std::size_t>(end));
  if (ending.ends_with(".tmp")) {
    part.kind = Kind::temporary;
    return part;
  }
  if (ending == "state") return part;
  part.kind = Kind::segment;
  if (std::sscanf(ending.c_str(), "segment%u%n", &part.segment, &end) != 1 ||
      static_cast<std::size_t>(end) != ending.size())
    return std::nullopt;
  return part;
}

/// Only the folder's owner may choose it: a link here could make us remove files anywhere.
void require_own_folder(const std::string& folder) {
  struct stat status;
  if (::lstat(folder.c_str(), &status) != 0) {
    if (errno == ENOENT) return;
    fail_on_disk(folder, "open", errno);
  }
  if (!S_ISDIR(status.st_mode))
    throw ResultsError(folder,
                       "is no folder that jostle made, which needs this name: move it away, or "
                       "name the results file otherwise");
  if (may_be_planted(folder, Writers::everybody))
    throw ResultsError(folder,
                       "is a folder of another user where everybody may write, and could be "
                       "exchanged under the run: name the results file otherwise");
}

/// The files of the folder that are parts, by name; none where there is no folder.
std::map<std::string, PartName> list_parts(const std::string& results_path) {
  std::map<std::string, PartName> parts;
  require_own_folder(parts_folder(results_path));
  std::error_code error;
  for (std::filesystem::directory_iterator entry(parts_folder(results_path), error), end;
       !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename();
    if (const auto part = parse_name(name)) parts[entry->path()] = *part;
  }
  if (error && error != std::errc::no_such_file_or_directory)
    throw ResultsError(parts_folder(results_path), "cannot list: " + error.message());
  return parts;
}

constexpr std::uint32_t in_state = 0xffffffff;  // in the place of a segment's number

/// The parts of a realization, verified, and where its series and snapshots lie in them.
struct PartsIndex {
  struct Rows {
    std::uint32_t segment;
    std::uint64_t first, end, offset;
  };
  struct Snapshot : SnapshotPlace {
    std::uint32_t segment;
  };
  PartOutline outline;
  std::vector<Rows> rows;
  std::vector<Snapshot> snapshots;

  std::uint64_t n_rows() const { return rows.back().end; }
};

PartsIndex index_parts(const std::string& results_path, const PartIdentity& identity,
                       std::size_t n_columns) {
  const std::string path = state_path(results_path, identity.id);
  PartsIndex index{read_state_outline(path, identity), {}, {}};
  std::uint64_t next_row = index.outline.part.base_rows;
  const auto accept = [&](const PiecePlaces& piece, std::uint32_t segment) {
    if (piece.first_row != next_row || piece.n_numbers % n_columns != 0)
      throw ResultsError(path, "its rows do not follow on one another");
    next_row += piece.n_numbers / n_columns;
    index.rows.push_back({segment, piece.first_row, next_row, piece.rows_at});
    for (const SnapshotPlace& snapshot : piece.snapshots) {
      if (!index.snapshots.empty() && snapshot.tap <= index.snapshots.back().tap)
        throw ResultsError(path, "its snapshots do not follow on one another");
      index.snapshots.push_back({snapshot, segment});
    }
  };
  for (std::uint32_t k = 0; k < index.outline.part.n_segments; ++k)
    accept(read_segment_places(segment_path(results_path, identity.id, k), identity, k), k);
  accept(index.outline.tail, in_state);
  index.outline.tail.snapshots.clear();
  if (index.outline.part.state && index.outline.part.state->rows != next_row)
    throw ResultsError(path, "its state and its rows disagree");
  return index;
}

/// Data of a realization in a results file, continued by its parts.
class Continued : public StoredRealization {
 public:
  Continued(std::unique_ptr<StoredRealization> base, const std::string& results_path,
            PartIdentity identity, std::size_t n_columns, Content content)
      : base_(std::move(base)),
        results_path_(results_path),
        identity_(std::move(identity)),
        n_columns_(n_columns),
        content_(content),
        index_(index_parts(results_path, identity_, n_columns)),
        n_rows_(index_.n_rows()),
        base_rows_(index_.outline.part.base_rows) {
    if (base_->n_rows() < base_rows_)
      throw ResultsError(state_path(results_path, identity_.id),
                         "continues from taps that the results file does not hold");
    PartState& part = index_.outline.part;
    head_ = {part.status, std::move(part.reason), part.work, std::exchange(part.state, {})};
  }

  RealizationHead head() override { return std::move(head_); }
  std::uint64_t n_rows() const override { return n_rows_; }
  void read_rows(std::uint64_t first, std::span<double> rows) override;
  std::vector<SnapshotOutline> snapshots() override;
  std::vector<Vec3> vectors(std::uint64_t tap, std::size_t index) override;
  std::vector<double> profile(std::uint64_t tap, std::size_t index) override;
  std::vector<Contact> contacts(std::uint64_t tap) override;

 private:
  /// Position of an indexed item.
  struct Place {
    std::uint32_t segment;
    std::uint64_t offset;
  };
  /// Reads the item that `place` finds in the index. A live run continues: another checkpoint may
  /// have taken the place of the one that was indexed, or its tail become a segment; all is indexed
  /// anew then, and the item is found again.
  void read(const std::function<Place()>& place, std::span<std::byte> bytes);
  const PartsIndex::Rows& rows_with(std::uint64_t row) const;
  const PartsIndex::Snapshot* snapshot_at(std::uint64_t tap) const;
  template <class T, class ExtentOf>
  std::vector<T> read_vector(std::uint64_t tap, const ExtentOf& extent_of);

  std::unique_ptr<StoredRealization> base_;
  const std::string& results_path_;
  PartIdentity identity_;
  std::size_t n_columns_;
  Content content_;
  PartsIndex index_;
  std::uint64_t n_rows_, base_rows_;
  RealizationHead head_;
};

void Continued::read(const std::function<Place()>& place, std::span<std::byte> bytes) {
  for (;;) {
    const auto [segment, offset] = place();
    const bool in_tail = segment == in_state;
    InputFile file(in_tail ? state_path(results_path_, identity_.id)
                           : segment_path(results_path_, identity_.id, segment));
    if (!in_tail || file.stamp() == index_.outline.stamp) return file.read_at(offset, bytes);
    index_ = index_parts(results_path_, identity_, n_columns_);
    index_.outline.part.state.reset();
    if (index_.n_rows() < n_rows_ || index_.outline.part.base_rows != base_rows_)
      throw ResultsError(state_path(results_path_, identity_.id), "has changed meanwhile");
  }
}

const PartsIndex::Rows& Continued::rows_with(std::uint64_t row) const {
  return *std::ranges::upper_bound(index_.rows, row, {}, &PartsIndex::Rows::end);
}

void Continued::read_rows(std::uint64_t first, std::span<double> rows) {
  while (!rows.empty()) {
    const std::uint64_t left = rows.size() / n_columns_;
    const bool in_base = first < base_rows_;
    const std::uint64_t end = in_base ? base_rows_ : std::min(rows_with(first).end, n_rows_);
    const std::uint64_t n = std::min(left, end - first);
    const auto head = rows.first(n * n_columns_);
    const auto place = [&]() -> Place {
      const PartsIndex::Rows& piece = rows_with(first);
      return {piece.segment, piece.offset + (first - piece.first) * n_columns_ * sizeof(double)};
    };
    if (in_base)
      base_->read_rows(first, head);
    else
      read(place, std::as_writable_bytes(head));
    rows = rows.subspan(head.size());
    first += n;
  }
}

std::vector<SnapshotOutline> Continued::snapshots() {
  if (content_ == Content::without_snapshots) return {};
  std::vector<SnapshotOutline> outlines = base_->snapshots();
  std::erase_if(outlines,
                [&](const SnapshotOutline& outline) { return outline.tap >= base_rows_; });
  for (const PartsIndex::Snapshot& snapshot : index_.snapshots) {
    SnapshotOutline outline{.tap = snapshot.tap,
                            .n_contacts = snapshot.contacts.n,
                            .coordination = snapshot.coordination,
                            .forces = snapshot.forces};
    for (std::size_t k = 0; k < n_sphere_vectors; ++k)
      outline.n_spheres[k] = static_cast<std::uint32_t>(snapshot.vectors[k].n);
    outlines.push_back(std::move(outline));
  }
  return outlines;
}

const PartsIndex::Snapshot* Continued::snapshot_at(std::uint64_t tap) const {
  if (content_ == Content::without_snapshots) return nullptr;
  const auto found = std::ranges::lower_bound(index_.snapshots, tap, {}, &SnapshotPlace::tap);
  return found == index_.snapshots.end() || found->tap != tap ? nullptr : &*found;
}

template <class T, class ExtentOf>
std::vector<T> Continued::read_vector(std::uint64_t tap, const ExtentOf& extent_of) {
  const PartsIndex::Snapshot* const indexed = snapshot_at(tap);
  if (indexed == nullptr) return {};
  std::vector<T> values(extent_of(*indexed).n);
  const auto place = [&]() -> Place {
    const PartsIndex::Snapshot* const snapshot = snapshot_at(tap);
    if (snapshot == nullptr || extent_of(*snapshot).n != values.size())
      throw ResultsError(state_path(results_path_, identity_.id), "has changed meanwhile");
    return {snapshot->segment, extent_of(*snapshot).offset};
  };
  if (!values.empty()) read(place, std::as_writable_bytes(std::span(values)));
  return values;
}

std::vector<Vec3> Continued::vectors(std::uint64_t tap, std::size_t index) {
  if (tap < base_rows_) return base_->vectors(tap, index);
  return read_vector<Vec3>(tap,
                           [index](const SnapshotPlace& place) { return place.vectors[index]; });
}

std::vector<double> Continued::profile(std::uint64_t tap, std::size_t index) {
  if (tap < base_rows_) return base_->profile(tap, index);
  return read_vector<double>(tap,
                             [index](const SnapshotPlace& place) { return place.profiles[index]; });
}

std::vector<Contact> Continued::contacts(std::uint64_t tap) {
  if (tap < base_rows_) return base_->contacts(tap);
  return read_vector<Contact>(tap, [](const SnapshotPlace& place) { return place.contacts; });
}

}  // namespace

bool parts_exist(const std::string& results_path) {
  return !list_parts(results_path).empty();
}

void make_parts_folder(const std::string& results_path) {
  const std::string folder = parts_folder(output_path(results_path));
  struct stat status;
  const bool is_private =
      ::stat(results_path.c_str(), &status) == 0 && (status.st_mode & (S_IRGRP | S_IROTH)) == 0;
  if (::mkdir(folder.c_str(), is_private ? 0700 : 0777) == 0) return sync_folder_of(folder);
  if (errno != EEXIST) fail_on_disk(folder, "create", errno);
  require_own_folder(folder);
}

void remove_parts(const std::string& results_path) {
  const auto parts = list_parts(results_path);
  for (const auto& [path, part] : parts)
    if (part.kind == Kind::state) remove_file(path);
  for (const auto& [path, part] : parts)
    if (part.kind != Kind::state) remove_file(path);
  ::rmdir(parts_folder(results_path).c_str());
}

std::uint64_t parts_bytes(const std::string& results_path) {
  std::uint64_t bytes = 0;
  for (const auto& [path, part] : list_parts(results_path)) {
    struct stat status;
    if (::stat(path.c_str(), &status) == 0) bytes += static_cast<std::uint64_t>(status.st_size);
  }
  return bytes;
}

std::vector<RealizationId> realizations_with_parts(const std::string& results_path) {
  std::vector<RealizationId> ids;
  for (const auto& [path, part] : list_parts(results_path))
    if (part.kind == Kind::state) ids.push_back(part.id);
  std::sort(ids.begin(), ids.end());
  return ids;
}

RealizationSummary summary_of(RealizationId id, const PartState& part) {
  return {.id = id,
          .status = part.status,
          .rows = part.state ? part.state->rows : 0,
          .reason = part.reason,
          .work = part.work};
}

std::map<RealizationId, RealizationSummary> verify_parts(const std::string& results_path,
                                                         const std::string& run_id,
                                                         const Study& study) {
  std::map<RealizationId, RealizationSummary> summaries;
  std::map<RealizationId, std::uint32_t> n_segments;
  for (const RealizationId id : realizations_with_parts(results_path)) {
    const std::string path = state_path(results_path, id);
    if (id.point >= study.points.size() || id.realization >= study.realizations)
      throw ResultsError(path, "part of a realization that the study does not have");
    const std::size_t n_columns = study.points[id.point].n_columns();
    const PartState part = index_parts(results_path, {run_id, id}, n_columns).outline.part;
    summaries[id] = summary_of(id, part);
    n_segments[id] = part.n_segments;
  }
  for (const auto& [path, part] : list_parts(results_path))
    if (part.kind == Kind::temporary ||
        (part.kind == Kind::segment && part.segment >= n_segments[part.id]))
      remove_file(path);
  return summaries;
}

std::unique_ptr<StoredRealization> continued(std::unique_ptr<StoredRealization> base,
                                             const std::string& results_path,
                                             const PartIdentity& identity, std::size_t n_columns,
                                             Content content) {
  return std::make_unique<Continued>(std::move(base), results_path, identity, n_columns, content);
}

}  // namespace jostle::inline results
