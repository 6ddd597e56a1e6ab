#pragma once

#include <functional>
#include <vector>

#include "fitting/models/model.hpp"

namespace jostle::inline study {

/// A law's value at t with parameters p.
using LawValue = std::function<double(double t, const double* p)>;

/// Marks the parameters in which the law is linear, all of them together, among those without
/// bounds, and gives those units that it determines: X where X grows with them alone, t where a
/// stretched t needs them stretched alike (Euler's theorem on homogeneous functions). Both are read
/// off its values for parameters about 1, or about 1 from their bounds, and t from 1e-3 to 1e4;
/// without information the parameters are not changed. Returns false where the formula leaves a
/// unit of X or of t open.
bool find_traits(const LawValue& law, std::vector<Parameter>& parameters);

}  // namespace jostle::inline study
