#include "fitting/solver/grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fitting/solver/projection.hpp"

namespace jostle::inline fitting {

namespace {

constexpr double hopeless = 10;  // times the least cost on a grid, however coarse
constexpr double most_work =
    1.2e7;  // most work of a grid: places times points times parameters squared
constexpr std::size_t sampled = 128;  // points of a curve, by Model::starts()

// Leaves each axis of a linear or fixed parameter its one value, and the last axes of a grid that
// is too large their middle one.
void thin(const Model& model, std::span<const double> fixed, std::size_t points, Grid& grid) {
  const std::size_t most = most_places(grid.axes.size(), points);
  std::size_t places = 1;
  for (std::size_t j = 0; j < grid.axes.size(); ++j) {
    std::vector<double>& axis = grid.axes[j];
    if (model.parameters()[j].linear) axis = {0};
    if (!std::isnan(fixed[j])) axis = {fixed[j]};
    if (places * axis.size() > most) axis = {axis[axis.size() / 2]};
    places *= axis.size();
  }
}

// Costs on a grid, the first axis running fastest.
class Landscape {
 public:
  Landscape(const Model& model, const Curve& curve, std::span<const double> fixed,
            const Grid& grid);

  /// True if no neighbour, diagonal ones included, is better.
  bool is_valley(std::size_t index) const;

  std::vector<double> costs;  // infinite where there is nothing
  std::vector<ParameterValues> parameters;

 private:
  std::vector<std::size_t> lengths_, strides_;  // strides of axes with more than one value
};

Landscape::Landscape(const Model& model, const Curve& curve, std::span<const double> fixed,
                     const Grid& grid) {
  std::size_t size = 1;
  for (const std::vector<double>& axis : grid.axes) {
    if (axis.size() > 1) {
      lengths_.push_back(axis.size());
      strides_.push_back(size);
    }
    size *= axis.size();
  }
  Projection project(model, curve, fixed);
  for (std::size_t index = 0; index < size; ++index) {
    ParameterValues p;
    std::size_t rest = index;
    for (const std::vector<double>& axis : grid.axes) {
      p.push_back(axis[rest % axis.size()]);
      rest /= axis.size();
    }
    const bool placed = !grid.place || grid.place(p);
    costs.push_back(placed ? project(p) : std::numeric_limits<double>::infinity());
    parameters.push_back(std::move(p));
  }
}

bool Landscape::is_valley(std::size_t index) const {
  std::size_t neighbours = 1;
  for (std::size_t axis = 0; axis < lengths_.size(); ++axis) neighbours *= 3;
  for (std::size_t number = 0; number < neighbours; ++number) {
    std::size_t neighbour = index, rest = number;
    bool inside = true;
    for (std::size_t axis = 0; axis < lengths_.size(); ++axis, rest /= 3) {
      const std::size_t digit = index / strides_[axis] % lengths_[axis];
      if (rest % 3 == 1) {
        inside = inside && digit > 0;
        neighbour -= strides_[axis];
      } else if (rest % 3 == 2) {
        inside = inside && digit + 1 < lengths_[axis];
        neighbour += strides_[axis];
      }
    }
    if (!inside) continue;
    if (costs[neighbour] < costs[index] ||
        (costs[neighbour] == costs[index] && neighbour < index)) {
      return false;
    }
  }
  return true;
}

}  // namespace

std::size_t most_places(std::size_t n_parameters, std::size_t points) {
  const double p = static_cast<double>(n_parameters), n = static_cast<double>(points);
  return static_cast<std::size_t>(std::max(1.0, most_work / (n * p * p)));
}

long long evaluations_of_starts(const Model& model, const Curve& curve,
                                std::span<const double> fixed) {
  const std::size_t points = std::min(curve.t.size(), sampled);
  Grid grid{.axes = model.candidates(curve)};
  thin(model, fixed, points, grid);
  double places = 1;
  for (const std::vector<double>& axis : grid.axes) places *= static_cast<double>(axis.size());
  const double share = static_cast<double>(points) / static_cast<double>(curve.t.size());
  return std::llround(share * places * static_cast<double>(1 + grid.axes.size()));
}

std::vector<ParameterValues> best_of_grid(const Model& model, const Curve& curve,
                                          std::span<const double> fixed, Grid grid, std::size_t n) {
  thin(model, fixed, curve.t.size(), grid);
  Landscape landscape(model, curve, fixed, grid);
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < landscape.costs.size(); ++i) {
    if (std::isfinite(landscape.costs[i])) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return landscape.costs[a] < landscape.costs[b];
  });
  std::vector<std::size_t> valleys;
  for (std::size_t i : order) {
    if (valleys.size() >= n || landscape.costs[i] > hopeless * landscape.costs[order[0]]) break;
    if (landscape.is_valley(i)) valleys.push_back(i);
  }
  std::vector<std::size_t> chosen = valleys;
  for (std::size_t i : order) {
    if (chosen.size() >= n) break;
    if (std::find(valleys.begin(), valleys.end(), i) == valleys.end()) chosen.push_back(i);
  }
  std::vector<ParameterValues> starts;
  for (std::size_t i : chosen) starts.push_back(std::move(landscape.parameters[i]));
  return starts;
}

}  // namespace jostle::inline fitting
