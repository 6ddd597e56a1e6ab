#include "ensemble/analysis/ageing/ageing_table.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "ensemble/analysis/ageing/collapse.hpp"
#include "ensemble/analysis/ageing/fits.hpp"

namespace jostle::inline ensemble {

namespace {

constexpr const char* eq_5 = "Philippe & Bideau 2001, eq. 5";
constexpr const char* eq_6 = "Philippe & Bideau 2001, eq. 6";

std::string squared(const std::string& units) {
  return units == "1" || units.empty() ? "1" : "(" + units + ")^2";
}

struct EstimateColumn {
  const char* name;
  double LogEstimate::*field;
  const char* meaning;
};
constexpr EstimateColumn estimate_columns[] = {
    {"_error", &LogEstimate::error,
     "standard error over realizations of ln of the value, times the value"},
    {"_low_68", &LogEstimate::low_68,
     "lower end of the 68 % interval, Student's t of ln of the value"},
    {"_high_68", &LogEstimate::high_68, "its upper end"},
    {"_low_95", &LogEstimate::low_95,
     "lower end of the 95 % interval, Student's t of ln of the value"},
    {"_high_95", &LogEstimate::high_95, "its upper end"}};

std::vector<double> numbers(const std::vector<LogEstimate>& estimates, double LogEstimate::*field) {
  std::vector<double> values;
  for (const LogEstimate& estimate : estimates) values.push_back(estimate.*field);
  return values;
}

void add_curves(const AgeingCurves& curves, const std::string& of_change, Table& table) {
  const std::string units = squared(of_change);
  const std::vector<std::string> axes = {"waiting_time", "lag"};
  const auto add = [&](const std::string& name, const auto& values, const std::string& unit,
                       const char* meaning, const char* source) {
    table.quantities.push_back({name, axes, values, unit, meaning, source});
  };
  add("a", numbers(curves.a, &LogEstimate::value), units, "mean squared change over the lag", eq_5);
  for (const auto& [name, field, meaning] : estimate_columns) {
    add(std::string("a").append(name), numbers(curves.a, field), units, meaning, "");
  }
  add("v", numbers(curves.v, &LogEstimate::value), units,
      "variance over realizations of the change over the lag", "");
  for (const auto& [name, field, meaning] : estimate_columns) {
    add(std::string("v").append(name), numbers(curves.v, field), units, meaning, "");
  }
  add("change", curves.change, of_change, "mean change over the lag", "");
  add("change_error", curves.change_error, of_change, "standard error over realizations", "");
  std::vector<double> dof;
  for (const auto count : curves.count)
    dof.push_back(std::max(0.0, static_cast<double>(count) - 1));
  add("change_dof", dof, "1", "degrees of freedom of change_error", "");
  add("c", curves.c, "1",
      "covariance with the value at t_W over the variance at t_W: 1 at lag 0, not bounded by 1",
      "Nicodemi & Coniglio 1999, doi:10.1103/PhysRevLett.82.916");
  add("c_error", curves.c_error, "1", "jackknife error of c", "");
  add("c_dof", dof, "1", "degrees of freedom of c_error", "");
  add("count", curves.count, "1", "realizations that reached both taps", "");
}

// A parameter without a limit on a side has diverged, and has no value; scales at a held B have no
// errors of their own.
LogEstimate storable(const AgeingLaw& law, LogEstimate AgeingLaw::*parameter, bool is_joint) {
  const LogEstimate& estimate = law.*parameter;
  if (!is_limited(estimate) || (is_joint && !law.is_determined())) return no_estimate();
  if (!law.b_is_held) return estimate;
  LogEstimate scale = no_estimate();
  scale.value = estimate.value;
  return scale;
}

/// `is_joint`: parameters mean something only where all have limits.
void add_laws(const std::vector<AgeingLaw>& laws, const std::string& prefix,
              const std::string& suffix, const std::string& units, bool is_joint, Table& table) {
  const std::vector<std::string> axes = {"waiting_time"};
  const auto add = [&](const char* name, LogEstimate AgeingLaw::*parameter, const std::string& unit,
                       const std::string& meaning) {
    std::vector<LogEstimate> estimates;
    for (const AgeingLaw& law : laws) estimates.push_back(storable(law, parameter, is_joint));
    table.quantities.push_back({prefix + name, axes, numbers(estimates, &LogEstimate::value), unit,
                                meaning + suffix, eq_6});
    for (const auto& [ending, field, of_field] : estimate_columns) {
      table.quantities.push_back(
          {prefix + name + ending, axes, numbers(estimates, field), unit, of_field, ""});
    }
  };
  add("a_inf", &AgeingLaw::a_inf, units, "a at infinite lag");
  add("b", &AgeingLaw::b, "1", "strength of the logarithm");
  add("tau", &AgeingLaw::tau, "taps", "lag before the logarithm sets in");
  std::vector<double> misfits;
  std::vector<std::string> verdicts;
  for (const AgeingLaw& law : laws) {
    misfits.push_back(law.misfit);
    verdicts.push_back(law.verdict);
  }
  table.quantities.push_back({prefix + "misfit", axes, std::move(misfits), "1",
                              "root mean square of a / law - 1" + suffix, eq_6});
  table.quantities.push_back({prefix + "verdict", axes, std::move(verdicts), "1",
                              "how well the curve limits the parameters" + suffix, ""});
}

void add_scaled(const AgeingCurves& curves, const AgeingFits& fits, Table& table) {
  std::vector<double> x, y, error;
  for (std::size_t k = 0; k < fits.shared.size(); ++k) {
    const AgeingLaw& law = fits.shared[k];
    const double tau = law.is_determined() ? law.tau.value : no_estimate().value;
    for (std::size_t j = 0; j < curves.grid.lags.size(); ++j) {
      const std::size_t i = curves.index_of(k, j);
      x.push_back(static_cast<double>(curves.grid.lags[j]) / tau);
      y.push_back(law.is_determined() ? curves.a[i].value / law.a_inf.value : tau);
      error.push_back(y.back() * fits.scaled_error[i]);
    }
  }
  const std::vector<std::string> axes = {"waiting_time", "lag"};
  table.quantities.push_back({"scaled_lag", axes, std::move(x), "1", "lag / shared_tau", ""});
  table.quantities.push_back({"scaled_a", axes, std::move(y), "1", "a / shared_a_inf", ""});
  table.quantities.push_back({"scaled_a_error", axes, std::move(error), "1",
                              "standard error of scaled_a at equal scaled_lag, those of a, "
                              "shared_a_inf and shared_tau together",
                              ""});
  table.quantities.push_back(
      {"scaled_a_dof",
       {},
       std::vector{std::max(0.0, static_cast<double>(fits.realizations) - 1)},
       "1",
       "degrees of freedom of scaled_a_error",
       ""});
}

ScaledCurve scaled_curve(const AgeingCurves& curves, std::size_t k, double tau, double a_inf) {
  ScaledCurve scaled;
  for (std::size_t j = 0; j < curves.grid.lags.size(); ++j) {
    const double a = curves.a[curves.index_of(k, j)].value;
    if (!std::isfinite(a)) continue;
    scaled.x.push_back(static_cast<double>(curves.grid.lags[j]) / tau);
    scaled.y.push_back(a / a_inf);
  }
  return scaled;
}

void add_distances(const AgeingCurves& curves, const AgeingFits& fits, Table& table) {
  std::vector<ScaledCurve> scaled, unscaled, all;
  for (std::size_t k = 0; k < fits.shared.size(); ++k) {
    all.push_back(scaled_curve(curves, k, 1, 1));
    const AgeingLaw& law = fits.shared[k];
    if (!law.is_determined()) continue;
    scaled.push_back(scaled_curve(curves, k, law.tau.value, law.a_inf.value));
    unscaled.push_back(all.back());
  }
  const auto add = [&](const char* name, const Collapse& found, const std::string& suffix) {
    table.quantities.push_back(
        {name,
         {},
         std::vector{found.relative},
         "1",
         "root mean square difference between waiting times over that of the values, " + suffix,
         ""});
  };
  add("collapse_relative", collapse(scaled), "of scaled_a at equal scaled_lag");
  add("unscaled_collapse_relative", collapse(scaled.size() > 1 ? unscaled : all),
      "of a at equal lag, of the waiting times that have scales (of all where fewer than two "
      "have)");
}

void add_trend(const AgeTrend& trend, const std::string& prefix, const std::string& symbol,
               Table& table) {
  const auto add = [&](const std::string& name, double value, const std::string& meaning) {
    table.quantities.push_back({prefix + name, {}, std::vector{value}, "1", meaning, ""});
  };
  add("_factor", trend.factor.value,
      "factor by which " + symbol + " changes from the first waiting time to the last");
  for (const auto& [ending, field, meaning] : estimate_columns) {
    add(std::string("_factor").append(ending), trend.factor.*field, meaning);
  }
  add("_p", trend.p, "p-value of no change of " + symbol + ", Student's t over realizations");
  add("_detectable", trend.detectable, "factor that would be found at 5 % with power 0.8");
  table.notes.emplace_back(prefix + "_verdict", trend.verdict);
}

// An end that the data do not give is no number.
double or_nan(double end) {
  return std::isinf(end) ? no_estimate().value : end;
}

void add_scaling(const TimeScaling& scaling, const std::string& prefix, const std::string& symbol,
                 Table& table) {
  const AgeingExponent& power = scaling.power;
  const auto add = [&](const std::string& name, double value, const std::string& meaning,
                       const char* source) {
    table.quantities.push_back({prefix + name, {}, std::vector{value}, "1", meaning, source});
  };
  add("mu", power.mu, "exponent of age: " + symbol + " as a function of t / t_W^mu",
      "Bouchaud et al. 1998, arXiv:cond-mat/9702070");
  add("mu_error", power.error, "standard error over realizations", "");
  add("mu_low_68", or_nan(power.low_68), "lower end of the 68 % interval, Student's t", "");
  add("mu_high_68", or_nan(power.high_68), "its upper end", "");
  add("mu_low_95", or_nan(power.low_95), "lower end of the 95 % interval, Student's t", "");
  add("mu_high_95", or_nan(power.high_95), "its upper end", "");
  table.notes.emplace_back(prefix + "mu_verdict", power.verdict);
  for (const auto& [name, variable, collapse] :
       {std::tuple{"power_collapse", "t / t_W^mu", &power.collapse},
        std::tuple{"logarithmic_collapse", "ln(t_W + t) / ln t_W", &scaling.logarithmic}}) {
    add(std::string(name) + "_p", collapse->p,
        "p-value of " + symbol + " as one function of " + variable +
            ", Student's t over realizations",
        "");
    add(std::string(name) + "_detectable", collapse->detectable,
        "factor between the ages that would be found at 5 % with power 0.8", "");
  }
  table.notes.emplace_back(prefix + "logarithmic_collapse_verdict", scaling.logarithmic.verdict);
}

}  // namespace

Table ageing_table(std::string name, const Column& observable, const TapRows& rows,
                   const AgeingGrid& grid, int threads) {
  const AgeingCurves curves = ageing_curves(rows, grid);
  const AgeingFits fits = fit_ageing(rows, grid, threads);
  const std::string units = squared(observable.units);
  Table table{.name = std::move(name)};
  table.axes = {{"waiting_time", {"waiting_time"}, grid.waiting_times, "taps", "age t_W", ""},
                {"lag", {"lag"}, grid.lags, "taps", "lag t", ""}};
  add_curves(curves, observable.units, table);
  table.notes = {{"observable", observable.name}, {"law", "A_inf (1 - 1 / (1 + B ln(1 + t/tau)))"}};
  add_laws(fits.own, "", "", units, false, table);
  add_laws(fits.shared, "shared_", ", b common to all waiting times", units, true, table);
  add_scaled(curves, fits, table);
  add_distances(curves, fits, table);
  add_trend(fits.ageing, "ageing", "A", table);
  add_trend(fits.fluctuations, "fluctuation", "V", table);
  add_trend(fits.collapse, "collapse", "b", table);
  add_scaling(fits.a_scaling, "", "A", table);
  add_scaling(fits.v_scaling, "v_", "V", table);
  table.quantities.push_back({"realizations_fitted",
                              {},
                              std::vector{fits.realizations},
                              "1",
                              "realizations that reached every tap of the fits",
                              ""});
  return table;
}

}  // namespace jostle::inline ensemble
