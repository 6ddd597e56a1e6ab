#pragma once

#include "fitting/curve.hpp"

namespace jostle::inline fitting {

/// A long curve as means over at most 1 % of t. They lose nothing of a law X(t) that is smooth in
/// ln t: over such a bin its mean differs from its value at the bin's mean t by 1e-4 / 24 of
/// t^2 X''(t). Weighted by 1/sigma^2, with the errors of the means where the curve has errors;
/// without, sigma is 1 over the root of the number of points. Curves of at most `most` points, and
/// those with negative t or not spanning a factor 100, stay as they are. Realizations are left out.
Curve binned(const Curve& curve, std::size_t most = 5000);

}  // namespace jostle::inline fitting
