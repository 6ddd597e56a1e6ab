#include "results/axes.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "ensemble/moments.hpp"

namespace jostle {
namespace {

template <class Number>
Hdf5Handle write_counting_axis(hid_t group, const char* name, Number n, const char* long_name) {
  std::vector<Number> values(n);
  std::iota(values.begin(), values.end(), Number{0});
  Hdf5Handle axis = write_numbers<Number>(group, name, {n}, values, chunk_along_first({n}));
  write_label(axis, {name, "1", long_name, ""});
  make_axis(axis, name);
  return axis;
}

void write_moment(hid_t group, const Hdf5Handle& taps, const ObservableLabel& label,
                  const std::vector<double>& values) {
  const Hdf5Handle dataset = write_numbers<double>(group, label.name, {values.size()}, values,
                                                   chunk_along_first({values.size()}));
  write_label(dataset, label);
  const Hdf5Handle* const axes[] = {&taps};
  attach_axes(dataset, axes);
}

void write_ensemble_column(hid_t group, const Hdf5Handle& taps, const ObservableLabel& label,
                           const std::vector<double>& column, std::uint32_t n_realizations) {
  std::vector<double> mean, sigma, error;
  std::vector<std::uint32_t> count;
  for (std::size_t tap = 0; tap < column.size() / n_realizations; ++tap) {
    Moments moments;
    for (std::uint32_t r = 0; r < n_realizations; ++r)
      moments.add(column[tap * n_realizations + r]);
    mean.push_back(moments.mean());
    sigma.push_back(moments.sigma());
    error.push_back(moments.standard_error());
    count.push_back(static_cast<std::uint32_t>(moments.count()));
  }
  const std::string& name = label.name;
  write_moment(group, taps,
               {name + "_mean", label.units, "mean of " + label.long_name, label.source}, mean);
  write_moment(group, taps,
               {name + "_sigma", label.units,
                "standard deviation (1/M) over realizations of " + label.long_name, label.source},
               sigma);
  write_moment(group, taps,
               {name + "_error", label.units, "standard error of the mean of " + label.long_name,
                label.source},
               error);
  const Hdf5Handle counts = write_numbers<std::uint32_t>(group, name + "_count", {count.size()},
                                                         count, chunk_along_first({count.size()}));
  write_label(counts, {name, "1", "realizations with a value of " + label.long_name, ""});
  const Hdf5Handle* const axes[] = {&taps};
  attach_axes(counts, axes);
}

void write_histograms(hid_t group, const Hdf5Handle& taps, const Hdf5Handle& realizations,
                      double bin_width, const std::vector<std::vector<double>>& histograms,
                      const Shape& shape) {
  std::size_t n_bins = 0;
  for (const auto& histogram : histograms) n_bins = std::max(n_bins, histogram.size());
  if (n_bins == 0) return;
  std::vector<double> heights, values;
  for (std::size_t k = 0; k < n_bins; ++k)
    heights.push_back((static_cast<double>(k) + 0.5) * bin_width);
  for (const auto& histogram : histograms) {
    const double absent = histogram.empty() ? std::numeric_limits<double>::quiet_NaN() : 0.0;
    values.insert(values.end(), histogram.begin(), histogram.end());
    values.insert(values.end(), n_bins - histogram.size(), absent);
  }
  const Hdf5Handle axis = write_numbers(group, "height", heights);
  write_label(axis, {"height", "diameter", "height of the middle of the bin above the floor", ""});
  make_axis(axis, "height");
  const Shape all{shape[0], shape[1], n_bins};
  const Hdf5Handle dataset =
      write_numbers<double>(group, "height_histogram", all, values, chunk_along_first(all));
  write_label(dataset, {"height_histogram", "1", "n(z), fraction of all centres in the bin",
                        "Rosato et al. 2010, fig. 6"});
  const Hdf5Handle* const axes[] = {&taps, &realizations, &axis};
  attach_axes(dataset, axes);
}

}  // namespace

Hdf5Handle write_tap_axis(hid_t group, std::uint64_t n_taps) {
  return write_counting_axis<std::uint64_t>(group, "tap", n_taps, "number of taps; 0 is the start");
}

Hdf5Handle write_realization_axis(hid_t group, std::uint32_t n_realizations) {
  return write_counting_axis<std::uint32_t>(group, "realization", n_realizations,
                                            "index of the realization");
}

void write_label(hid_t dataset, const ObservableLabel& label) {
  if (!label.units.empty()) write_attribute(dataset, "units", label.units);
  if (!label.long_name.empty()) write_attribute(dataset, "long_name", label.long_name);
  if (!label.source.empty()) write_attribute(dataset, "source", label.source);
}

Shape chunk_along_first(const Shape& shape) {
  constexpr hsize_t numbers_a_chunk = 65536;
  hsize_t others = 1;
  for (std::size_t i = 1; i < shape.size(); ++i) others *= shape[i];
  Shape chunk = shape;
  chunk[0] = std::clamp<hsize_t>(numbers_a_chunk / std::max<hsize_t>(others, 1), 1,
                                 std::max<hsize_t>(shape[0], 1));
  return chunk;
}

void write_ensemble_columns(hid_t group, const std::vector<ObservableLabel>& labels,
                            const std::vector<std::vector<double>>& columns,
                            std::uint32_t n_realizations) {
  const Hdf5Handle taps = write_tap_axis(group, columns.front().size() / n_realizations);
  for (std::size_t c = 0; c < columns.size(); ++c)
    write_ensemble_column(group, taps, labels[c], columns[c], n_realizations);
}

void write_snapshot_statistics(hid_t group, const Snapshots& snapshots,
                               std::uint32_t n_realizations,
                               const std::vector<double>& coordination,
                               const std::vector<std::vector<double>>& histograms) {
  const Hdf5Handle taps = write_numbers(group, "tap", snapshots.taps);
  write_label(taps, {"tap", "1", "number of taps; 0 is the start", ""});
  make_axis(taps, "tap");
  const Hdf5Handle realizations = write_realization_axis(group, n_realizations);
  const Shape shape{snapshots.taps.size(), n_realizations};
  if (snapshots.coordination) {
    const Hdf5Handle dataset =
        write_numbers<double>(group, "coordination", shape, coordination, chunk_along_first(shape));
    write_label(dataset, {"coordination", "1", "mean number of centres within contact_cut",
                          "Rosato et al. 2010"});
    write_attribute(dataset, "contact_cut", snapshots.contact_cut);
    const Hdf5Handle* const axes[] = {&taps, &realizations};
    attach_axes(dataset, axes);
  }
  if (snapshots.height_histogram)
    write_histograms(group, taps, realizations, snapshots.bin_width, histograms, shape);
}

}  // namespace jostle
