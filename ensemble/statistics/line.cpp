#include "ensemble/statistics/line.hpp"

#include "ensemble/moments.hpp"

namespace jostle::inline ensemble {

Line fit_line(std::span<const double> series) {
  const auto n = static_cast<double>(series.size());
  Moments moments;
  for (const double value : series) moments.add(value);
  Line line{.center = 0.5 * (n - 1), .middle = moments.mean()};
  for (std::size_t i = 0; i < series.size(); ++i) {
    line.slope += (static_cast<double>(i) - line.center) * (series[i] - line.middle);
  }
  // Sum of (i - center)^2: n (n^2 - 1) / 12.
  line.slope = series.size() < 2 ? 0 : line.slope / (n * (n * n - 1) / 12);
  return line;
}

}  // namespace jostle::inline ensemble
