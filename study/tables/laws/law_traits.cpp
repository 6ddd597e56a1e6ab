#include "study/tables/laws/law_traits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

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

// Parameters about 1 (from their bounds, where they have any), whatever the start is: the traits
// are those of the formula. The last sets have both signs.
std::vector<Probe> probes(const std::vector<Parameter>& parameters) {
  constexpr int n_sets = 8, n_positive = 5;
  std::vector<Probe> all;
  for (int set = 0; set < n_sets; ++set) {
    ParameterValues p;
    for (std::size_t j = 0; j < parameters.size(); ++j) {
      const auto [lower, upper] = std::pair{parameters[j].lower, parameters[j].upper};
      const double wave = std::sin(2.0 + 3.0 * set + 1.7 * static_cast<double>(j));
      const double size = std::exp(0.8 * wave);
      if (std::isfinite(lower) && std::isfinite(upper)) {
        p.push_back(lower + (0.5 + 0.3 * wave) * (upper - lower));
      } else if (std::isfinite(lower) || std::isfinite(upper)) {
        p.push_back(std::isfinite(lower) ? lower + size : upper - size);
      } else {
        const bool negative = set >= n_positive && std::sin(5.0 * set + 2.3 * j) < 0;
        p.push_back(negative ? -size : size);
      }
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

// x df/dx by differences of fourth order; `move` gives the law with x multiplied. NaN where a step
// of half the length gives another slope: the law bends or jumps within the step.
double logarithmic_slope(const std::function<double(double factor)>& move) {
  const auto with_step = [&](double h) {
    return (8 * (move(1 + h) - move(1 - h)) - (move(1 + 2 * h) - move(1 - 2 * h))) / (12 * h);
  };
  constexpr double step = 1e-3, agreement = 1e-7;
  const double slope = with_step(step), repeated = with_step(step / 2);
  const double size = std::abs(slope) + std::abs(move(1));
  return std::abs(slope - repeated) <= agreement * size ? slope
                                                        : std::numeric_limits<double>::quiet_NaN();
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
    if (row.allFinite() && size > 1e-200 && even) rows.emplace_back(row / size);
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

using Powers = std::vector<int>;

// False where columns depend on each other but for the rounding of differences.
bool has_full_rank(const Eigen::MatrixXd& columns) {
  const Eigen::VectorXd norms = columns.colwise().norm().transpose();
  const Eigen::VectorXd values =
      singular_values(upper_triangle(columns * norms.cwiseInverse().asDiagonal())).values;
  constexpr double least_share = 1e-7;
  return values.minCoeff() > least_share * values.maxCoeff();
}

// A law whose values and times have other units: X is value times, t is time times as large.
struct Stretch {
  double value, time;
};

// True if parameters with these powers of 2 make up for the stretch, at every probe.
bool compensates(const LawValue& law, const std::vector<Probe>& probes, const Powers& powers,
                 const Stretch& stretch) {
  return std::ranges::all_of(probes, [&](const Probe& probe) {
    ParameterValues p = probe.p;
    for (std::size_t j = 0; j < p.size(); ++j) p[j] = std::ldexp(p[j], powers[j]);
    const double expected = stretch.value * law(probe.t, probe.p.data());
    const double found = law(stretch.time * probe.t, p.data());
    if (!std::isfinite(expected) || !std::isfinite(found)) return true;  // no information
    return std::abs(found - expected) <= rounding * (std::abs(found) + std::abs(expected));
  });
}

// Powers of the parameters that the law depends on in steps alone, without a slope: those that
// compensate a stretch, if there is one set only.
std::optional<Powers> with_steps(const LawValue& law, const std::vector<Probe>& probes,
                                 Powers powers, const std::vector<std::size_t>& steps,
                                 const Stretch& stretch) {
  constexpr int highest = 2, n_powers = 2 * highest + 1;
  constexpr std::size_t most_steps = 3;
  if (steps.empty()) return powers;
  if (steps.size() > most_steps) return std::nullopt;
  std::optional<Powers> found;
  const auto n = static_cast<int>(std::lround(std::pow(n_powers, steps.size())));
  for (int number = 0; number < n; ++number) {
    for (std::size_t k = 0, rest = static_cast<std::size_t>(number); k < steps.size(); ++k) {
      powers[steps[k]] = static_cast<int>(rest % n_powers) - highest;
      rest /= n_powers;
    }
    if (!compensates(law, probes, powers, stretch)) continue;
    if (found) return std::nullopt;
    found = powers;
  }
  return found;
}

// The powers with which the parameters carry a unit, where whole ones solve the equations, and only
// they do. `slopes`: [n, n_parameters]; parameters without any slope have the power 0.
std::optional<Powers> powers(const Eigen::MatrixXd& slopes, const Eigen::VectorXd& b,
                             const std::vector<std::size_t>& steps) {
  std::vector<Eigen::Index> smooth;
  for (Eigen::Index j = 0; j < slopes.cols(); ++j) {
    if (std::ranges::find(steps, static_cast<std::size_t>(j)) == steps.end()) smooth.push_back(j);
  }
  Eigen::MatrixXd a(slopes.rows(), static_cast<Eigen::Index>(smooth.size()));
  for (std::size_t k = 0; k < smooth.size(); ++k) {
    a.col(static_cast<Eigen::Index>(k)) = slopes.col(smooth[k]);
  }
  if (smooth.empty() || !has_full_rank(a)) return std::nullopt;
  const Eigen::VectorXd whole = least_squares(a, b).array().round().matrix();
  if (!((a * whole - b).cwiseAbs().maxCoeff() < 1e-6)) return std::nullopt;
  Powers found(static_cast<std::size_t>(slopes.cols()), 0);
  for (std::size_t k = 0; k < smooth.size(); ++k) {
    found[static_cast<std::size_t>(smooth[k])] =
        static_cast<int>(whole[static_cast<Eigen::Index>(k)]);
  }
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

bool find_traits(const LawValue& law, std::vector<Parameter>& parameters) {
  const std::vector<Probe> places = probes(parameters);
  const std::optional<Slopes> found = slopes(law, places);
  if (!found) return false;
  find_linear(law, places, parameters);
  std::vector<std::size_t> steps;
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    const auto column = found->by_parameter.col(static_cast<Eigen::Index>(j));
    if (column.cwiseAbs().maxCoeff() <= rounding) steps.push_back(j);
  }
  // f(t; u^v p) = u f and f(u t; u^w p) = f for every u: their derivatives by u at u = 1.
  auto of_value = powers(found->by_parameter, found->value, steps);
  auto of_time = powers(found->by_parameter, -found->by_t, steps);
  if (of_value) of_value = with_steps(law, places, *of_value, steps, {2, 1});
  if (of_time) of_time = with_steps(law, places, *of_time, steps, {1, 2});
  const Powers none(parameters.size(), 0);
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    parameters[j].unit = unit_of(of_value.value_or(none)[j], of_time.value_or(none)[j]);
  }
  return of_value && of_time;
}

}  // namespace jostle::inline study
