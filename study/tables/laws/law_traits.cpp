#include "study/tables/laws/law_traits.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "fitting/solver/decompositions.hpp"

namespace jostle::inline study {

namespace {

constexpr double rounding = 1e-9;  // relative, that counts as none
// Logarithmic slopes that differences with a step of 1e-3 still give to 7 digits.
constexpr double steepest = 20;

// Where a law is looked at.
struct Probe {
  double t;
  ParameterValues p;
};

// Parameters within 30 % of the start, or of 1 where that is 0; those with bounds keep their start.
std::vector<Probe> probes(const ParameterValues& start, const std::vector<Parameter>& parameters) {
  std::vector<Probe> all;
  for (int set = 0; set < 4; ++set) {
    ParameterValues p = start;
    for (std::size_t j = 0; j < p.size(); ++j) {
      const double share = 0.3 * std::sin(2.0 + 3.0 * set + 1.7 * static_cast<double>(j));
      const double moved = p[j] + share * (p[j] == 0 ? 1 : p[j]);
      if (moved > parameters[j].lower && moved < parameters[j].upper) p[j] = moved;
    }
    for (double t : geometric(1e-3, 1e4, 29)) all.push_back({t, p});
  }
  return all;
}

// True if f(a + b) - f(a) - f(b) + f is nothing but rounding, for a step along each of two
// parameters, or twice along one.
bool no_second_difference(const LawValue& law, const Probe& probe, std::size_t j, std::size_t k) {
  const auto value = [&](double along_j, double along_k) {
    ParameterValues p = probe.p;
    p[j] += along_j * (1 + std::abs(probe.p[j]));
    p[k] += along_k * (1.3 + std::abs(probe.p[k]));
    return law(probe.t, p.data());
  };
  const double none = value(0, 0), first = value(1, 0), second = value(0, 1), joint = value(1, 1);
  const double size = std::abs(none) + std::abs(first) + std::abs(second) + std::abs(joint);
  return std::abs(joint - first - second + none) <= rounding * size;
}

void find_linear(const LawValue& law, const std::vector<Probe>& probes,
                 std::vector<Parameter>& parameters) {
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    if (std::isfinite(parameters[j].lower) || std::isfinite(parameters[j].upper)) continue;
    parameters[j].linear = std::ranges::all_of(probes, [&](const Probe& probe) {
      if (!std::isfinite(law(probe.t, probe.p.data()))) return true;  // no information
      for (std::size_t k = 0; k <= j; ++k) {
        const bool is_joint = k == j || parameters[k].linear;
        if (is_joint && !no_second_difference(law, probe, j, k)) return false;
      }
      return true;
    });
  }
}

// x df/dx by differences of fourth order; `move` gives the law with x multiplied.
double logarithmic_slope(const std::function<double(double factor)>& move) {
  constexpr double h = 1e-3;
  return (8 * (move(1 + h) - move(1 - h)) - (move(1 + 2 * h) - move(1 - 2 * h))) / (12 * h);
}

// Rows of p_j df/dp_j, t df/dt and f, a probe each, scaled to size 1.
struct Slopes {
  Eigen::MatrixXd by_parameter;  // [n, n_parameters]
  Eigen::VectorXd by_t, value;   // [n]
};
std::optional<Slopes> slopes(const LawValue& law, const std::vector<Probe>& probes) {
  const auto n = static_cast<Eigen::Index>(probes.front().p.size());
  std::vector<Eigen::VectorXd> rows;
  for (const Probe& probe : probes) {
    Eigen::VectorXd row(n + 2);
    for (Eigen::Index j = 0; j < n; ++j) {
      row[j] = logarithmic_slope([&](double factor) {
        ParameterValues p = probe.p;
        p[static_cast<std::size_t>(j)] *= factor;
        return law(probe.t, p.data());
      });
    }
    row[n] =
        logarithmic_slope([&](double factor) { return law(probe.t * factor, probe.p.data()); });
    row[n + 1] = law(probe.t, probe.p.data());
    const double size = row.cwiseAbs().maxCoeff();
    const bool even = size <= steepest * std::abs(row[n + 1]);
    if (std::isfinite(size) && size > 1e-200 && even) rows.emplace_back(row / size);
  }
  const auto found = static_cast<Eigen::Index>(rows.size());
  if (found < 2 * (n + 2)) return std::nullopt;
  Slopes all{Eigen::MatrixXd(found, n), Eigen::VectorXd(found), Eigen::VectorXd(found)};
  for (Eigen::Index i = 0; i < found; ++i) {
    const Eigen::VectorXd& row = rows[static_cast<std::size_t>(i)];
    all.by_parameter.row(i) = row.head(n).transpose();
    all.by_t[i] = row[n];
    all.value[i] = row[n + 1];
  }
  return all;
}

// The powers with which the parameters carry a unit, where whole ones solve the equations, and only
// they do.
std::optional<std::vector<int>> powers(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  if (column_rank(a) < a.cols()) return std::nullopt;
  const Eigen::VectorXd solution = least_squares(a, b);
  const Eigen::VectorXd whole = solution.array().round().matrix();
  if (!((a * whole - b).cwiseAbs().maxCoeff() < 1e-6)) return std::nullopt;
  std::vector<int> found;
  for (double power : whole) found.push_back(static_cast<int>(power));
  return found;
}

ParameterUnit unit_of(int of_value, int of_time) {
  if (of_value == 1 && of_time == 0) return ParameterUnit::value;
  if (of_value == 0 && of_time == 1) return ParameterUnit::time;
  if (of_value == 1 && of_time == -1) return ParameterUnit::value_per_time;
  if (of_value == 1 && of_time == 1) return ParameterUnit::value_time;
  if (of_value == 0 && of_time == -1) return ParameterUnit::per_time;
  return ParameterUnit::none;
}

}  // namespace

void find_traits(const LawValue& law, const ParameterValues& start,
                 std::vector<Parameter>& parameters) {
  const std::vector<Probe> places = probes(start, parameters);
  const std::optional<Slopes> found = slopes(law, places);
  if (!found) return;
  find_linear(law, places, parameters);
  // f(t; u^v p) = u f and f(u t; u^w p) = f for every u: their derivatives by u at u = 1.
  const auto of_value = powers(found->by_parameter, found->value);
  const auto of_time = powers(found->by_parameter, -found->by_t);
  if (!of_value && !of_time) return;
  const std::vector<int> none(parameters.size(), 0);
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    parameters[j].unit = unit_of(of_value.value_or(none)[j], of_time.value_or(none)[j]);
  }
}

}  // namespace jostle::inline study
