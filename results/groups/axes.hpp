#pragma once

#include <cstdint>
#include <vector>

#include "ensemble/fold.hpp"
#include "results/hdf5/write.hpp"
#include "structure/observables.hpp"

// Axes and labels of the datasets of a point, and the tables that are computed from its series.
namespace jostle::inline results {

/// Taps that are written and read at a time: whole chunks of about 65536 numbers, as many as take
/// 16 MB for all columns of a point.
std::uint64_t rows_a_block(std::uint32_t n_realizations, std::size_t n_columns);

Hdf5Handle write_tap_axis(hid_t group, std::uint64_t n_taps);
Hdf5Handle write_realization_axis(hid_t group, std::uint32_t n_realizations);

/// For the numbers 0 .. n - 1.
Hdf5Handle write_counting_axis(hid_t group, const char* name, std::uint64_t n,
                               const char* long_name);

/// units, long_name and source; a label's empty text leaves its attribute out.
void write_label(hid_t dataset, const Column& label);

/// Chunks of about 65536 numbers that span all dimensions but the first.
Shape chunk_along_first(const Shape& shape);

/// /ensemble/<point>: mean, sigma, standard error and count of every column, [n_taps], some taps at
/// a time.
class EnsembleWriter {
 public:
  EnsembleWriter(hid_t group, const std::vector<Column>& labels, std::uint64_t n_taps);
  /// The taps of the block, folded.
  void write(const SeriesBlock& block);

 private:
  struct Written {
    RowsDataset<double> mean, sigma, error;
    RowsDataset<std::uint32_t> count;
  };
  std::vector<Written> columns_;
};

}  // namespace jostle::inline results
