#include "results/groups/axes.hpp"

#include <algorithm>
#include <numeric>

namespace jostle::inline results {
namespace {

constexpr hsize_t most_numbers_per_chunk = 65536;

template <class Number>
Hdf5Handle write_counting(hid_t group, const char* name, Number n, const char* long_name) {
  RowsDataset<Number> axis(group, name, {n}, chunk_along_first({n}));
  std::vector<Number> values;
  for (Number first = 0; first < n; first += static_cast<Number>(values.size())) {
    values.resize(std::min<std::size_t>(most_numbers_per_chunk, n - first));
    std::iota(values.begin(), values.end(), first);
    axis.write(first, values);
  }
  write_label(axis.dataset(), {name, "1", long_name, ""});
  make_axis(axis.dataset(), name);
  return axis.take();
}

template <class Number>
RowsDataset<Number> labelled_column(hid_t group, const Hdf5Handle& taps, std::uint64_t n_taps,
                                    const Column& label) {
  RowsDataset<Number> column(group, label.name, {n_taps}, chunk_along_first({n_taps}));
  write_label(column.dataset(), label);
  const Hdf5Handle* const axes[] = {&taps};
  attach_axes(column.dataset(), axes);
  return column;
}

}  // namespace

Hdf5Handle write_tap_axis(hid_t group, std::uint64_t n_taps) {
  return write_counting_axis(group, "tap", n_taps, "number of taps; 0 is the start");
}

Hdf5Handle write_realization_axis(hid_t group, std::uint32_t n_realizations) {
  return write_counting<std::uint32_t>(group, "realization", n_realizations,
                                       "index of the realization");
}

Hdf5Handle write_counting_axis(hid_t group, const char* name, std::uint64_t n,
                               const char* long_name) {
  return write_counting<std::uint64_t>(group, name, n, long_name);
}

void write_label(hid_t dataset, const Column& label) {
  if (!label.units.empty()) write_attribute(dataset, "units", label.units);
  if (!label.long_name.empty()) write_attribute(dataset, "long_name", label.long_name);
  if (!label.source.empty()) write_attribute(dataset, "source", label.source);
}

Shape chunk_along_first(const Shape& shape) {
  hsize_t n_others = 1;
  for (std::size_t i = 1; i < shape.size(); ++i) n_others *= shape[i];
  Shape chunk = shape;
  chunk[0] = std::clamp<hsize_t>(most_numbers_per_chunk / std::max<hsize_t>(n_others, 1), 1,
                                 std::max<hsize_t>(shape[0], 1));
  return chunk;
}

std::uint64_t rows_a_block(std::uint32_t n_realizations, std::size_t n_columns) {
  constexpr std::uint64_t bytes_a_block = 16u << 20;
  const std::uint64_t chunk = std::max<std::uint64_t>(most_numbers_per_chunk / n_realizations, 1);
  const std::uint64_t bytes_a_row = n_columns * n_realizations * sizeof(double);
  return std::max<std::uint64_t>(bytes_a_block / bytes_a_row / chunk, 1) * chunk;
}

EnsembleWriter::EnsembleWriter(hid_t group, const std::vector<Column>& labels,
                               std::uint64_t n_taps) {
  const Hdf5Handle taps = write_tap_axis(group, n_taps);
  for (const Column& label : labels) {
    const auto moment = [&](const char* ending, const std::string& meaning) {
      return labelled_column<double>(
          group, taps, n_taps,
          {label.name + ending, label.units, meaning + label.long_name, label.source});
    };
    columns_.push_back(
        {moment("_mean", "mean of "),
         moment("_sigma", "standard deviation (1/M) over realizations of "),
         moment("_error", "standard error of the mean of "),
         labelled_column<std::uint32_t>(
             group, taps, n_taps,
             {label.name + "_count", "1", "realizations with a value of " + label.long_name, ""})});
  }
}

void EnsembleWriter::write(const SeriesBlock& block) {
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const FoldedColumn folded = block.folded(c);
    columns_[c].mean.write(block.first_tap(), folded.mean);
    columns_[c].sigma.write(block.first_tap(), folded.sigma);
    columns_[c].error.write(block.first_tap(), folded.error);
    columns_[c].count.write(block.first_tap(), folded.count);
  }
}

}  // namespace jostle::inline results
