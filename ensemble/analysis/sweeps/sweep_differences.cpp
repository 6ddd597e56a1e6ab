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

SweepDifference difference(const SweepCurve& curve, std::size_t from, std::size_t to) {
  SweepDifference found{.from = from, .to = to};
  if (curve.streams() == Streams::matched) {
    const auto& a = curve.realizations()[from];
    const auto& b = curve.realizations()[to];
    Moments pairs;
    for (std::size_t r = 0; r < std::min(a.size(), b.size()); ++r) pairs.add(b[r] - a[r]);
    found.value = pairs.mean();
    found.error = error_of_mean(pairs);
    found.pairs = pairs.count();
  } else {
    found.value = curve.y()[to] - curve.y()[from];
    found.error = combined(curve.error()[from], curve.error()[to]);
  }
  found.p = p_value(found.value, found.error);
  return found;
}

void correct_for_number(std::vector<SweepDifference>& all) {
  std::vector<double> p;
  for (const SweepDifference& one : all) p.push_back(one.p);
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

std::vector<SweepDifference> differences(const SweepCurve& curve, ComparedPairs which) {
  std::vector<SweepDifference> all;
  if (!curve.has_realizations()) return all;
  const std::size_t n_from = which == ComparedPairs::all_pairs ? curve.n_points() : 1;
  for (std::size_t from = 0; from < n_from; ++from) {
    for (std::size_t to = from + 1; to < curve.n_points(); ++to) {
      SweepDifference one = difference(curve, from, to);
      if (one.error.known() && !(one.error.error > 0)) {
        one.error = {};
        one.p = p_value(one.value, one.error);
      }
      all.push_back(one);
    }
  }
  correct_for_number(all);
  return all;
}

}  // namespace jostle::inline ensemble
