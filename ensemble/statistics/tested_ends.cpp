#include "ensemble/statistics/tested_ends.hpp"

#include <algorithm>
#include <cmath>

#include "engine/numbers.hpp"
#include "fitting/fit.hpp"
#include "fitting/intervals/distributions.hpp"

namespace jostle::inline ensemble {

TestedEnds tested_ends(const std::vector<double>& values, double best, double dof,
                       const std::function<double(double value)>& t_of) {
  TestedEnds ends{{-infinite, -infinite}, {infinite, infinite}};
  for (const bool up : {false, true}) {
    double inside = best, t_inside = 0;
    std::size_t found = 0;  // levels
    const std::size_t n = values.size();
    for (std::size_t i = 0; i < n && found < 2; ++i) {
      const double value = up ? values[i] : values[n - 1 - i];
      if (up ? value <= best : value >= best) continue;
      const double t = std::abs(t_of(value));
      for (; found < 2; ++found) {
        const double threshold = student_two_sided(interval_levels[found], dof);
        if (!(t > threshold)) break;
        const double share = std::max(0.0, (threshold - t_inside) / (t - t_inside));
        (up ? ends.high : ends.low)[found] = std::lerp(inside, value, share);
      }
      inside = value;
      t_inside = t;
    }
  }
  return ends;
}

}  // namespace jostle::inline ensemble
