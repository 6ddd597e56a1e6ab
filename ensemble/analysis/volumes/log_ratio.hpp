#pragma once

#include <span>

#include "ensemble/analysis/volumes/compactivity.hpp"

namespace jostle::inline ensemble {

/// ln[P_2(V) / P_1(V)] as a straight line, and as a parabola.
struct LogRatio {
  double slope = 0;         // slope of the line, per volume
  double slope_change = 0;  // change of slope of the parabola, over one `scale`
};

/// For two histograms, shares of bins, [n_bins], that overlap: by maximum likelihood of each
/// volume's belonging to one or the other (logistic regression), with equal weights. Each bin is
/// represented by its middle; `centre` and `scale` make the volumes about 0 and 1.
LogRatio log_ratio(std::span<const double> first, std::span<const double> second,
                   const VolumeBins& bins, double centre, double scale);

/// Sum over bins of the smaller share.
double shared(std::span<const double> first, std::span<const double> second);

}  // namespace jostle::inline ensemble
