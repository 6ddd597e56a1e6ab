#pragma once

#include <cstdint>
#include <vector>

#include "ensemble/plan.hpp"
#include "results/hdf5_write.hpp"
#include "structure/observables.hpp"

// Axes and labels of the datasets of a point, and the tables that are computed from its series.
namespace jostle {

Hdf5Handle write_tap_axis(hid_t group, std::uint64_t n_taps);
Hdf5Handle write_realization_axis(hid_t group, std::uint32_t n_realizations);

/// units, long_name and source; a label's empty text leaves its attribute out.
void write_label(hid_t dataset, const ObservableLabel& label);

/// Chunks of about 65536 numbers that span all dimensions but the first.
Shape chunk_along_first(const Shape& shape);

/// /ensemble/<point>: mean, sigma, standard error and count of every column, [n_taps]. `columns`:
/// [n_columns] of [n_taps, n_realizations], folded in the order of realizations.
void write_ensemble_columns(hid_t group, const std::vector<ObservableLabel>& labels,
                            const std::vector<std::vector<double>>& columns,
                            std::uint32_t n_realizations);

/// /snapshots/<point>: `coordination` and `histograms` have shape [n_taps, n_realizations].
void write_snapshot_statistics(hid_t group, const Snapshots& snapshots,
                               std::uint32_t n_realizations,
                               const std::vector<double>& coordination,
                               const std::vector<std::vector<double>>& histograms);

}  // namespace jostle
