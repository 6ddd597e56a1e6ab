#include "ensemble/analysis/ageing/fits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>

#include "engine/numbers.hpp"
#include "ensemble/analysis/ageing/law.hpp"
#include "ensemble/parallel.hpp"
#include "ensemble/statistics/finite_text.hpp"
#include "fitting/solver/decompositions.hpp"

namespace jostle::inline ensemble {

namespace {

constexpr double wide = 2;  // a factor to either side
const AgeingLaw no_law = {no_estimate(), no_estimate(), no_estimate(), not_a_number, "not fitted"};

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

// Describes how the data constrain one parameter; empty where they constrain it well. The limits of
// a scale presume the held B: if both exist, nothing is stated.
std::string statement(const char* name, const LogEstimate& estimate, bool is_scale = false) {
  const bool has_lower = estimate.low_95 > 0, has_upper = std::isfinite(estimate.high_95);
  if (has_lower && has_upper) {
    if (is_scale ||
        (estimate.high_95 <= wide * estimate.value && wide * estimate.low_95 >= estimate.value)) {
      return "";
    }
    return finite_text("{} is wide: {:.3g} to {:.3g} (95 %)", name, estimate.low_95,
                       estimate.high_95);
  }
  if (!has_lower && !has_upper)
    return fmt::format("{} is not identifiable: no limit on either side", name);
  return finite_text("{} has only {} limit: {} {} {:.3g} (95 %)", name,
                     has_lower ? "a lower" : "an upper", name, has_lower ? '>' : '<',
                     has_lower ? estimate.low_95 : estimate.high_95);
}

double misfit(const AgeingLeastSquares& fit, std::size_t curve) {
  const LogCurves& curves = fit.curves();
  const auto first = static_cast<Eigen::Index>(curves.first[curve]);
  const auto n = static_cast<Eigen::Index>(curves.first[curve + 1]) - first;
  const Eigen::ArrayXd misfit = fit.residuals(fit.best()).segment(first, n).array().exp() - 1;
  return std::sqrt(misfit.square().mean());
}

AgeingLaw law_of(const AgeingLeastSquares& fit, std::size_t curve, LogEstimate a_inf,
                 const LogEstimate& b, LogEstimate tau) {
  if (!fit.b_is_held()) {
    // B without limit takes tau along, and B = 0 A_inf.
    if (std::isinf(b.high_68)) tau.high_68 = infinite;
    if (std::isinf(b.high_95)) tau.high_95 = infinite;
    if (b.low_68 == 0) a_inf.high_68 = infinite;
    if (b.low_95 == 0) a_inf.high_95 = infinite;
  }
  AgeingLaw law{a_inf, b, tau, misfit(fit, curve), "", fit.b_is_held()};
  if (!fit.describes()) {
    law.verdict = fit.curves().size() == 1
                      ? "eq. 6 does not describe this curve"
                      : "eq. 6 with one B does not describe these curves together";
    return law;
  }
  for (const std::string& text :
       {statement("A_inf", law.a_inf, law.b_is_held), law.b_is_held ? "" : statement("B", law.b),
        statement("tau", law.tau, law.b_is_held)}) {
    if (!text.empty()) law.verdict.append(law.verdict.empty() ? "" : ", ").append(text);
  }
  if (law.verdict.empty() && !law.b_is_held) law.verdict = "identified";
  return law;
}

// f(0) to f(n - 1), each by any thread.
void for_each(int threads, std::size_t n, const std::function<void(std::size_t)>& f) {
  std::atomic<std::size_t> next{0};
  on_threads(threads, [&] {
    for (std::size_t i = next++; i < n; i = next++) f(i);
  });
}

// Relative errors of A / A_inf at equal t / tau, of all points.
std::vector<double> scaled_errors(const AgeingLeastSquares& fit) {
  const LogCurves& curves = fit.curves();
  const Eigen::MatrixXd slopes = fit.slopes(fit.best());
  const Eigen::MatrixXd parameters = least_squares_of_columns(slopes, curves.influences);
  const auto m = static_cast<double>(curves.influences.cols());
  std::vector<double> errors;
  for (std::size_t k = 0; k < curves.size(); ++k) {
    const auto a_inf = static_cast<Eigen::Index>(AgeingLeastSquares::a_inf(k));
    const auto tau = static_cast<Eigen::Index>(AgeingLeastSquares::tau(k));
    for (std::size_t i = curves.first[k]; i < curves.first[k + 1]; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      // A larger tau moves the point along the law: d ln A / d ln t = -d ln A / d ln tau.
      const Eigen::RowVectorXd influences = curves.influences.row(row) - parameters.row(a_inf) -
                                            slopes(row, tau) * parameters.row(tau);
      errors.push_back(std::sqrt(influences.squaredNorm() / (m * (m - 1))));
    }
  }
  return errors;
}

void fit_shared(const LogCurves& curves, std::size_t n_lags, int threads, AgeingFits& fits) {
  AgeingLeastSquares fit(curves);
  fits.collapse = trend_of_b(fit);
  const LogEstimate b = fit.estimate(fit.b());
  std::string held;
  if (fit.describes() && !is_limited(b)) {
    held = statement("B", b) +
           finite_text(
               ": it is held at {:.3g}, and of A_inf and tau only ratios between waiting "
               "times mean something",
               b.value);
    fit = AgeingLeastSquares(curves, std::log(b.value));
  }
  std::vector<LogEstimate> estimates(2 * curves.size());
  for_each(threads, estimates.size(), [&](std::size_t i) { estimates[i] = fit.estimate(i); });
  const std::vector<double> errors = scaled_errors(fit);
  for (std::size_t curve = 0; curve < curves.size(); ++curve) {
    const std::size_t k = curves.waiting_times[curve];
    AgeingLaw& law = fits.shared[k] =
        law_of(fit, curve, estimates[AgeingLeastSquares::a_inf(curve)], b,
               estimates[AgeingLeastSquares::tau(curve)]);
    law.verdict = held + (held.empty() || law.verdict.empty() ? "" : "; ") + law.verdict;
    if (!law.is_determined()) {
      law.verdict += ": no shared law, nothing to scale by";
      continue;
    }
    for (std::size_t i = curves.first[curve]; i < curves.first[curve + 1]; ++i) {
      fits.scaled_error[k * n_lags + curves.lag_indices[i]] = errors[i];
    }
  }
}

}  // namespace

bool AgeingLaw::is_determined() const {
  return is_limited(a_inf) && (b_is_held || is_limited(b)) && is_limited(tau);
}

AgeingLaw own_law(const LogCurves& curve) {
  const AgeingLeastSquares fit(curve);
  return law_of(fit, 0, fit.estimate(AgeingLeastSquares::a_inf(0)), fit.estimate(fit.b()),
                fit.estimate(AgeingLeastSquares::tau(0)));
}

namespace {

std::string too_few(std::size_t complete, std::size_t realizations) {
  const char* rule =
      "laws and tests of ageing need 3 realizations that reached every tap asked for";
  if (complete == realizations)
    return fmt::format("{}, there are {}: run more realizations", rule, realizations);
  return fmt::format("{}, {} of {} did: run more realizations, or ask for earlier taps", rule,
                     complete, realizations);
}

std::string too_few_lags(std::size_t lags) {
  return fmt::format(
      "{} lag{} with a change, {} needed for a law of three parameters: ask for more "
      "lags, or tap longer",
      lags, lags == 1 ? "" : "s", fewest_lags);
}

std::size_t most_lags(const TapRows& rows, const AgeingGrid& grid,
                      const std::vector<std::uint32_t>& realizations) {
  std::size_t most = 0;
  for (std::size_t k = 0; k < grid.waiting_times.size(); ++k)
    most = std::max(most, lags_of_curve(rows, grid, realizations, k));
  return most;
}

// Reason why a waiting time has no curve.
std::string why_no_law(const TapRows& rows, const AgeingGrid& grid,
                       const std::vector<std::uint32_t>& realizations, std::size_t waiting_time) {
  const std::size_t lags = lags_of_curve(rows, grid, realizations, waiting_time);
  if (lags > 0) return too_few_lags(lags);
  const std::uint64_t first = grid.waiting_times[waiting_time];
  const bool reached = std::ranges::any_of(
      grid.lags, [&](std::uint64_t lag) { return !rows.row(first + lag).empty(); });
  return rows.row(first).empty() || !reached ? "the series ends before"
                                             : "nothing changes after this waiting time";
}

}  // namespace

AgeingFits fit_ageing(const TapRows& rows, const AgeingGrid& grid, int threads) {
  AgeingFits fits;
  const std::size_t n = grid.waiting_times.size();
  fits.own.assign(n, no_law);
  fits.shared.assign(n, no_law);
  fits.scaled_error.assign(n * grid.lags.size(), not_a_number);
  const std::vector<std::uint32_t> complete = complete_realizations(rows);
  fits.realizations = complete.size();
  const auto say = [&](const std::string& reason) {
    fits.ageing = fits.fluctuations = fits.collapse = cannot_decide(reason);
    fits.a_scaling = fits.v_scaling = cannot_scale(reason);
    for (std::vector<AgeingLaw>* laws : {&fits.own, &fits.shared}) {
      for (AgeingLaw& law : *laws) law.verdict = reason;
    }
  };
  if (complete.size() < 3) {
    say(too_few(complete.size(), rows.realizations));
    return fits;
  }
  say("nothing changes after these waiting times");
  if (const std::size_t most = most_lags(rows, grid, complete); most > 0 && most < fewest_lags)
    say(too_few_lags(most));
  for (std::size_t k = 0; k < n; ++k)
    fits.own[k].verdict = fits.shared[k].verdict = why_no_law(rows, grid, complete, k);
  const LogCurves curves = log_curves(rows, grid, complete);
  if (curves.size() == 0) return fits;
  for_each(threads, curves.size(), [&](std::size_t curve) {
    fits.own[curves.waiting_times[curve]] = own_law(curves.single(curve));
  });
  fits.ageing = trend_with_age(curves, "A");
  fits.a_scaling = time_scaling(curves, grid, "A");
  if (complete.size() < 4) {
    constexpr const char* too_few = "variances need four realizations";
    fits.fluctuations = cannot_decide(too_few);
    fits.v_scaling = cannot_scale(too_few);
  } else {
    const LogCurves variances = log_curves(rows, grid, complete, Changes::variance);
    fits.fluctuations = trend_with_age(variances, "V");
    fits.v_scaling = time_scaling(variances, grid, "V");
  }
  fit_shared(curves, grid.lags.size(), threads, fits);
  return fits;
}

}  // namespace jostle::inline ensemble
