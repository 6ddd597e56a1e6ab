#include "results/results_file.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <span>

#include "results/axes.hpp"
#include "results/hdf5_read.hpp"
#include "results/layout.hpp"
#include "results/part.hpp"
#include "results/particles.hpp"
#include "results/point_writer.hpp"
#include "results/recently_used.hpp"
#include "results/seal.hpp"
#include "results/study_writer.hpp"
#include "results/validate.hpp"

namespace jostle {
namespace {

Hdf5Handle open_sealed(const std::string& path, const std::string& known_as) {
  verify_seal(path);
  silence_hdf5();
  return naming_file(known_as, [&] {
    return Hdf5Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  });
}

/// What is stored of a point, but for series, positions and restart states.
struct PointTables {
  std::uint32_t point = 0;
  std::vector<std::uint8_t> statuses;
  std::vector<std::uint64_t> rows;
  std::vector<std::string> reasons;
  std::vector<Work> work;
  std::vector<double> coordination;  // [n_snapshot_taps, n_realizations], or empty
  std::size_t n_bins = 0;            // of height histograms; 0 where there are none
};

std::vector<Work> read_work(const Hdf5Handle& timing, const Shape& each) {
  const auto seconds = read_numbers<double>(timing, "seconds", &each);
  const auto start_seconds = exists(timing, "start_seconds")
                                 ? read_numbers<double>(timing, "start_seconds", &each)
                                 : std::vector<double>(seconds.size(), 0);  // older files
  const auto trials = read_numbers<std::uint64_t>(timing, "trials", &each);
  const auto distance_tests = read_numbers<std::uint64_t>(timing, "distance_tests", &each);
  std::vector<Work> work(seconds.size());
  for (std::size_t r = 0; r < work.size(); ++r) {
    work[r] = {.seconds = seconds[r],
               .start_seconds = start_seconds.at(r),
               .trials = trials.at(r),
               .distance_tests = distance_tests.at(r)};
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

class ResultsFile::Impl {
 public:
  Impl(const std::string& name, const std::string& known_as)
      : path(known_as), file(open_sealed(name, known_as)) {
    naming_file(path, [&] {
      study = read_study(file);
      provenance = read_provenance(file);
      validate(study, provenance);
      has_points = exists(file, "observables");
    });
  }

  /// Taps that the columns of a point hold: those beyond which no realization has come are left
  /// out.
  std::uint64_t stored_rows(const Hdf5Handle& observables, std::uint32_t point) {
    const Shape shape = shape_of(open_dataset(observables, "tap"));
    const auto most = std::ranges::max(tables(point).rows);
    if (shape.size() != 1 || shape[0] < most || shape[0] < 1 ||
        shape[0] > study.points.at(point).taps + 1)
      throw Hdf5Error("tap is not as long as the columns that stand along it must be");
    return shape[0];
  }

  const PointTables& tables(std::uint32_t point) {
    if (!cached_ || cached_->point != point) cached_ = read_tables(point);
    return *cached_;
  }

  /// [n_columns] of [n, n_realizations]: the block of rows that `row` is in.
  const std::vector<std::vector<double>>& row_block(std::uint32_t point, std::uint64_t row) {
    const std::uint64_t first = row / block_rows(point) * block_rows(point);
    return row_blocks_.get({point, first}, [&] {
      const Hdf5Handle observables = open_group(file, "observables/" + point_name(point));
      const std::uint64_t rows = stored_rows(observables, point);
      const std::uint64_t n = std::min(block_rows(point), rows - std::min(first, rows));
      std::vector<std::vector<double>> columns;
      for (const ObservableLabel& label : column_labels(study.points.at(point))) {
        require_shape(observables, label.name, {rows, study.realizations});
        columns.push_back(read_block(observables, label.name, {first, 0}, {n, study.realizations}));
      }
      return columns;
    });
  }
  std::uint64_t block_rows(std::uint32_t point) const {
    return rows_a_block(study.realizations, n_columns(point));
  }
  std::size_t n_columns(std::uint32_t point) const {
    return study.points.at(point).observables.size() + n_relaxation_columns;
  }

  /// A snapshot's height histogram, with the zeros that pad it; empty where none was kept.
  std::span<const double> histogram(RealizationId id, std::size_t snapshot) {
    const std::size_t n_bins = tables(id.point).n_bins;
    const std::uint64_t n_taps = study.points.at(id.point).snapshots.taps.size();
    if (n_bins == 0) return {};
    const Shape all{n_taps, study.realizations, n_bins};
    const std::uint64_t n_a_block = chunk_along_first(all)[0];
    const std::uint64_t first = snapshot / n_a_block * n_a_block;
    const auto& block = histogram_blocks_.get({id.point, first}, [&] {
      const Hdf5Handle group = open_group(file, "snapshots/" + point_name(id.point));
      return read_block(group, "height_histogram", {first, 0, 0},
                        {std::min(n_a_block, n_taps - first), study.realizations, n_bins});
    });
    const std::size_t cell = (snapshot - first) * study.realizations + id.realization;
    const auto bins = std::span(block).subspan(cell * n_bins, n_bins);
    return std::isnan(bins[0]) ? std::span<const double>{} : bins;
  }

  const ParticleFrames& frames(RealizationId id) {
    return frames_.get(id, [&] {
      return ParticleFrames(file, particles_name(id), study.points.at(id.point).n_spheres);
    });
  }

  std::string path;
  Hdf5Handle file;
  Study study;
  FileProvenance provenance;
  bool has_points = false;  // false in the small file of a run that has just begun

 private:
  PointTables read_tables(std::uint32_t point) const;

  std::optional<PointTables> cached_;
  using Block = std::pair<std::uint32_t, std::uint64_t>;  // of a point, from a row or a snapshot on
  // Two, as what is written from them comes in other blocks where it has more realizations.
  RecentlyUsed<Block, std::vector<std::vector<double>>, 2> row_blocks_;
  RecentlyUsed<Block, std::vector<double>, 2> histogram_blocks_;
  RecentlyUsed<RealizationId, ParticleFrames, 1> frames_;
};

PointTables ResultsFile::Impl::read_tables(std::uint32_t point) const {
  PointTables tables;
  tables.point = point;
  const Hdf5Handle observables = open_group(file, "observables/" + point_name(point));
  const Shape each{study.realizations};
  tables.statuses = read_numbers<std::uint8_t>(observables, "status", &each);
  tables.rows = read_numbers<std::uint64_t>(observables, "rows", &each);
  require_shape(observables, "reason", each);
  tables.reasons = read_texts(observables, "reason");
  require_rows(tables, study.points.at(point));
  const Hdf5Handle timing = open_group(file, "timing/" + point_name(point));
  tables.work = read_work(timing, each);
  const Shape taken{study.points.at(point).snapshots.taps.size(), study.realizations};
  const Hdf5Handle snapshots = open_group(file, "snapshots/" + point_name(point));
  if (exists(snapshots, "coordination"))
    tables.coordination = read_numbers<double>(snapshots, "coordination", &taken);
  if (exists(snapshots, "height_histogram")) {
    const Shape shape = shape_of(open_dataset(snapshots, "height_histogram"));
    if (shape.size() != 3 || shape[0] != taken[0] || shape[1] != taken[1] || shape[2] == 0)
      throw Hdf5Error("height_histogram does not stand along taps and realizations");
    tables.n_bins = shape[2];
  }
  return tables;
}

ResultsFile::ResultsFile(const std::string& path) : ResultsFile(path, path) {}
ResultsFile::ResultsFile(const std::string& path, const std::string& known_as)
    : impl_(std::make_unique<Impl>(path, known_as)) {}
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

std::vector<RealizationSummary> ResultsFile::realizations() const {
  return naming_file(impl_->path, [&] {
    std::vector<RealizationSummary> all;
    for (std::uint32_t p = 0; p < study().points.size(); ++p) {
      for (std::uint32_t r = 0; r < study().realizations; ++r) {
        RealizationSummary summary{.id = {p, r}, .reason = {}};
        if (impl_->has_points) {
          const PointTables& tables = impl_->tables(p);
          summary.status = static_cast<RealizationStatus>(tables.statuses.at(r));
          summary.rows = tables.rows.at(r);
          summary.reason = tables.reasons.at(r);
          summary.work = tables.work.at(r);
        }
        all.push_back(summary);
      }
    }
    return all;
  });
}

std::vector<Series> ResultsFile::series(std::uint32_t point) const {
  std::vector<Series> all;
  const std::uint64_t n_taps = n_stored_rows(point);
  for (const ObservableLabel& label : columns(point))
    all.push_back({label, n_taps, study().realizations,
                   block(point, label.name, {0, n_taps}, {0, study().realizations})});
  return all;
}

std::uint64_t ResultsFile::n_stored_rows(std::uint32_t point) const {
  if (!impl_->has_points) return 0;
  return naming_file(impl_->path, [&] {
    return impl_->stored_rows(open_group(impl_->file, "observables/" + point_name(point)), point);
  });
}

std::vector<ObservableLabel> ResultsFile::columns(std::uint32_t point) const {
  return column_labels(study().points.at(point));
}

std::vector<double> ResultsFile::block(std::uint32_t point, const std::string& column,
                                       const TapRange& taps, const RealizationRange& chosen) const {
  assert(taps.first <= taps.end && taps.end <= study().points.at(point).taps + 1);
  assert(chosen.first <= chosen.end && chosen.end <= study().realizations);
  const std::uint64_t n_taps = taps.end - taps.first, n_realizations = chosen.end - chosen.first;
  if (!impl_->has_points) return std::vector<double>(n_taps * n_realizations, std::nan(""));
  return naming_file(impl_->path, [&] {
    const Hdf5Handle group = open_group(impl_->file, "observables/" + point_name(point));
    const std::uint64_t rows = impl_->stored_rows(group, point);
    require_shape(group, column, {rows, study().realizations});
    const std::uint64_t stored = std::min(taps.end, rows) - std::min(taps.first, rows);
    auto values = read_block(group, column, {taps.first, chosen.first}, {stored, n_realizations});
    values.resize(n_taps * n_realizations, std::nan(""));
    return values;
  });
}

std::vector<EnsembleSeries> ResultsFile::ensemble(std::uint32_t point) const {
  if (!impl_->has_points) return {};
  return naming_file(impl_->path, [&] {
    const Hdf5Handle group = open_group(impl_->file, "ensemble/" + point_name(point));
    std::vector<EnsembleSeries> all;
    const Shape taps{
        impl_->stored_rows(open_group(impl_->file, "observables/" + point_name(point)), point)};
    for (const ObservableLabel& label : column_labels(study().points.at(point)))
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
    if (!exists(impl_->file, folder)) return all;
    const Hdf5Handle group = open_group(impl_->file, folder);
    const Shape each{study().realizations};
    for (const FittingColumn& column : fitting_columns)
      all.push_back({{column.name, column.units, column.long_name, "jostle"},
                     read_numbers<double>(group, column.name, &each)});
    return all;
  });
}

/// A realization of a file that outlives it.
class ResultsFile::Stored : public StoredRealization {
 public:
  Stored(const ResultsFile& file, RealizationId id, Content content)
      : file_(file), impl_(*file.impl_), id_(id), content_(content) {}

  RealizationHead head() override {
    return naming_file(impl_.path, [&] {
      const PointTables& tables = impl_.tables(id_.point);
      return RealizationHead{static_cast<RealizationStatus>(tables.statuses.at(id_.realization)),
                             tables.reasons.at(id_.realization), tables.work.at(id_.realization),
                             file_.restart_state(id_)};
    });
  }
  std::uint64_t n_rows() const override {
    return naming_file(impl_.path,
                       [&] { return impl_.tables(id_.point).rows.at(id_.realization); });
  }
  void read_rows(std::uint64_t first, std::span<double> rows) override;
  std::vector<SnapshotOutline> snapshots() override;
  std::vector<Vec3> centres(std::uint64_t tap) override;
  std::vector<double> height_histogram(std::uint64_t tap) override;

 private:
  const StudyPoint& point() const { return file_.study().points.at(id_.point); }

  const ResultsFile& file_;
  Impl& impl_;
  RealizationId id_;
  Content content_;
};

void ResultsFile::Stored::read_rows(std::uint64_t first, std::span<double> rows) {
  naming_file(impl_.path, [&] {
    const std::size_t n_columns = impl_.n_columns(id_.point), n = impl_.study.realizations;
    const std::uint64_t a_block = impl_.block_rows(id_.point);
    for (std::size_t i = 0; i < rows.size() / n_columns; ++i) {
      const auto& columns = impl_.row_block(id_.point, first + i);
      for (std::size_t c = 0; c < n_columns; ++c)
        rows[i * n_columns + c] = columns.at(c).at((first + i) % a_block * n + id_.realization);
    }
  });
}

/// Where histograms were kept and nothing else, every snapshot tap that was reached may have one.
std::vector<SnapshotOutline> ResultsFile::Stored::snapshots() {
  if (content_ == Content::without_snapshots) return {};
  return naming_file(impl_.path, [&] {
    const PointTables& tables = impl_.tables(id_.point);
    const auto& taps = point().snapshots.taps;
    std::map<std::uint64_t, SnapshotOutline> by_tap;
    for (const std::uint64_t tap : impl_.frames(id_).taps())
      by_tap[tap].n_spheres = point().n_spheres;
    for (std::size_t s = 0; s < taps.size(); ++s) {
      const std::size_t cell = s * file_.study().realizations + id_.realization;
      const bool coordinated =
          !tables.coordination.empty() && !std::isnan(tables.coordination.at(cell));
      if (coordinated) by_tap[taps[s]].coordination = tables.coordination[cell];
      if (tables.n_bins > 0 && taps[s] < tables.rows.at(id_.realization)) by_tap[taps[s]];
    }
    std::vector<SnapshotOutline> outlines;
    for (auto& [tap, outline] : by_tap) {
      outline.tap = tap;
      outlines.push_back(outline);
    }
    return outlines;
  });
}

std::vector<Vec3> ResultsFile::Stored::centres(std::uint64_t tap) {
  if (content_ == Content::without_snapshots) return {};
  return naming_file(impl_.path, [&] { return impl_.frames(id_).centres(tap); });
}

std::vector<double> ResultsFile::Stored::height_histogram(std::uint64_t tap) {
  return naming_file(impl_.path, [&]() -> std::vector<double> {
    const auto& taps = point().snapshots.taps;
    const auto found = std::ranges::lower_bound(taps, tap);
    if (content_ == Content::without_snapshots || found == taps.end() || *found != tap) return {};
    auto bins = impl_.histogram(id_, static_cast<std::size_t>(found - taps.begin()));
    // The last bin of a histogram holds the highest centre: what follows is padding.
    while (!bins.empty() && bins.back() == 0) bins = bins.first(bins.size() - 1);
    return {bins.begin(), bins.end()};
  });
}

std::unique_ptr<StoredRealization> ResultsFile::realization(RealizationId id,
                                                            Content content) const {
  if (!impl_->has_points || id.realization >= study().realizations) return in_memory();
  return std::make_unique<Stored>(*this, id, content);
}

std::vector<SnapshotRecord> ResultsFile::snapshots(RealizationId id) const {
  return snapshots_of(*realization(id));
}

RealizationRecord ResultsFile::record(RealizationId id) const {
  return record_of(*realization(id), impl_->n_columns(id.point));
}

std::optional<RealizationState> ResultsFile::restart_state(RealizationId id) const {
  return naming_file(impl_->path, [&]() -> std::optional<RealizationState> {
    const std::string name =
        "restart/" + point_name(id.point) + "/" + realization_name(id.realization);
    if (!impl_->has_points || !exists(impl_->file, name)) return std::nullopt;
    const auto bytes = read_numbers<std::uint8_t>(impl_->file, name);
    ByteReader reader(std::as_bytes(std::span(bytes)));
    try {
      RealizationState state = get_realization_state(reader);
      validate(state, study().points.at(id.point));
      if (state.rows != impl_->tables(id.point).rows.at(id.realization))
        throw Hdf5Error("/" + name + " goes on from another tap than the last that is stored");
      return state;
    } catch (const std::out_of_range&) {
      throw Hdf5Error("/" + name +
                      " was written by another version of jostle: resume with that one");
    }
  });
}

}  // namespace jostle
