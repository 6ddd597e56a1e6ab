#include "ensemble/ageing_table.hpp"

#include "ensemble/ageing_fits.hpp"
#include "ensemble/collapse.hpp"

namespace jostle {

namespace {

constexpr const char* eq_5 = "Philippe & Bideau 2001, eq. 5";
constexpr const char* eq_6 = "Philippe & Bideau 2001, eq. 6";

std::string squared(const std::string& units) {
  return units == "1" || units.empty() ? "1" : "(" + units + ")^2";
}

void add_curves(const AgeingCurves& curves, const std::string& units, Table& table) {
  const std::vector<std::string> axes = {"waiting_time", "lag"};
  const auto add = [&](const char* name, const auto& values, const std::string& unit,
                       const char* meaning, const char* source) {
    table.quantities.push_back({name, axes, values, unit, meaning, source});
  };
  add("a", curves.a, units, "mean squared change over the lag", eq_5);
  add("a_error", curves.a_error, units, "jackknife error of a", "");
  add("a_half_width_68", curves.a_half_width, units, "half the 68 % interval of a, Student's t",
      "");
  add("c", curves.c, "1", "two-time autocorrelation over realizations, 1 at lag 0",
      "Nicodemi & Coniglio 1999, doi:10.1103/PhysRevLett.82.916");
  add("c_error", curves.c_error, "1", "jackknife error of c", "");
  add("count", curves.count, "1", "realizations that reached both taps", "");
}

void add_laws(const std::vector<AgeingLaw>& laws, const std::string& prefix,
              const std::string& which, const std::string& units, Table& table) {
  const auto add = [&](const char* name, double AgeingLaw::*field, const std::string& unit,
                       const std::string& meaning) {
    std::vector<double> values;
    for (const AgeingLaw& law : laws) values.push_back(law.*field);
    table.quantities.push_back(
        {prefix + name, {"waiting_time"}, std::move(values), unit, meaning + which, eq_6});
  };
  add("a_inf", &AgeingLaw::a_inf, units, "a at infinite lag");
  add("a_inf_error", &AgeingLaw::a_inf_error, units, "jackknife error of a_inf");
  add("b", &AgeingLaw::b, "1", "strength of the logarithm");
  add("b_error", &AgeingLaw::b_error, "1", "jackknife error of b");
  add("tau", &AgeingLaw::tau, "taps", "lag before the logarithm sets in");
  add("tau_error", &AgeingLaw::tau_error, "taps", "jackknife error of tau");
  add("reduced_chi2", &AgeingLaw::reduced_chi2, "1",
      "chi2 per degree of freedom, lags taken for independent");
  add("misfit", &AgeingLaw::misfit, "1", "root mean square of a / law - 1");
  std::vector<std::string> verdicts;
  for (const AgeingLaw& law : laws) verdicts.push_back(law.verdict);
  table.quantities.push_back({prefix + "verdict",
                              {"waiting_time"},
                              std::move(verdicts),
                              "1",
                              "what the curve says of the parameters" + which,
                              ""});
}

ScaledCurve scaled_curve(const AgeingCurves& curves, std::size_t k, double tau, double a_inf) {
  ScaledCurve scaled;
  for (std::size_t j = 0; j < curves.grid.lags.size(); ++j) {
    const std::size_t i = curves.at(k, j);
    if (!(curves.a_error[i] > 0) || !(tau > 0) || !(a_inf > 0)) continue;
    scaled.x.push_back(static_cast<double>(curves.grid.lags[j]) / tau);
    scaled.y.push_back(curves.a[i] / a_inf);
    scaled.error.push_back(curves.a_error[i] / a_inf);
  }
  return scaled;
}

void add_scaled(const AgeingCurves& curves, const std::vector<AgeingLaw>& laws, Table& table) {
  std::vector<double> x, y, error;
  for (std::size_t k = 0; k < laws.size(); ++k) {
    for (std::size_t j = 0; j < curves.grid.lags.size(); ++j) {
      const std::size_t i = curves.at(k, j);
      x.push_back(static_cast<double>(curves.grid.lags[j]) / laws[k].tau);
      y.push_back(curves.a[i] / laws[k].a_inf);
      error.push_back(curves.a_error[i] / laws[k].a_inf);
    }
  }
  const std::vector<std::string> axes = {"waiting_time", "lag"};
  table.quantities.push_back({"scaled_lag", axes, std::move(x), "1", "lag / shared_tau", ""});
  table.quantities.push_back({"scaled_a", axes, std::move(y), "1", "a / shared_a_inf", ""});
  table.quantities.push_back(
      {"scaled_a_error", axes, std::move(error), "1", "a_error / shared_a_inf", ""});
}

void add_collapse(const std::vector<ScaledCurve>& curves, const std::string& prefix,
                  const std::string& which, Table& table) {
  const Collapse found = collapse(curves);
  const auto add = [&](const char* name, const auto& value, const std::string& meaning) {
    table.quantities.push_back({prefix + name, {}, std::vector{value}, "1", meaning + which, ""});
  };
  add("collapse", found.over_error,
      "root mean square difference between waiting times over its error");
  add("collapse_relative", found.relative,
      "root mean square difference between waiting times over that of the values");
  add("collapse_comparisons", std::uint64_t{found.comparisons}, "pairs compared");
}

}  // namespace

Table ageing_table(std::string name, const ObservableLabel& observable, const TapRows& rows,
                   const AgeingGrid& grid, int threads) {
  const AgeingCurves curves = ageing_curves(rows, grid);
  const AgeingFits fits = fit_ageing(rows, grid, threads);
  const std::string units = squared(observable.units);
  Table table{.name = std::move(name)};
  table.axes = {{"waiting_time", {"waiting_time"}, grid.waiting_times, "taps", "age t_W", ""},
                {"lag", {"lag"}, grid.lags, "taps", "lag t", ""}};
  add_curves(curves, units, table);
  add_laws(fits.own, "", "", units, table);
  add_laws(fits.shared, "shared_", ", b common to all waiting times", units, table);
  add_scaled(curves, fits.shared, table);
  std::vector<ScaledCurve> scaled, unscaled;
  for (std::size_t k = 0; k < grid.waiting_times.size(); ++k) {
    scaled.push_back(scaled_curve(curves, k, fits.shared[k].tau, fits.shared[k].a_inf));
    unscaled.push_back(scaled_curve(curves, k, 1, 1));
  }
  add_collapse(scaled, "", ", of scaled_a at equal scaled_lag", table);
  add_collapse(unscaled, "unscaled_", ", of a at equal lag: about 1 without ageing", table);
  table.quantities.push_back({"realizations_fitted",
                              {},
                              std::vector{fits.realizations},
                              "1",
                              "realizations that reached every tap of the fits",
                              ""});
  table.notes = {{"observable", observable.name}, {"law", "A_inf (1 - 1 / (1 + B ln(1 + t/tau)))"}};
  return table;
}

}  // namespace jostle
