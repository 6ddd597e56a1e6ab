#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "results/file/results_file.hpp"

// Realizations that repeat another one: without random numbers all realizations are one.
namespace jostle::inline study {

/// The first of each group of columns of `values` [n_rows, n_columns] that are equal to the bit,
/// ascending. Columns of one value alone are not compared: every one is kept.
std::vector<std::size_t> distinct_columns(std::span<const double> values, std::size_t n_columns);

/// Those of `realizations` (ascending) that repeat no earlier one over the first `n_rows` taps, by
/// the rule of ObservableSeries::copies().
std::vector<std::uint32_t> distinct_realizations(const ResultsFile& file, std::uint32_t point,
                                                 const std::string& observable,
                                                 const std::vector<std::uint32_t>& realizations,
                                                 std::uint64_t n_rows);

/// "3 of the 4 realizations repeat the series of another, so 1 realization is used"; empty without
/// copies.
std::string copies_text(std::size_t n_copies, std::size_t n_distinct);

/// Realizations of a sweep point that repeat an earlier one: the packings and displacements of a
/// copy repeat those of the first, too.
struct Repetitions {
  std::vector<std::uint32_t> realizations{};  // ascending
  std::string text{};                         // copies_text()
  bool leave_one = false;                     // true if all realizations are copies of one
};
Repetitions repetitions(const ResultsFile& file, std::uint32_t point);
/// Those that repeat an earlier one by the series of this observable.
Repetitions repetitions(const ResultsFile& file, std::uint32_t point,
                        const std::string& observable);

/// ResultsFile::ensemble() with one of realizations that repeat each other. Stored statistics count
/// all.
std::vector<EnsembleSeries> distinct_ensemble(const ResultsFile& file, std::uint32_t point,
                                              const Repetitions& copies);

}  // namespace jostle::inline study
