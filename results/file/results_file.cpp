#include "results/file/results_file.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cmath>
#include <span>

#include "results/checkpoints/part.hpp"
#include "results/disk/publish.hpp"
#include "results/disk/system_calls.hpp"
#include "results/file/intact_file.hpp"
#include "results/file/results_file_impl.hpp"
#include "results/file/validate.hpp"
#include "results/groups/axes.hpp"
#include "results/groups/layout.hpp"
#include "results/groups/mixtures.hpp"
#include "results/groups/motion_group.hpp"
#include "results/groups/snapshot_statistics.hpp"
#include "results/hdf5/read.hpp"

namespace jostle::inline results {

const char* name_of(RunState state) {
  switch (state) {
    case RunState::running:
      return "running";
    case RunState::interrupted:
      return "interrupted";
    case RunState::complete:
      return "complete";
  }
  return "unknown";
}

namespace {

Hdf5Handle open_sealed(const std::string& path, const std::string& known_as, Verify verify) {
  require_intact(path, known_as, verify);
  silence_hdf5();
  return naming_file(known_as, [&] { return open_to_read(path); });
}

std::vector<Work> read_work(const Hdf5Handle& timing, const Shape& extent) {
  const auto seconds = read_numbers<double>(timing, "seconds", &extent);
  const auto start_seconds = exists(timing, "start_seconds")
                                 ? read_numbers<double>(timing, "start_seconds", &extent)
                                 : std::vector<double>(seconds.size(), 0);  // older files
  const auto trials = read_numbers<std::uint64_t>(timing, "trials", &extent);
  const auto distance_tests = read_numbers<std::uint64_t>(timing, "distance_tests", &extent);
  std::vector<Work> work(seconds.size());
  for (std::size_t r = 0; r < work.size(); ++r) {
    work[r] = {.seconds = seconds[r],
               .start_seconds = start_seconds.at(r),
               .effort = {.units = trials.at(r), .pair_tests = distance_tests.at(r)}};
  }
  return work;
}

void require_rows(const PointTables& tables, const StudyPoint& point) {
  for (const std::uint8_t status : tables.statuses)
    if (status > static_cast<std::uint8_t>(RealizationStatus::failed))
      throw Hdf5Error("status holds a number that means nothing");
  for (const std::uint64_t rows : tables.rows)
    if (rows > point.taps + 1) throw Hdf5Error("rows holds more taps than the study has");
}

}  // namespace

ResultsFile::Impl::Impl(const std::string& name, const std::string& known_as, Verify verify,
                        const Impl* sibling)
    : path(known_as),
      name_(name),
      file_(open_sealed(name, known_as, verify)),
      version_(version_of(name)),
      shared_study_(naming_file(known_as,
                                [&]() -> std::shared_ptr<const Study> {
                                  if (sibling != nullptr && has_study(file_, sibling->study))
                                    return sibling->shared_study_;
                                  return std::make_shared<const Study>(read_study(file_));
                                })),
      study(*shared_study_) {
  naming_file(path, [&] {
    provenance = read_provenance(file_);
    validate(study, provenance);
  });
}

ResultsFile::Impl::Version ResultsFile::Impl::version_of(const std::string& name) {
  struct stat status {};
  if (::stat(name.c_str(), &status) != 0) fail_on_disk(name, "open", errno);
  const ChangeTime changed = change_time(status);
  return {static_cast<std::uint64_t>(status.st_dev), static_cast<std::uint64_t>(status.st_ino),
          static_cast<std::uint64_t>(status.st_size), static_cast<std::uint64_t>(changed.seconds),
          static_cast<std::uint64_t>(changed.nanoseconds)};
}

const Hdf5Handle& ResultsFile::Impl::file() const {
  if (file_ < 0) {
    if (version_of(name_) != version_)
      throw ResultsError(path, "has changed since it was first read");
    file_ = open_to_read(name_);
  }
  return file_;
}

void ResultsFile::Impl::rest() {
  cached_.reset();
  row_blocks_.clear();
  for (auto& blocks : profile_blocks_) blocks.clear();
  frames_.clear();
  file_ = Hdf5Handle();
}

RealizationSummary ResultsFile::Impl::summary(RealizationId id) {
  const PointTables& of_point = tables(id.point);
  RealizationSummary summary{.id = id, .reason = of_point.reasons.at(id.realization)};
  summary.status = static_cast<RealizationStatus>(of_point.statuses.at(id.realization));
  summary.rows = of_point.rows.at(id.realization);
  summary.work = of_point.work.at(id.realization);
  return summary;
}

PointTables ResultsFile::Impl::read_tables(std::uint32_t point) const {
  PointTables tables;
  tables.point = point;
  const auto missing = static_cast<std::uint8_t>(RealizationStatus::missing);
  if (!has_point(point)) {
    tables.statuses.assign(study.realizations, missing);
    tables.rows.resize(study.realizations);
    tables.reasons.resize(study.realizations);
    tables.work.resize(study.realizations);
    return tables;
  }
  const Hdf5Handle observables = open_group(file(), "observables/" + point_name(point));
  const Shape extent{study.realizations};
  tables.statuses = read_numbers<std::uint8_t>(observables, "status", &extent);
  tables.rows = read_numbers<std::uint64_t>(observables, "rows", &extent);
  require_shape(observables, "reason", extent);
  tables.reasons = read_texts(observables, "reason");
  require_rows(tables, study.points.at(point));
  const Hdf5Handle timing = open_group(file(), "timing/" + point_name(point));
  tables.work = read_work(timing, extent);
  const Shape taken{study.points.at(point).snapshots.taps.size(), study.realizations};
  const Hdf5Handle snapshots = open_group(file(), "snapshots/" + point_name(point));
  if (exists(snapshots, "coordination"))
    tables.coordination = read_numbers<double>(snapshots, "coordination", &taken);
  tables.forces = read_bed_forces(snapshots, study.points[point], study.realizations);
  for (std::size_t k = 0; k < n_height_profiles; ++k) {
    const std::string name = height_profiles[k].name;
    if (!exists(snapshots, name)) continue;
    const Shape shape = shape_of(open_dataset(snapshots, name));
    if (shape.size() != 3 || shape[0] != taken[0] || shape[1] != taken[1] || shape[2] == 0)
      throw Hdf5Error(name + " does not have the axes taps and realizations");
    tables.n_bins[k] = shape[2];
  }
  return tables;
}

ResultsFile::ResultsFile(const std::string& path, Verify verify)
    : impl_(std::make_unique<Impl>(path, path, verify)) {}
ResultsFile::ResultsFile(const std::string& path, const std::string& known_as)
    : impl_(std::make_unique<Impl>(path, known_as, Verify::whole_file)) {}
ResultsFile::ResultsFile(const std::string& path, Verify verify, const ResultsFile& sibling)
    : impl_(std::make_unique<Impl>(path, path, verify, sibling.impl_.get())) {}
ResultsFile::~ResultsFile() = default;
ResultsFile::ResultsFile(ResultsFile&&) noexcept = default;

const std::string& ResultsFile::path() const {
  return impl_->path;
}
RunState ResultsFile::state() const {
  return impl_->provenance.state;
}
const Shard& ResultsFile::shard() const {
  return impl_->provenance.shard;
}
const Study& ResultsFile::study() const {
  return impl_->study;
}
const std::string& ResultsFile::run_id() const {
  return impl_->provenance.run_id;
}
const std::vector<Provenance>& ResultsFile::provenance() const {
  return impl_->provenance.processes;
}

void ResultsFile::rest() const {
  impl_->rest();
}
void ResultsFile::forget_rows() const {
  impl_->forget_rows();
}

std::vector<RealizationSummary> ResultsFile::realizations(Realizations selection) const {
  return naming_file(impl_->path, [&] {
    std::vector<RealizationSummary> all;
    for (std::uint32_t p = 0; p < study().points.size(); ++p) {
      for (std::uint32_t r = 0; r < study().realizations; ++r) {
        if (selection == Realizations::of_its_share && !in_share(shard(), study(), {p, r}))
          continue;
        all.push_back(impl_->summary({p, r}));
      }
    }
    return all;
  });
}

std::vector<RealizationSummary> ResultsFile::realizations_at(std::uint32_t point) const {
  return naming_file(impl_->path, [&] {
    std::vector<RealizationSummary> all;
    for (std::uint32_t r = 0; r < study().realizations; ++r)
      all.push_back(impl_->summary({point, r}));
    return all;
  });
}

std::vector<Series> ResultsFile::series(std::uint32_t point) const {
  std::vector<Series> all;
  const std::uint64_t n_taps = n_stored_rows(point);
  for (const Column& label : columns(point))
    all.push_back({label, n_taps, study().realizations,
                   block(point, label.name, {0, n_taps}, {0, study().realizations})});
  return all;
}

std::uint64_t ResultsFile::n_stored_rows(std::uint32_t point) const {
  return naming_file(impl_->path, [&]() -> std::uint64_t {
    if (!impl_->has_point(point)) return 0;
    return impl_->stored_rows(open_group(impl_->file(), "observables/" + point_name(point)), point);
  });
}

std::vector<Column> ResultsFile::columns(std::uint32_t point) const {
  return study().points.at(point).columns();
}

std::vector<double> ResultsFile::block(std::uint32_t point, const std::string& column,
                                       const TapRange& taps, const RealizationRange& chosen) const {
  assert(taps.first <= taps.end && taps.end <= study().points.at(point).taps + 1);
  assert(chosen.first <= chosen.end && chosen.end <= study().realizations);
  const std::uint64_t n_taps = taps.end - taps.first, n_realizations = chosen.end - chosen.first;
  return naming_file(impl_->path, [&] {
    if (!impl_->has_point(point)) return std::vector<double>(n_taps * n_realizations, std::nan(""));
    const Hdf5Handle group = open_group(impl_->file(), "observables/" + point_name(point));
    const std::uint64_t rows = impl_->stored_rows(group, point);
    require_shape(group, column, {rows, study().realizations});
    const std::uint64_t stored = std::min(taps.end, rows) - std::min(taps.first, rows);
    auto values = read_block(group, column, {taps.first, chosen.first}, {stored, n_realizations});
    values.resize(n_taps * n_realizations, std::nan(""));
    return values;
  });
}

std::vector<EnsembleSeries> ResultsFile::ensemble(std::uint32_t point) const {
  return naming_file(impl_->path, [&] {
    std::vector<EnsembleSeries> all;
    if (!impl_->has_point(point)) return all;
    const Hdf5Handle group = open_group(impl_->file(), "ensemble/" + point_name(point));
    const Shape taps{
        impl_->stored_rows(open_group(impl_->file(), "observables/" + point_name(point)), point)};
    for (const Column& label : study().points.at(point).columns())
      all.push_back({label, read_numbers<double>(group, label.name + "_mean", &taps),
                     read_numbers<double>(group, label.name + "_sigma", &taps),
                     read_numbers<double>(group, label.name + "_error", &taps),
                     read_numbers<std::uint32_t>(group, label.name + "_count", &taps)});
    return all;
  });
}

std::vector<RealizationValues> ResultsFile::fittings(std::uint32_t point) const {
  return naming_file(impl_->path, [&] {
    std::vector<RealizationValues> all;
    const std::string folder = std::string(fitting_folder) + "/" + point_name(point);
    if (!exists(impl_->file(), folder)) return all;
    const Hdf5Handle group = open_group(impl_->file(), folder);
    const Shape extent{study().realizations};
    for (const FittingColumn& column : fitting_columns)
      all.push_back({{column.name, column.units, column.long_name, "jostle"},
                     read_numbers<double>(group, column.name, &extent)});
    return all;
  });
}

std::optional<MotionRecords> ResultsFile::motion(std::uint32_t point) const {
  return naming_file(impl_->path, [&]() -> std::optional<MotionRecords> {
    const StudyPoint& study_point = study().points.at(point);
    const std::string folder = std::string(motion_folder) + "/" + point_name(point);
    if (!study_point.motion || !exists(impl_->file(), folder)) return std::nullopt;
    MotionRecords records(*study_point.motion, study_point.n_spheres, study().realizations);
    read_motion_records(open_group(impl_->file(), folder), records);
    return records;
  });
}

std::shared_ptr<const Sizes> ResultsFile::sizes(RealizationId id) const {
  const StudyPoint& point = study().points.at(id.point);
  if (!point.mixture) return nullptr;
  return naming_file(impl_->path, [&] {
    if (!point.mixture->drawn()) return point.mixture->sizes({});
    const auto drawn = read_drawn_diameters(impl_->file(), point, id, study().realizations);
    const auto fault = sizes_fault(drawn, point.mixture->kind_of, point.mixture->kinds);
    if (fault)
      throw Hdf5Error("/" + std::string(spheres_folder) + "/" + point_name(id.point) + "/" +
                      sphere_diameters + ": realization " + std::to_string(id.realization) +
                      " has not begun, or the file is not written by jostle: " + *fault);
    return point.mixture->sizes(drawn);
  });
}

std::vector<SnapshotRecord> ResultsFile::snapshots(RealizationId id) const {
  return snapshots_of(*realization(id));
}

std::vector<SnapshotRecord> ResultsFile::positions(RealizationId id) const {
  return positions_of(*realization(id));
}

RealizationRecord ResultsFile::record(RealizationId id) const {
  return record_of(*realization(id), impl_->n_columns(id.point));
}

std::optional<RealizationState> ResultsFile::restart_state(RealizationId id) const {
  return naming_file(impl_->path, [&]() -> std::optional<RealizationState> {
    const std::string name =
        "restart/" + point_name(id.point) + "/" + realization_name(id.realization);
    if (!impl_->has_point(id.point) || !exists(impl_->file(), name)) return std::nullopt;
    const auto bytes = read_numbers<std::uint8_t>(impl_->file(), name);
    ByteReader reader(std::as_bytes(std::span(bytes)));
    try {
      RealizationState state = get_realization_state(reader);
      validate(state, study().points.at(id.point));
      const StudyPoint& point = study().points.at(id.point);
      if (!state.diameters.empty() &&
          state.diameters != read_drawn_diameters(impl_->file(), point, id, study().realizations))
        throw Hdf5Error("/" + name + " continues with spheres of other sizes than those stored");
      if (state.rows != impl_->tables(id.point).rows.at(id.realization))
        throw Hdf5Error("/" + name + " continues from another tap than the last that is stored");
      return state;
    } catch (const std::out_of_range&) {
      throw Hdf5Error("/" + name +
                      " was written by another version of jostle: resume with that one");
    }
  });
}

}  // namespace jostle::inline results
