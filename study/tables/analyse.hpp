#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "config/scene.hpp"
#include "ensemble/analysis/steady_state.hpp"
#include "ensemble/analysis/table.hpp"
#include "results/file/results_file.hpp"
#include "study/tables/observable_series.hpp"

namespace jostle::inline study {

/// The tables of all analyses at the given sweep points, point_PPPP/<analysis>/<observable>, as
/// results files keep them, then those over all of these points (over_points.hpp; and
/// ordering/<observable>, which compares them where there are several); curves against what is
/// swept are not made here. An analysis that is not possible gives a table with the note "refused"
/// alone. The tables do not depend on the number of threads. Throws BadArgument for an observable
/// that there is not.
std::vector<Table> analyse(const ResultsFile& file, std::span<const std::uint32_t> points,
                           const Analyses& analyses, int threads);

/// The last taps of a series, without its start: `n_taps`, or where that is absent a part of them,
/// 1/divisor, at least `least`. Uses only the first `rows` rows, if given. Throws BadInput if there
/// are fewer.
AnalysedSeries last_taps(const ObservableSeries& series, std::optional<std::uint64_t> n_taps,
                         std::uint64_t divisor, std::uint64_t least,
                         std::optional<std::uint64_t> rows = std::nullopt);

/// "taps 151 to 160 have other strengths than taps 161 to 200: for one strength set last to 40 or
/// less"; empty where all have one.
std::string several_strengths(const Scene& scene, const AnalysedSeries& taps);

/// True if these taps are steady, as the analysis of that name decides; nothing where they are too
/// few for it.
std::optional<Verdict> steadiness(const ObservableSeries& series, const AnalysedSeries& taps);

}  // namespace jostle::inline study
