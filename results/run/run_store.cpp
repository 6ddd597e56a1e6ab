#include "results/run/run_store.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cassert>
#include <map>
#include <mutex>
#include <utility>

#include "results/disk/checksum.hpp"
#include "results/disk/error.hpp"
#include "results/disk/names.hpp"
#include "results/disk/output_path.hpp"
#include "results/disk/publish.hpp"
#include "results/disk/temporary_file.hpp"
#include "results/file/results_writer.hpp"
#include "results/locks/lock.hpp"
#include "results/run/recorder.hpp"
#include "results/run/run_parts.hpp"

namespace jostle::inline results {
namespace {

bool file_exists(const std::string& path) {
  struct stat status;
  return ::stat(path.c_str(), &status) == 0;
}

/// Device and number; zeros where there is no file.
using FileIdentity = std::pair<dev_t, ino_t>;
FileIdentity identity_of(const std::string& path) {
  struct stat status;
  if (::lstat(path.c_str(), &status) != 0) return {};
  return {status.st_dev, status.st_ino};
}

std::uint64_t file_bytes(const std::string& path) {
  struct stat status;
  return ::stat(path.c_str(), &status) == 0 ? static_cast<std::uint64_t>(status.st_size) : 0;
}

void require_room_for_run(const std::string& path, std::uint64_t bytes) {
  require_free_space(path, bytes,
                     "free some space, write elsewhere, keep fewer snapshots, or give the run a "
                     "time limit, at which it stops with what it has");
}

/// A study with another scene or other sizes: the file must contain it before parts follow it.
bool differs(const Study& stored, const Study& study) {
  return stored.resolved_scene != study.resolved_scene || stored.realizations != study.realizations;
}

/// True if realizations have equal numbers in both, by which parts are named.
bool same_points(const Study& stored, const Study& study) {
  return std::ranges::equal(stored.points, study.points, {}, &StudyPoint::id, &StudyPoint::id);
}

/// True if files of both studies have the same data; scenes may differ in what is derived.
bool same_data(const Study& stored, const Study& study) {
  return stored.realizations == study.realizations && same_points(stored, study) &&
         std::ranges::equal(stored.points, study.points, {}, &StudyPoint::taps, &StudyPoint::taps);
}

}  // namespace

class RunStore::Impl {
 public:
  Impl(const std::string& results_path, const Shard& a_shard, bool force, Room a_room,
       const Patience& patience)
      : path(output_path(results_path)),
        shard(a_shard),
        room(a_room),
        lock(path, force, LockUse::run, patience) {
    require_replaceable_file(path);
    remove_stale_temporaries(path);
  }

  void start(const Provenance& provenance);
  void go_on(const std::function<Study(const ResultsFile&)>& study_for,
             const Provenance& provenance);
  void fold(const StoringProgress& progress = {});
  void require_room(std::uint64_t have) const;
  RealizationSummary summary(RealizationId id) const;
  PartState last_checkpoint(RealizationId id) const;
  std::size_t n_columns(RealizationId id) const;
  Recorder& recorder(RealizationId id);

  std::string path;
  Study study;
  Shard shard;
  Room room;
  std::string run_id;
  std::vector<Provenance> processes;
  std::optional<ResultsFile> file;                       // the state before the parts
  std::map<RealizationId, RealizationSummary> folded;    // its contents
  std::map<RealizationId, RealizationSummary> in_parts;  // last checkpoints
  std::mutex mutex;  // mutex of `recorders`, `in_parts` and everything that touches HDF5
  std::map<RealizationId, std::unique_ptr<Recorder>> recorders;
  RunLock lock;

 private:
  void open_file();
  bool still_ours() const;
  void check_shard_and_points() const;
  void fold_parts_of_the_stored_points();

  FileIdentity opened;  // stamp of the file that `file` reads
};

/// `have`: bytes of the run that are on the disk already.
void RunStore::Impl::require_room(std::uint64_t have) const {
  const std::uint64_t needed = disk_estimate(study, shard);
  if (room == Room::for_all && needed > have) require_room_for_run(path, needed - have);
}

void RunStore::Impl::start(const Provenance& provenance) {
  require_room(0);
  run_id = random_identity();
  processes = {provenance};
  write_results(path, {study, shard, processes, run_id, {}}, [this] { remove_parts(path); });
  open_file();
}

void RunStore::Impl::go_on(const std::function<Study(const ResultsFile&)>& study_for,
                           const Provenance& provenance) {
  open_file();
  study = study_for(*file);
  check_shard_and_points();
  run_id = file->run_id();
  processes = file->provenance();
  processes.push_back(provenance);
  in_parts = verify_parts(path, run_id, file->study());
  // Existing data are a part of the estimate: a chain of runs that fits at first fits to its end.
  require_room(parts_bytes(path) + file_bytes(path));
  if (!same_points(file->study(), study)) fold_parts_of_the_stored_points();
  if (differs(file->study(), study))
    fold();
  else
    study = file->study();
}

void RunStore::Impl::check_shard_and_points() const {
  const Shard stored = file->shard();
  if (stored != shard)
    throw ResultsError(path, fmt::format("holds shard {}/{} of its study, not {}/{}", stored.index,
                                         stored.count, shard.index, shard.count));
  const PointNumbers numbers(study);
  for (const StudyPoint& point : file->study().points)
    if (!numbers.find(point.id))
      throw ResultsError(path, fmt::format("has the sweep point {}, but the scene has not: values "
                                           "can be added to a sweep, not removed",
                                           point.label));
  if (shard.count > 1 && !same_points(file->study(), study))
    throw ResultsError(path,
                       "holds a share of its realizations, so its sweep cannot grow: merge "
                       "all shares, and resume the merged file with the new values");
  if (const auto point = other_start(file->study(), study))
    throw ResultsError(path,
                       fmt::format("was begun from another packing: the file that sweep point "
                                   "{} starts from has changed since; restore it",
                                   *point));
}

/// True if the path is still our file, or is gone.
bool RunStore::Impl::still_ours() const {
  const FileIdentity found = identity_of(path);
  return found == opened || found == FileIdentity{};
}

void RunStore::Impl::open_file() {
  file.emplace(path);
  opened = identity_of(path);
  folded.clear();
  for (RealizationSummary& summary : file->realizations()) folded[summary.id] = summary;
}

/// Parts are named by the numbers of points. Those of a file whose points get other numbers go into
/// it first, and away: a kill at any moment leaves a file and parts that agree.
void RunStore::Impl::fold_parts_of_the_stored_points() {
  if (!in_parts.empty()) {
    const Study grown = std::exchange(study, file->study());
    fold();
    study = grown;
  }
  remove_parts(path);
  in_parts.clear();
}

/// Replaces the file by one that also holds what the parts hold.
void RunStore::Impl::fold(const StoringProgress& progress) {
  const PointNumbers in_file(file->study());
  const auto realization = [&](RealizationId id) {
    const auto stored = in_file.find(study.points[id.point].id);
    auto base = stored ? file->realization({*stored, id.realization}) : in_memory();
    if (!in_parts.contains(id)) return base;
    return continued(std::move(base), path, {run_id, id}, n_columns(id));
  };
  const bool as_it_is = in_parts.empty() && same_data(file->study(), study);
  const FileContent content{
      study, shard, processes, run_id, realization, progress, as_it_is ? &*file : nullptr};
  if (!still_ours()) {
    const std::string new_path = path_with_ending(path, "." + run_id.substr(0, 8));
    write_results(new_path, content);
    throw ResultsError(path, fmt::format("another file was put here during the run, and is kept; "
                                         "the computed results are in {}",
                                         new_path));
  }
  write_results(path, content);
  open_file();
}

std::size_t RunStore::Impl::n_columns(RealizationId id) const {
  return study.points[id.point].n_columns();
}

RealizationSummary RunStore::Impl::summary(RealizationId id) const {
  if (const auto part = in_parts.find(id); part != in_parts.end()) return part->second;
  if (const auto stored = folded.find(id); stored != folded.end()) return stored->second;
  return {.id = id, .reason = {}};
}

/// The last checkpoint of a realization, or an empty one.
PartState RunStore::Impl::last_checkpoint(RealizationId id) const {
  PartState part;
  const RealizationSummary last = summary(id);
  if (last.status == RealizationStatus::failed) return part;
  if (in_parts.contains(id)) return read_state(state_path(path, id), {run_id, id});
  part.state = file->restart_state(id);
  if (!part.state) return part;
  part.base_rows = last.rows;
  part.work = last.work;
  return part;
}

Recorder& RunStore::Impl::recorder(RealizationId id) {
  const std::lock_guard guard(mutex);
  return *recorders.at(id);
}

RunStore::RunStore(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
RunStore::~RunStore() = default;

std::unique_ptr<RunStore> RunStore::create(const std::string& path, const Study& study,
                                           const Shard& shard, const Provenance& provenance,
                                           bool force, Room room, const Patience& patience,
                                           bool takes_over) {
  auto impl = std::make_unique<Impl>(path, shard, force || takes_over, room, patience);
  impl->study = study;
  if (!force && file_exists(path))
    throw ResultsError(path, "exists already; resume it, choose another name, or replace it",
                       ResultsError::Force::helps);
  if (!force && parts_exist(path))
    throw ResultsError(parts_folder(path),
                       "holds parts of an earlier run whose results file is gone; restore that "
                       "file, or discard the parts by a new run",
                       ResultsError::Force::helps);
  impl->start(provenance);
  return std::unique_ptr<RunStore>(new RunStore(std::move(impl)));
}

std::unique_ptr<RunStore> RunStore::resume(const std::string& path, const Study& study,
                                           const Shard& shard, const Provenance& provenance,
                                           bool force, const Patience& patience) {
  return resume(
      path, [&](const ResultsFile&) { return study; }, shard, provenance, force, Room::for_all,
      patience);
}

std::unique_ptr<RunStore> RunStore::resume(
    const std::string& path, const std::function<Study(const ResultsFile&)>& study_for,
    const Shard& shard, const Provenance& provenance, bool force, Room room,
    const Patience& patience) {
  auto impl = std::make_unique<Impl>(path, shard, force, room, patience);
  impl->go_on(study_for, provenance);
  return std::unique_ptr<RunStore>(new RunStore(std::move(impl)));
}

ResultsFile RunStore::close(std::unique_ptr<RunStore> store) {
  return std::move(*store->impl_->file);
}

std::string RunStore::lock_warning() const {
  return impl_->lock.warning();
}

const ResultsFile& RunStore::results() const {
  return *impl_->file;
}

std::vector<RealizationSummary> RunStore::realizations() const {
  std::vector<RealizationSummary> all;
  for (std::uint32_t p = 0; p < impl_->study.points.size(); ++p) {
    for (std::uint32_t r = 0; r < impl_->study.realizations; ++r) {
      all.push_back(impl_->summary({p, r}));
    }
  }
  return all;
}

std::vector<RealizationId> RunStore::pending(bool retry_failed) const {
  const Impl& impl = *impl_;
  std::vector<RealizationId> ids = realizations_of(impl.study, impl.shard);
  std::erase_if(ids, [&](RealizationId id) {
    const RealizationSummary last = impl.summary(id);
    if (last.status == RealizationStatus::failed) return !retry_failed;
    return last.status == RealizationStatus::done && last.rows > impl.study.points[id.point].taps;
  });
  return ids;
}

void RunStore::extend(std::uint32_t realizations) {
  assert(realizations >= impl_->study.realizations);
  const std::lock_guard guard(impl_->mutex);
  impl_->study.realizations = realizations;
  impl_->require_room(file_bytes(impl_->path));
  impl_->fold();
}

std::optional<RealizationState> RunStore::begin(RealizationId id) {
  const std::lock_guard guard(impl_->mutex);
  make_parts_folder(impl_->path);
  PartState part = impl_->last_checkpoint(id);
  part.status = RealizationStatus::running;
  const std::optional<RealizationState> state = part.state;
  impl_->recorders[id] = std::make_unique<Recorder>(impl_->path, PartIdentity{impl_->run_id, id},
                                                    impl_->n_columns(id), std::move(part));
  return state;
}

void RunStore::append(RealizationId id, const TapRow& row) {
  impl_->recorder(id).append(row);
}

void RunStore::snapshot(RealizationId id, const SnapshotRecord& record) {
  impl_->recorder(id).snapshot(record);
}

void RunStore::checkpoint(RealizationId id, const RealizationState& state, const Work& work) {
  const RealizationSummary summary = impl_->recorder(id).checkpoint(state, work);
  const std::lock_guard guard(impl_->mutex);
  impl_->in_parts[id] = summary;
}

void RunStore::end(RealizationId id, const RealizationState& state, const Outcome& outcome) {
  const RealizationSummary summary = impl_->recorder(id).end(state, outcome);
  const std::lock_guard guard(impl_->mutex);
  impl_->in_parts[id] = summary;
  impl_->recorders.erase(id);
}

std::uint64_t RunStore::bytes_to_fold() const {
  return file_bytes(impl_->path) + parts_bytes(impl_->path);
}

void RunStore::finish(const StoringProgress& progress) {
  const std::lock_guard guard(impl_->mutex);
  impl_->recorders.clear();
  // A file to which nothing is added stays as it is, with its derived tables.
  if (!impl_->in_parts.empty() || impl_->file->state() != RunState::complete) impl_->fold(progress);
  remove_parts(impl_->path);
  impl_->in_parts.clear();
}

}  // namespace jostle::inline results
