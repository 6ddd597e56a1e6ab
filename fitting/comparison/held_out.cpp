#include "fitting/comparison/held_out.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "fitting/binned_curve.hpp"
#include "fitting/intervals/distributions.hpp"

namespace jostle::inline fitting {

namespace {

// Fitted curves whose distance is below this share of the residuals are one curve.
constexpr double same_curve = 1e-8;
constexpr double rounding = 1e-20;  // rounding of squares, relative to the squares of X

// Realizations with the weights that all fits share: squares are in units of the variance of one
// realization.
struct Ensemble {
  Curve curve;                 // mean, with errors
  Eigen::ArrayXd root_weight;  // [n_points]
  Eigen::ArrayXd mean;         // [n_points], weighted
  Eigen::ArrayXXd deviations;  // [n_points, n_realizations], of realizations from it, weighted

  Eigen::Index n_points() const { return deviations.rows(); }
  Eigen::Index n_realizations() const { return deviations.cols(); }
};

// A long curve as the means that its fits are searched on.
Curve shortened(const Curve& curve) {
  Curve bins = binned({.t = curve.t, .x = curve.x, .sigma = curve.sigma});
  if (bins.t.size() == curve.t.size()) return curve;
  bins.n_realizations = curve.n_realizations;
  bins.values.resize(bins.t.size() * curve.n_realizations);
  for (std::size_t m = 0; m < curve.n_realizations; ++m) {
    Curve column{.t = curve.t, .x = {}, .sigma = curve.sigma};
    for (std::size_t i = 0; i < curve.t.size(); ++i) {
      column.x.push_back(curve.values[i * curve.n_realizations + m]);
    }
    const Curve means = binned(column);
    for (std::size_t i = 0; i < means.x.size(); ++i) {
      bins.values[i * curve.n_realizations + m] = means.x[i];
    }
  }
  return bins;
}

Ensemble ensemble_of(const Curve& whole) {
  Ensemble ensemble;
  ensemble.curve = shortened(whole);
  const Curve& curve = ensemble.curve;
  const auto n = static_cast<Eigen::Index>(curve.t.size());
  const auto m = static_cast<Eigen::Index>(curve.n_realizations);
  using Rows = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Map<const Rows> values(curve.values.data(), n, m);
  const Eigen::Map<const Eigen::ArrayXd> mean(curve.x.data(), n), sigma(curve.sigma.data(), n);
  ensemble.root_weight = 1 / (sigma * std::sqrt(static_cast<double>(m)));
  ensemble.mean = mean * ensemble.root_weight;
  ensemble.deviations = (values.colwise() - mean).colwise() * ensemble.root_weight;
  return ensemble;
}

// The mean of all realizations but one, with the weights of the whole curve. Made from the mean of
// all, it keeps the digits of small fluctuations.
Curve curve_without(const Ensemble& ensemble, Eigen::Index left_out) {
  Curve rest{.t = ensemble.curve.t, .x = ensemble.curve.x, .sigma = ensemble.curve.sigma};
  const auto n_others = static_cast<double>(ensemble.n_realizations() - 1);
  for (std::size_t i = 0; i < rest.x.size(); ++i) {
    const auto point = static_cast<Eigen::Index>(i);
    rest.x[i] -= ensemble.deviations(point, left_out) / ensemble.root_weight[point] / n_others;
  }
  return rest;
}

Eigen::ArrayXd weighted_curve(const Ensemble& ensemble, const Model& model,
                              const ParameterValues& values) {
  Eigen::ArrayXd law(ensemble.n_points());
  for (Eigen::Index i = 0; i < law.size(); ++i) {
    law[i] = model.value(ensemble.curve.t[static_cast<std::size_t>(i)], values.data());
  }
  return law * ensemble.root_weight;
}

// The predictions of a law for the ensemble, all curves weighted.
struct Predictions {
  std::string model;
  Eigen::ArrayXd fitted;     // [n_points], to the mean of all realizations
  Eigen::ArrayXXd held_out;  // [n_points, n_realizations], to the mean of the others
  double residual_sum = 0;   // sum of squares of the mean of all realizations
  double dof = 0;            // dof of errors from the scatter of realizations
  double squared_error = 0;  // sum over points
};

// The law that was fitted: at a limit of a law, that of the limit.
struct FittedModel {
  explicit FittedModel(const FittedLaw& law)
      : model(law.fit->limit ? *law.fit->limit->law : *law.model),
        estimates(law.fit->limit ? law.fit->limit->estimates : law.fit->estimates) {
    for (const Estimate& estimate : estimates) values.push_back(estimate.value);
  }

  const Model& model;
  const std::vector<Estimate>& estimates;
  ParameterValues values;
};

FitOptions refit_options(const FittedModel& law) {
  FitOptions options;
  options.start = law.values;
  options.multi_start = false;
  options.profiles = false;
  options.memory = false;
  // A curve is known long before parameters that trade against each other or run to infinity.
  options.solver.cost_tolerance = 1e-12;
  options.solver.max_iterations = 100;
  options.solver.fallbacks = false;
  options.solver.polish = false;
  for (const Estimate& estimate : law.estimates) {
    if (estimate.identifiability == Identifiability::fixed) {
      options.fixed[estimate.parameter.name] = estimate.value;
    }
  }
  return options;
}

// Where a law cannot be fitted without a realization, `fault` reports it.
Predictions predictions(const Ensemble& ensemble, const FittedLaw& law, std::string& fault) {
  Predictions found;
  found.model = law.model->name();
  found.dof = std::min(law.fit->error_dof, static_cast<double>(ensemble.n_realizations() - 1));
  const FittedModel fitted(law);
  found.fitted = weighted_curve(ensemble, fitted.model, fitted.values);
  found.held_out.resize(ensemble.n_points(), ensemble.n_realizations());
  FitOptions options = refit_options(fitted);
  for (Eigen::Index m = 0; m < ensemble.n_realizations(); ++m) {
    const Curve training = curve_without(ensemble, m);
    options.multi_start = false;
    auto result = fit(fitted.model, training, options);
    if (std::holds_alternative<Refusal>(result)) {
      options.multi_start = true;
      result = fit(fitted.model, training, options);
    }
    if (const auto* refusal = std::get_if<Refusal>(&result)) {
      std::ostringstream text;
      text << found.model << " was not compared: without realization " << m + 1
           << " it cannot be fitted (" << refusal->message << ")";
      fault = text.str();
      return found;
    }
    found.held_out.col(m) = weighted_curve(ensemble, fitted.model, std::get<Fit>(result).values());
  }
  found.residual_sum = (ensemble.mean - found.fitted).square().sum();
  return found;
}

// Mean squared error of prediction less the variance of the law's fit, summed over points.
double squared_error(const Ensemble& ensemble, const Predictions& law) {
  const Eigen::ArrayXd centre = law.held_out.rowwise().mean();
  double error = 0, variance = 0;
  for (Eigen::Index m = 0; m < ensemble.n_realizations(); ++m) {
    error += (ensemble.mean + ensemble.deviations.col(m) - law.held_out.col(m)).square().sum();
    variance += (law.held_out.col(m) - centre).square().sum();
  }
  return error / static_cast<double>(ensemble.n_realizations()) - variance;
}

// The variance of the difference of squared errors of two laws, to second order in the deviations.
double variance_of_difference(const Ensemble& ensemble, const Predictions& law,
                              const Predictions& second) {
  const auto m = static_cast<double>(ensemble.n_realizations());
  const Eigen::ArrayXd difference = law.fitted - second.fitted;
  const Eigen::VectorXd first = 2 * ensemble.deviations.matrix().transpose() * difference.matrix();
  const Eigen::ArrayXXd change = law.held_out - second.held_out;
  const Eigen::MatrixXd moved =
      ((m - 1) * (change.colwise() - change.rowwise().mean().eval())).matrix();
  const double kernel =
      (ensemble.deviations.matrix().transpose() * moved).squaredNorm() / ((m - 1) * (m - 1));
  return (first.squaredNorm() / (m - 1) + 2 * kernel / (m - 1)) / m;
}

bool coincide(const Ensemble& ensemble, const Predictions& law, const Predictions& second) {
  const double noise = std::min(law.residual_sum, second.residual_sum);
  const double digits = rounding * ensemble.mean.square().sum();
  return (law.fitted - second.fitted).square().sum() <= std::max(same_curve * noise, digits);
}

HeldOutLaw compared(const Ensemble& ensemble, const Predictions& law, const Predictions& best,
                    double n_others) {
  const auto n = static_cast<double>(ensemble.n_points());
  HeldOutLaw found{.model = law.model, .squared_error = law.squared_error / n};
  if (&law == &best) return found;
  if (coincide(ensemble, law, best)) {
    found.squared_error = best.squared_error / n;
    found.same_curve = true;
    return found;
  }
  found.difference = found.squared_error - best.squared_error / n;
  found.error = std::sqrt(variance_of_difference(ensemble, law, best)) / n;
  found.dof = std::min(law.dof, best.dof);
  if (found.error > 0) {
    found.t = found.difference / found.error;
  } else if (found.difference > 0) {
    found.t = std::numeric_limits<double>::infinity();
  }
  found.p = std::min(1.0, n_others * 0.5 * student_tails(found.t, found.dof));
  found.worse = found.p < LawComparison::level;
  return found;
}

// Those of X, of laws that draw this curves the first.
std::vector<FittedLaw> competing_laws(const std::vector<FittedLaw>& laws,
                                      std::vector<std::string>& left_out) {
  std::vector<FittedLaw> competing;
  for (const FittedLaw& law : laws) {
    const bool known = std::ranges::any_of(competing, [&](const FittedLaw& earlier) {
      return earlier.fit->restated && earlier.fit->restated->model == law.model->name();
    });
    if (known) continue;
    if (law.fit->logarithmic && laws.size() > 1) {
      left_out.push_back(law.model->name() + " was not compared: it is fitted to ln X, not to X");
    } else if (!law.fit->logarithmic) {
      competing.push_back(law);
    }
  }
  return competing;
}

}  // namespace

bool LawComparison::is_decided() const {
  return laws.size() > 1 && std::ranges::count(laws, true, &HeldOutLaw::worse) + 1 ==
                                static_cast<std::ptrdiff_t>(laws.size());
}

LawComparison compare_laws(const std::vector<FittedLaw>& laws, const Curve& curve) {
  LawComparison comparison;
  comparison.n_realizations = std::max<std::size_t>(curve.n_realizations, 1);
  const std::vector<FittedLaw> competing = competing_laws(laws, comparison.left_out);
  if (competing.size() < 2) return comparison;
  if (comparison.n_realizations < LawComparison::least_realizations) {
    std::ostringstream text;
    text << "the choice of a law requires " << LawComparison::least_realizations
         << " independent realizations or more, the curve has " << comparison.n_realizations;
    comparison.cannot_decide = text.str();
    return comparison;
  }
  const Curve weighted = with_pooled_errors(curve);
  if (weighted.sigma.empty()) {
    comparison.cannot_decide = "the realizations do not scatter: they are copies of one curve";
    return comparison;
  }
  const Ensemble ensemble = ensemble_of(weighted);
  std::vector<Predictions> found;
  for (const FittedLaw& law : competing) {
    std::string fault;
    Predictions made = predictions(ensemble, law, fault);
    if (!fault.empty()) {
      comparison.left_out.push_back(fault);
      continue;
    }
    made.squared_error = squared_error(ensemble, made);
    found.push_back(std::move(made));
  }
  if (found.size() < 2) {
    comparison.cannot_decide = "fewer than two laws can be fitted without each realization";
    return comparison;
  }
  const auto best = std::ranges::min_element(found, {}, &Predictions::squared_error);
  comparison.leading = static_cast<std::size_t>(best - found.begin());
  for (const Predictions& law : found) {
    comparison.laws.push_back(
        compared(ensemble, law, *best, static_cast<double>(found.size() - 1)));
  }
  return comparison;
}

}  // namespace jostle::inline fitting
