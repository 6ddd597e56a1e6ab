#pragma once

#include <string>
#include <vector>

#include "fitting/fit.hpp"

namespace jostle {

/// A fit for people: the law, a table of parameters with errors and intervals, what the data say of
/// each, how good the fit is, and remarks. Several lines, each ended by a newline.
std::string describe(const Fit& fit);

/// Fits of one curve by several models, best AIC first: reduced chi2, R2, AIC and BIC with their
/// distance from the best.
std::string compare(const std::vector<Fit>& fits);

}  // namespace jostle
