#include <algorithm>
#include <cmath>

#include "ensemble/analysis/sweeps/sweep_curve.hpp"
#include "ensemble/moments.hpp"

namespace jostle::inline ensemble {

namespace {

ErrorOf error_of_mean(const Moments& moments) {
  if (moments.count() < 2) return {};
  return {moments.standard_error(), static_cast<double>(moments.count() - 1)};
}

SweepDifference difference(const SweepCurve& curve, std::size_t start, std::size_t end) {
  SweepDifference found{.start = start, .end = end};
  if (curve.streams() == Streams::matched) {
    const auto& a = curve.realizations()[start];
    const auto& b = curve.realizations()[end];
    Moments pairs;
    for (std::size_t r = 0; r < std::min(a.size(), b.size()); ++r) pairs.add(b[r] - a[r]);
    found.value = pairs.mean();
    found.error = error_of_mean(pairs);
    found.pairs = pairs.count();
  } else {
    found.value = curve.y()[end] - curve.y()[start];
    found.error = combined(curve.error()[start], curve.error()[end]);
  }
  found.p = p_value(found.value, found.error);
  return found;
}

void correct_for_number(std::vector<SweepDifference>& all) {
  std::vector<double> p;
  for (const SweepDifference& difference : all) p.push_back(difference.p);
  p = corrected_for_number(p);
  for (std::size_t i = 0; i < all.size(); ++i) all[i].corrected = p[i];
}

}  // namespace

std::vector<SweepDifference> differences(const SweepCurve& curve,
                                         std::optional<std::size_t> reference) {
  std::vector<SweepDifference> all;
  if (!curve.has_realizations()) return all;
  for (std::size_t i = 0; i < curve.n_points(); ++i) {
    if (reference && i != *reference) all.push_back(difference(curve, *reference, i));
    if (!reference && i > 0) all.push_back(difference(curve, i - 1, i));
  }
  correct_for_number(all);
  return all;
}

std::vector<SweepDifference> differences(const SweepCurve& curve, ComparedPairs pairs) {
  std::vector<SweepDifference> all;
  if (!curve.has_realizations()) return all;
  const std::size_t n_from = pairs == ComparedPairs::all_pairs ? curve.n_points() : 1;
  for (std::size_t start = 0; start < n_from; ++start) {
    for (std::size_t end = start + 1; end < curve.n_points(); ++end) {
      SweepDifference tested = difference(curve, start, end);
      if (tested.error.known() && !(tested.error.error > 0)) {
        tested.error = {};
        tested.p = p_value(tested.value, tested.error);
      }
      all.push_back(tested);
    }
  }
  correct_for_number(all);
  return all;
}

}  // namespace jostle::inline ensemble
