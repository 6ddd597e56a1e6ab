#pragma once

#include <string>
#include <vector>

#include "fitting/report.hpp"

namespace jostle::inline fitting {

/// The first lines of a report about the fits of one curve; each is one line without a newline.
struct FitsSummary {
  std::string choice;     // the chosen law, or why none is; of a single law what is identified
  std::string asymptote;  // with its 95 % interval; empty where no law has an asymptote
  std::string warning;    // the most severe; empty where there is none
};

/// Summarizes the full laws. The asymptote of several laws that are not rejected has one interval,
/// which contains the interval of every such law.
FitsSummary summary(const std::vector<Fit>& fits, const LawComparison& comparison,
                    const CurveUnits& units);

}  // namespace jostle::inline fitting
