#include "fitting/solver/bounds.hpp"

#include <cmath>

#include "fitting/numbers.hpp"
#include "fitting/solver/curve_residuals.hpp"

namespace jostle::inline fitting {

namespace {

constexpr double on_bound = 1e-8;  // distance of a value on its bound, in resolved distances
constexpr double place = 1e-6;     // where it is put

double cost_at(const Surroundings& minimum, const ParameterValues& values) {
  const CurveResiduals residuals(minimum.model, minimum.curve, values,
                                 std::vector<bool>(values.size(), false), minimum.level_weight);
  Eigen::VectorXd r(residuals.n_residuals());
  residuals.values(Eigen::VectorXd(0), r);
  const double cost = r.squaredNorm();
  return std::isfinite(cost) ? cost : infinite;
}

}  // namespace

// By bisection of the logarithm of the distance.
std::optional<NearBound> near_bound(const Surroundings& minimum, const ParameterValues& values,
                                    std::size_t index) {
  const Parameter& parameter = minimum.model.parameters()[index];
  const double to_lower = values[index] - parameter.lower,
               to_upper = parameter.upper - values[index];
  if (!std::isfinite(to_lower) && !std::isfinite(to_upper)) return std::nullopt;
  NearBound found{parameter.lower, to_lower, 1};
  if (to_upper < to_lower) found = {parameter.upper, to_upper, -1};
  const double room = to_lower + to_upper;
  double low = std::log(std::max(found.distance, std::numeric_limits<double>::min()));
  double high = std::isfinite(room) ? std::log(room) : std::log(std::numeric_limits<double>::max());
  ParameterValues moved = values;
  const auto rises = [&](double logarithm) {
    moved[index] = found.bound + found.direction * std::exp(logarithm);
    return cost_at(minimum, moved) > minimum.cost + minimum.variance;
  };
  constexpr double room_left = 1e-9;
  if (!(low < high - room_left) || !rises(high - room_left)) return std::nullopt;
  while (high - low > 0.1) {
    const double middle = 0.5 * (low + high);
    (rises(middle) ? high : low) = middle;
  }
  found.resolved = std::exp(low);
  return found;
}

ParameterValues off_bounds(const Surroundings& minimum, ParameterValues values,
                           const std::vector<bool>& free) {
  const ParameterValues found = values;
  for (std::size_t j = 0; j < values.size(); ++j) {
    const auto near = free[j] ? near_bound(minimum, found, j) : std::nullopt;
    if (!near || near->distance > on_bound * near->resolved) continue;
    values[j] = near->bound + near->direction * place * near->resolved;
  }
  return values;
}

}  // namespace jostle::inline fitting
