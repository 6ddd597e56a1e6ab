#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "config/scene.hpp"
#include "ensemble/analysis/table.hpp"
#include "results/file/results_file.hpp"
#include "study/tables/points/point_scenes.hpp"

// Analyses over the sweep points of one file together. An impossible analysis gives a table with
// only the note "refused". Throw BadArgument for an unknown observable.
namespace jostle::inline study {

/// Advice for an analysis that needs more sweep points than the chosen ones; empty if all were
/// chosen.
std::string of_chosen_points(const ResultsFile& file, std::span<const std::uint32_t> points);

/// How far a sweep point has come.
struct ReachedTaps {
  std::uint64_t planned = 0;  // taps of its protocol
  std::uint64_t rows = 0;     // taps of all its realizations, including tap 0; 0: none has taps
};

/// Common taps of compared points. Only points with equally long protocols are compared.
struct SharedTaps {
  std::vector<std::uint64_t> rows;   // [points] whose last taps are compared, the same for all
  std::vector<std::string> reasons;  // [points] why one is left out: it has no taps, or less than
                                     // half of what another has; else empty
};
SharedTaps shared_taps(std::span<const ReachedTaps> points);

/// Refusal of a curve over points of which none has a value: what was sought, the reason at each
/// place of the axis ("" where it is not known), and advice.
std::string without_any_value(const std::string& quantity, const std::string& observable,
                              const std::string& axis,
                              const std::vector<std::pair<double, std::string>>& reasons);

/// Sentences about single sweep points, for one note of a table.
class PointNotes {
 public:
  /// An empty text adds nothing.
  void add(const std::string& label, const std::string& text);
  bool is_empty() const { return texts_.empty(); }
  /// Appends "LABEL: TEXT; LABEL: TEXT", each once; nothing without a text.
  void note(const std::string& name, Table& table) const;

 private:
  std::vector<std::string> texts_;
};

/// Throws BadInput where no realization of the point has taps: all failed, or none is begun.
void require_taps(const ResultsFile& file, std::uint32_t point, std::size_t n_realizations);

/// volumes/<observable>, over strengths; of points whose own protocol goes through several
/// strengths point_PPPP/volumes/<observable>, over the steps of its last branch. With other values
/// swept too, one table for every combination, numbered.
std::vector<Table> volume_tables(const ResultsFile& file, const PointScenes& scenes,
                                 std::span<const std::uint32_t> points,
                                 std::span<const AnalysisRequest<VolumesSettings>> requests);

/// memory/<observable>: the points are ways of reaching a value, the last stage of their protocols
/// is common to all.
std::vector<Table> memory_tables(const ResultsFile& file, const PointScenes& scenes,
                                 std::span<const std::uint32_t> points,
                                 std::span<const AnalysisRequest<MemorySettings>> requests);

}  // namespace jostle::inline study
