#include "ensemble/ageing_fits.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "ensemble/moments.hpp"
#include "ensemble/resampled_fit.hpp"
#include "ensemble/shared_ageing.hpp"

namespace jostle {

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr int reweightings = 3;
// 1 / epsilon: the least squares lie where the law no longer changes with its parameters.
constexpr double singular_condition = 4.5e15;

const AgeingLaw no_law = {not_a_number, not_a_number, not_a_number, not_a_number, not_a_number,
                          not_a_number, not_a_number, not_a_number, "not fitted"};

std::vector<std::uint32_t> complete_realizations(const TapRows& rows) {
  std::vector<std::uint32_t> complete;
  for (std::uint32_t r = 0; r < rows.realizations; ++r) {
    bool finite = true;
    for (std::size_t i = r; i < rows.values.size(); i += rows.realizations) {
      finite = finite && std::isfinite(rows.values[i]);
    }
    if (finite) complete.push_back(r);
  }
  return complete;
}

// Squared changes over lags that the series has and over which anything changes.
RealizationCurves squared_changes(const TapRows& rows, std::span<const std::uint32_t> realizations,
                                  std::uint64_t wait, std::span<const std::uint64_t> lags) {
  RealizationCurves curves;
  curves.realizations = static_cast<std::uint32_t>(realizations.size());
  const std::span<const double> early = rows.row(wait);
  for (const std::uint64_t lag : lags) {
    const std::span<const double> late = rows.row(wait + lag);
    if (early.empty() || late.empty()) continue;
    std::vector<double> squares;
    for (const std::uint32_t r : realizations) {
      squares.push_back((late[r] - early[r]) * (late[r] - early[r]));
    }
    if (std::ranges::all_of(squares, [](double x) { return x == 0; })) continue;
    curves.t.push_back(static_cast<double>(lag));
    curves.values.insert(curves.values.end(), squares.begin(), squares.end());
  }
  return curves;
}

// Root mean square over lags of the relative error of the mean.
double relative_error(const RealizationCurves& curves) {
  double sum = 0;
  for (std::size_t i = 0; i < curves.t.size(); ++i) {
    Moments moments;
    for (std::uint32_t r = 0; r < curves.realizations; ++r) {
      moments.add(curves.values[i * curves.realizations + r]);
    }
    const double relative = moments.standard_error() / moments.mean();
    sum += relative * relative;
  }
  return std::sqrt(sum / static_cast<double>(curves.t.size()));
}

std::vector<double> scaled(std::vector<double> values, double factor) {
  for (double& value : values) value *= factor;
  return values;
}

struct WeightedFit {
  Fit fit;
  RealizationCurves curves;  // with the weights of the fit
};

// Whether a fit that has run to infinity is profiled: with many curves that takes minutes.
enum class Runaways { profiled, left };

std::variant<WeightedFit, Refusal> reweighted_fit(const Model& model, RealizationCurves curves,
                                                  Runaways runaways,
                                                  const std::map<std::string, double>& fixed = {}) {
  const double relative = relative_error(curves);
  curves.sigma = scaled(mean_curve(curves).x, relative);
  std::optional<Fit> last;
  for (int i = 0; i <= reweightings; ++i) {
    const bool limited = !last || last->condition < singular_condition;
    FitOptions options{.profiles = i == reweightings && (limited || runaways == Runaways::profiled),
                       .memory = false};
    options.fixed = fixed;
    if (last) options.start = last->values();
    options.multi_start = !last;
    auto fitted = fit(model, mean_curve(curves), options);
    if (auto* refusal = std::get_if<Refusal>(&fitted)) {
      if (!last) return *refusal;
      break;  // run so far that the law has no slope
    }
    last = std::move(std::get<Fit>(fitted));
    const std::vector<double> sigma = scaled(last->fitted, relative);
    const bool positive = std::ranges::all_of(sigma, [](double s) { return s > 0; });
    if (positive && i < reweightings) curves.sigma = sigma;
  }
  return WeightedFit{std::move(*last), std::move(curves)};
}

double misfit(std::span<const double> x, std::span<const double> fitted) {
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double relative = x[i] / fitted[i] - 1;
    sum += relative * relative;
  }
  return std::sqrt(sum / static_cast<double>(x.size()));
}

// Whether a parameter is limited on both sides, by the data or by being held.
bool is_limited(const Estimate& estimate) {
  return estimate.identifiability == Identifiability::identified ||
         estimate.identifiability == Identifiability::wide ||
         estimate.identifiability == Identifiability::fixed;
}

void append(std::string& text, const std::string& sentence) {
  text += (text.empty() ? "" : ", ") + sentence;
}

// What a fit says of the parameters in `indices`, [a_inf, b, tau], and of its refits.
std::string verdict(const Fit& fit, const ResampledErrors& errors,
                    const std::array<std::size_t, 3>& indices) {
  std::string text;
  if (!is_minimum(fit.reason)) text = std::string("did not settle: ") + describe(fit.reason);
  const bool examined = std::ranges::all_of(indices, [&](std::size_t j) {
    return fit.estimates[j].identifiability != Identifiability::not_examined;
  });
  if (!examined && !(fit.condition < singular_condition)) {
    append(text,
           "A_inf, B and tau are not identifiable together: the least squares lie at infinity");
    return text;
  }
  for (const std::size_t j : indices) {
    const Estimate& estimate = fit.estimates[j];
    if (estimate.identifiability == Identifiability::identified ||
        estimate.identifiability == Identifiability::fixed) {
      continue;
    }
    append(text, estimate.statement);
  }
  if (errors.failed > 0) {
    append(text, std::to_string(errors.failed) + " of " + std::to_string(errors.resamples) +
                     " refits without a realization did not settle: no errors");
  }
  return text.empty() ? "identified" : text;
}

// A refit that fails, or a parameter that runs away with every refit, has no error.
double error_of(std::size_t j, const Fit& fit, const ResampledErrors& errors) {
  return errors.failed == 0 && is_limited(fit.estimates[j]) ? errors.errors[j] : not_a_number;
}

AgeingLaw law_of(const Fit& fit, const ResampledErrors& errors,
                 const std::array<std::size_t, 3>& indices) {
  const auto& [a_inf, b, tau] = indices;
  return {.a_inf = fit.estimates[a_inf].value,
          .a_inf_error = error_of(a_inf, fit, errors),
          .b = fit.estimates[b].value,
          .b_error = error_of(b, fit, errors),
          .tau = fit.estimates[tau].value,
          .tau_error = error_of(tau, fit, errors),
          .reduced_chi2 = fit.reduced_chi2,
          .misfit = not_a_number,
          .verdict = verdict(fit, errors, indices)};
}

AgeingLaw own_law(const RealizationCurves& curves, int threads) {
  const Ageing model;
  const auto found = reweighted_fit(model, curves, Runaways::profiled);
  if (const auto* refusal = std::get_if<Refusal>(&found)) {
    AgeingLaw law = no_law;
    law.verdict = refusal->message;
    return law;
  }
  const auto& [fit, weighted] = std::get<WeightedFit>(found);
  const ResampledErrors errors = resample(model, weighted, fit, {.threads = threads});
  AgeingLaw law = law_of(fit, errors, {0, 1, 2});
  law.misfit = misfit(mean_curve(weighted).x, fit.fitted);
  return law;
}

// All curves with at least as many points as a law has parameters, one after another.
struct JoinedCurves {
  std::vector<std::size_t> waiting_times;  // [n_curves], indices
  std::vector<SharedAgeing::Point> points;
  RealizationCurves curves;
};

JoinedCurves join(const std::vector<RealizationCurves>& all) {
  JoinedCurves joined;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (all[k].t.size() < Ageing().parameters().size()) continue;
    for (const double lag : all[k].t) {
      joined.curves.t.push_back(static_cast<double>(joined.points.size()));
      joined.points.push_back({joined.waiting_times.size(), lag});
    }
    joined.curves.values.insert(joined.curves.values.end(), all[k].values.begin(),
                                all[k].values.end());
    joined.curves.realizations = all[k].realizations;
    joined.waiting_times.push_back(k);
  }
  return joined;
}

// A statement in which parameters have the number of their curve, without it.
std::string without_number(std::string text, const std::string& name, std::size_t number) {
  const std::string numbered = name + "_" + std::to_string(number);
  for (std::size_t at = text.find(numbered); at != std::string::npos; at = text.find(numbered)) {
    text.replace(at, numbered.size(), name);
  }
  return text;
}

// Where B has no limit from below, eq. 6 is as good as the logarithm that it becomes at B = 0,
// A_inf B ln(1 + t/tau): with B held there the curves have scales, and only ratios of A_inf between
// waiting times mean something.
constexpr double logarithmic_b = 1e-3;  // 0.1 % off for every e-fold of 1 + t/tau
constexpr const char* is_logarithmic =
    "B may be 0, and is held at 0.001: a logarithm, of which A_inf B and tau mean something; ";

bool may_be_logarithmic(const Fit& fit) {
  const Estimate& b = fit.estimates[0];
  return b.identifiability == Identifiability::bounded_above || b.value < logarithmic_b;
}

void fit_shared(const std::vector<RealizationCurves>& all, int threads,
                std::vector<AgeingLaw>& laws) {
  const JoinedCurves joined = join(all);
  if (joined.waiting_times.empty()) return;
  const SharedAgeing model(joined.points);
  auto found = reweighted_fit(model, joined.curves, Runaways::left);
  std::string limit;
  if (const auto* free = std::get_if<WeightedFit>(&found);
      free != nullptr && may_be_logarithmic(free->fit)) {
    limit = is_logarithmic;
    found = reweighted_fit(model, joined.curves, Runaways::left, {{"B", logarithmic_b}});
  }
  if (const auto* refusal = std::get_if<Refusal>(&found)) {
    for (AgeingLaw& law : laws) law.verdict = refusal->message;
    return;
  }
  const auto& [fit, weighted] = std::get<WeightedFit>(found);
  const ResampledErrors errors = resample(model, weighted, fit, {.threads = threads});
  const std::vector<double> x = mean_curve(weighted).x;
  std::size_t first = 0;
  for (std::size_t curve = 0; curve < joined.waiting_times.size(); ++curve) {
    const std::size_t k = joined.waiting_times[curve], n = all[k].t.size();
    const std::array<std::size_t, 3> indices = {SharedAgeing::a_inf_index(curve), 0,
                                                SharedAgeing::tau_index(curve)};
    AgeingLaw law = law_of(fit, errors, indices);
    law.verdict = limit + without_number(without_number(law.verdict, "A_inf", curve), "tau", curve);
    law.misfit = misfit(std::span(x).subspan(first, n), std::span(fit.fitted).subspan(first, n));
    first += n;
    const bool determined =
        std::ranges::all_of(indices, [&](std::size_t j) { return is_limited(fit.estimates[j]); });
    laws[k] = determined ? law : no_law;
    laws[k].verdict = law.verdict;
    if (!determined) laws[k].verdict += ": no shared law, nothing to scale by";
  }
}

}  // namespace

AgeingFits fit_ageing(const TapRows& rows, const AgeingGrid& grid, int threads) {
  AgeingFits fits;
  const std::size_t n = grid.waiting_times.size();
  fits.own.assign(n, no_law);
  fits.shared.assign(n, no_law);
  const std::vector<std::uint32_t> complete = complete_realizations(rows);
  fits.realizations = complete.size();
  if (complete.size() < 3) {
    for (std::vector<AgeingLaw>* laws : {&fits.own, &fits.shared}) {
      for (AgeingLaw& law : *laws) {
        law.verdict = std::to_string(complete.size()) +
                      " realizations reached every tap asked for: fits need 3, so run more of "
                      "them, or ask for earlier taps";
      }
    }
    return fits;
  }
  std::vector<RealizationCurves> curves;
  for (std::size_t k = 0; k < n; ++k) {
    curves.push_back(squared_changes(rows, complete, grid.waiting_times[k], grid.lags));
    if (!curves[k].t.empty()) {
      fits.own[k] = own_law(curves[k], threads);
    } else {
      fits.own[k].verdict = "nothing changes after this waiting time, or the series ends before";
    }
  }
  fit_shared(curves, threads, fits.shared);
  return fits;
}

}  // namespace jostle
