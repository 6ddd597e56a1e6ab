#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "results/file/results_file.hpp"

namespace jostle::inline study {

/// One observable at one sweep point of a results file, read in pieces of at most 128 MB, whatever
/// the number of taps and realizations. Realizations that failed or have no taps are left out, and
/// taps that not all others have reached. Copies of a realization are left out, too: they are no
/// independent measurements.
class ObservableSeries {
 public:
  /// Throws BadInput naming the observables there are. `file` must outlive this.
  ObservableSeries(const ResultsFile& file, std::uint32_t point, const std::string& observable);

  const Column& label() const { return label_; }
  /// Taps 0 .. n_rows() - 1 are there; 0 where there is no realization.
  std::uint64_t n_rows() const { return n_rows_; }
  std::uint32_t n_realizations() const { return static_cast<std::uint32_t>(used_.size()); }
  /// Their numbers, ascending.
  const std::vector<std::uint32_t>& realizations() const { return used_; }

  /// "; realization 3 has reached only tap 0, the farthest tap 60": where they have not come
  /// equally far; else empty.
  std::string held_back() const;

  /// "3 of the 4 realizations repeat the series of another ..."; empty where no realization is a
  /// copy. Two series are copies where all values agree to the bit and either eight of them differ
  /// or all other columns of both realizations agree as well: short series of a discrete observable
  /// also agree by chance.
  std::string copies() const;

  /// Calls `take` with the values at these taps of one realization after another. Throws BadInput
  /// where one of them is not a number.
  void for_each(const TapRange& taps,
                const std::function<void(std::span<const double>)>& take) const;
  /// Mean of each realization over these taps, [n_realizations]; NaN of those that have not reached
  /// the last of them. Throws BadInput as for_each().
  std::vector<double> means(const TapRange& taps) const;
  /// All values at these taps, [n_taps, n_realizations].
  std::vector<double> values(const TapRange& taps) const;
  /// Values at chosen taps, each below n_rows(): [n_taps, n_realizations].
  std::vector<double> rows(std::span<const std::uint64_t> taps) const;

 private:
  void for_each_of(const std::vector<std::uint32_t>& realizations, const TapRange& taps,
                   const std::function<void(std::span<const double>)>& take) const;
  void leave_out_copies();

  const ResultsFile& file_;
  std::uint32_t point_;
  Column label_;
  std::vector<std::uint32_t> used_;     // realizations
  std::vector<std::uint64_t> reached_;  // rows of each
  std::uint64_t n_rows_ = 0;
  std::size_t n_copies_ = 0;
};

}  // namespace jostle::inline study
