#include "results/groups/point_writer.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "engine/bed/random.hpp"
#include "engine/numbers.hpp"
#include "results/checkpoints/part.hpp"
#include "results/groups/axes.hpp"
#include "results/groups/layout.hpp"
#include "results/groups/motion_group.hpp"
#include "results/groups/particles.hpp"
#include "results/hdf5/read.hpp"

namespace jostle::inline results {
namespace {

/// All NaN look alike in the file.
double canonical(double value) {
  return std::isnan(value) ? not_a_number : value;
}

/// Numbers of realizations, those of one source together.
std::vector<std::uint32_t> by_source(
    const std::vector<std::unique_ptr<StoredRealization>>& realizations) {
  std::vector<std::uint32_t> order(realizations.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::stable_sort(order, std::less{},
                           [&](std::uint32_t r) { return realizations[r]->source(); });
  return order;
}

}  // namespace

void create_point_folders(hid_t file) {
  for (const char* folder :
       {"observables", "ensemble", "snapshots", "particles", "restart", "timing"})
    create_group(file, folder);
}

PointWriter::PointWriter(hid_t file, const Study& study, std::uint32_t point)
    : file_(file),
      point_(study.points[point]),
      number_(point),
      n_realizations_(study.realizations),
      labels_(point_.columns()) {
  const std::size_t n_snapshots = point_.snapshots.taps.size() * n_realizations_;
  statistics_.coordination.resize(n_snapshots, not_a_number);
  if (point_.snapshots.forces) statistics_.forces.resize(n_snapshots);
}

void PointWriter::begin() {
  if (begun_) return;
  begun_ = true;
  for (const char* folder : {"observables", "ensemble", "snapshots", "restart", "timing"})
    create_group(file_, std::string(folder) + "/" + point_name(number_));
}

Hdf5Handle PointWriter::group_under(const char* folder) const {
  const std::string path = std::string(folder) + "/" + point_name(number_);
  return {H5Gopen2(file_, path.c_str(), H5P_DEFAULT), H5Gclose};
}

RealizationStatus PointWriter::add(std::unique_ptr<StoredRealization> realization) {
  RealizationHead head = realization->head();
  if (head.status != RealizationStatus::missing) begin();
  rows_.push_back(std::min(realization->n_rows(), point_.taps + 1));
  if (head.status == RealizationStatus::done && rows_.back() <= point_.taps)
    head.status = RealizationStatus::running;
  statuses_.push_back(static_cast<std::uint8_t>(head.status));
  reasons_.push_back(head.reason);
  work_.push_back(head.work);
  fittings_.push_back(head.state ? head.state->fitting : std::nullopt);
  take_snapshots(*realization, head.state ? diameters_of(*head.state) : std::vector<double>{});
  if (point_.motion && head.state && head.state->motion) {
    if (!motion_) motion_.emplace(*point_.motion, point_.n_spheres, n_realizations_);
    motion_->add(static_cast<std::uint32_t>(realizations_.size()), *head.state->motion,
                 point_.container);
  }
  if (head.state && point_.mixture && point_.mixture->drawn() && !head.state->diameters.empty()) {
    if (!diameters_) diameters_.emplace(file_, number_, n_realizations_, point_.n_spheres);
    diameters_->write(static_cast<std::uint32_t>(realizations_.size()), head.state->diameters);
  }
  if (head.state) write_restart(*head.state);
  realizations_.push_back(std::move(realization));
  return head.status;
}

/// [n_spheres]; empty where all are 1.
std::vector<double> PointWriter::diameters_of(const RealizationState& state) const {
  if (!point_.mixture) return {};
  return point_.mixture->drawn() ? state.diameters : point_.mixture->diameters;
}

void PointWriter::take_snapshots(StoredRealization& realization,
                                 const std::vector<double>& diameters) {
  const auto number = static_cast<std::uint32_t>(realizations_.size());
  const auto& taps = point_.snapshots.taps;
  std::vector<SnapshotOutline> snapshots = realization.snapshots();
  std::erase_if(snapshots, [&](const SnapshotOutline& snapshot) {
    return !std::ranges::binary_search(taps, snapshot.tap);
  });
  for (const SnapshotOutline& snapshot : snapshots) {
    const auto row = std::ranges::lower_bound(taps, snapshot.tap) - taps.begin();
    const std::size_t cell = static_cast<std::size_t>(row) * n_realizations_ + number;
    statistics_.coordination[cell] = canonical(snapshot.coordination.value_or(not_a_number));
    if (point_.snapshots.forces) statistics_.forces[cell] = snapshot.forces;
  }
  write_particles(file_, particles_name({number_, number}), point_.container, point_.n_spheres,
                  diameters, snapshots, realization);
}

void PointWriter::write_restart(const RealizationState& state) {
  ByteWriter bytes;
  put(bytes, state);
  const auto raw =
      std::span(reinterpret_cast<const std::uint8_t*>(bytes.bytes().data()), bytes.bytes().size());
  // Its own axis: one of all realizations would have to name each of them.
  const std::string name = realization_name(static_cast<std::uint32_t>(realizations_.size()));
  make_axis(write_numbers<std::uint8_t>(group_under("restart"), name, {raw.size()}, raw), name);
}

void PointWriter::finish() {
  if (!begun_) return;
  write_observables();
  write_snapshots();
  write_fittings();
  write_motion();
  write_timing();
  if (diameters_) diameters_->finish();
}

/// The columns and their moments, a block of taps at a time. Taps beyond the farthest realization's
/// are left out, whatever is planned.
void PointWriter::write_series(hid_t group, const Hdf5Handle& taps,
                               const Hdf5Handle& realizations) {
  const std::uint64_t n_taps = std::max<std::uint64_t>(1, std::ranges::max(rows_));
  const Shape shape{n_taps, n_realizations_};
  const Hdf5Handle* const axes[] = {&taps, &realizations};
  std::vector<RowsDataset<double>> series;
  for (const Column& label : labels_) {
    series.emplace_back(group, label.name, shape, chunk_along_first(shape));
    write_label(series.back().dataset(), label);
    attach_axes(series.back().dataset(), axes);
  }
  EnsembleWriter ensemble(group_under("ensemble"), labels_, n_taps);
  const std::uint64_t a_block = rows_a_block(n_realizations_, labels_.size());
  const std::vector<std::uint32_t> order = by_source(realizations_);
  std::vector<double> rows;
  for (std::uint64_t first = 0; first < n_taps; first += a_block) {
    const std::uint64_t n = std::min(a_block, n_taps - first);
    SeriesBlock block(labels_.size(), first, n, n_realizations_);
    for (const std::uint32_t r : order) {
      const std::uint64_t end = std::clamp(rows_[r], first, first + n);
      rows.resize((end - first) * labels_.size());
      if (rows.empty()) continue;
      realizations_[r]->read_rows(first, rows);
      block.set(r, rows);
    }
    for (std::size_t c = 0; c < labels_.size(); ++c) series[c].write(first, block.column(c));
    ensemble.write(block);
  }
}

void PointWriter::write_observables() {
  const Hdf5Handle group = group_under("observables");
  const Hdf5Handle taps =
      write_tap_axis(group, std::max<std::uint64_t>(1, std::ranges::max(rows_)));
  const Hdf5Handle realizations = write_realization_axis(group, n_realizations_);
  const Hdf5Handle* const axes[] = {&realizations};
  write_series(group, taps, realizations);
  const Hdf5Handle status = write_numbers(group, "status", statuses_);
  const std::uint8_t flags[] = {0, 1, 2, 3};
  write_attribute<std::uint8_t>(status, "flag_values", flags);
  write_attribute(status, "flag_meanings", std::string("missing running done failed"));
  write_attribute(status, "long_name", std::string("how far the realization is"));
  attach_axes(status, axes);
  const Hdf5Handle reason = write_texts(group, "reason", {n_realizations_}, reasons_);
  write_attribute(reason, "long_name", std::string("why the realization failed"));
  attach_axes(reason, axes);
  const Hdf5Handle rows = write_numbers(group, "rows", rows_);
  write_attribute(rows, "long_name", std::string("taps recorded, the start included"));
  attach_axes(rows, axes);
  std::vector<std::uint64_t> keys;
  for (std::uint32_t r = 0; r < n_realizations_; ++r)
    keys.push_back(
        static_cast<std::uint64_t>(stream_key(point_.seed, point_.id, r, Purpose::trials)));
  const Hdf5Handle key = write_numbers(group, "trial_key", keys);
  write_attribute(key, "long_name", std::string("Philox key of the realization's trials"));
  attach_axes(key, axes);
}

void PointWriter::write_snapshots() {
  if (point_.snapshots.taps.empty()) return;
  statistics_.profile = [this](std::size_t index, std::size_t tap, std::uint32_t realization) {
    return realizations_[realization]->profile(point_.snapshots.taps[tap], index);
  };
  write_snapshot_statistics(group_under("snapshots"), point_, n_realizations_, statistics_);
}

// Only of points that start from a fitted pour.
void PointWriter::write_fittings() {
  const auto is_known = [](const auto& fitting) { return fitting.has_value(); };
  if (std::none_of(fittings_.begin(), fittings_.end(), is_known)) return;
  if (!exists(file_, fitting_folder)) create_group(file_, fitting_folder);
  create_group(file_, std::string(fitting_folder) + "/" + point_name(number_));
  const Hdf5Handle group = group_under(fitting_folder);
  const Hdf5Handle realizations = write_realization_axis(group, n_realizations_);
  const Hdf5Handle* const axes[] = {&realizations};
  for (const FittingColumn& column : fitting_columns) {
    std::vector<double> values;
    for (const auto& fitting : fittings_)
      values.push_back(fitting ? canonical((*fitting).*column.field) : not_a_number);
    const Hdf5Handle written = write_numbers(group, column.name, values);
    write_label(written, {column.name, column.units, column.long_name, "jostle"});
    attach_axes(written, axes);
  }
}

void PointWriter::write_motion() {
  if (!motion_) return;
  if (!exists(file_, motion_folder)) create_group(file_, motion_folder);
  create_group(file_, std::string(motion_folder) + "/" + point_name(number_));
  std::vector<std::string> kinds;
  if (point_.mixture) kinds = point_.mixture->names_of_kinds();
  write_motion_records(group_under(motion_folder), *motion_, kinds);
}

void PointWriter::write_timing() {
  const Hdf5Handle group = group_under("timing");
  const Hdf5Handle realizations = write_realization_axis(group, n_realizations_);
  const Hdf5Handle* const axes[] = {&realizations};
  const auto write = [&](const Column& label, auto&& value_of) {
    std::vector<std::decay_t<decltype(value_of(Work{}))>> numbers;
    for (const Work& work : work_) numbers.push_back(value_of(work));
    const Hdf5Handle written = write_numbers(group, label.name.c_str(), numbers);
    write_label(written, label);
    attach_axes(written, axes);
  };
  write({"seconds", "s", "processor time of the realization", "jostle"},
        [](const Work& work) { return work.seconds; });
  write({"start_seconds", "s", "of that, until tap 0 was recorded", "jostle"},
        [](const Work& work) { return work.start_seconds; });
  write({"trials", "1", "trials made in that time", "jostle"},
        [](const Work& work) { return work.effort.units; });
  write({"distance_tests", "1", "pair distances computed in them", "jostle"},
        [](const Work& work) { return work.effort.pair_tests; });
}

}  // namespace jostle::inline results
