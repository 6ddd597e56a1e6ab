#include "ensemble/analysis/ageing/time_scaling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "engine/numbers.hpp"
#include "ensemble/statistics/finite_text.hpp"
#include "ensemble/statistics/student_tests.hpp"
#include "fitting/solver/decompositions.hpp"
#include "fitting/value_text.hpp"

namespace jostle::inline ensemble {

namespace {

constexpr double least_mu = -1, most_mu = 2, mu_step = 0.05;
constexpr double refuted = significance_level;
constexpr Eigen::Index fewest_realizations =
    4;  // with three realizations, intervals contain the truth too seldom
const double decade = std::log(10.0);

/// Cubic B-splines with equal intervals, about a decade each, [n_points, n_splines].
struct Splines {
  Eigen::MatrixXd values, slopes;
};

Splines splines(const Eigen::VectorXd& u) {
  const double least = u.minCoeff(), extent = u.maxCoeff() - least;
  const double n = std::clamp(std::round(extent / decade), 1.0, 12.0);
  const double width = std::max(extent, 1e-9) / n;
  const auto columns = static_cast<Eigen::Index>(n) + 3;
  Splines all{Eigen::MatrixXd::Zero(u.size(), columns), Eigen::MatrixXd::Zero(u.size(), columns)};
  for (Eigen::Index i = 0; i < u.size(); ++i) {
    const double place = (u[i] - least) / width;
    const double interval = std::min(std::floor(place), n - 1);
    const double s = place - interval, r = 1 - s;
    const auto first = static_cast<Eigen::Index>(interval);
    all.values.row(i).segment<4>(first) << r * r * r / 6, (3 * s * s * s - 6 * s * s + 4) / 6,
        (3 * r * r * r - 6 * r * r + 4) / 6, s * s * s / 6;
    all.slopes.row(i).segment<4>(first) << -r * r / 2, (3 * s * s - 4 * s) / 2,
        (4 * r - 3 * r * r) / 2, s * s / 2;
  }
  all.slopes /= width;
  return all;
}

/// The smooth curve through ln A against a variable u, with a scale that ages or without, and what
/// is left.
struct SmoothCurve {
  Eigen::MatrixXd basis;             // [n_points, n_splines + n_scales]
  Eigen::VectorXd slope, residuals;  // [n_points]
  Eigen::VectorXd scale;             // [n_scales], ln A beside the curve

  SmoothCurve(const LogCurves& curves, const Eigen::VectorXd& u, const Eigen::MatrixXd& scales) {
    const Splines all = splines(u);
    const Eigen::Index n = all.values.cols();
    basis.resize(u.size(), n + scales.cols());
    basis << all.values, scales;
    const Eigen::VectorXd c = least_squares(basis, curves.ln_a);
    slope = all.slopes * c.head(n);
    residuals = curves.ln_a - basis * c;
    scale = c.tail(scales.cols());
  }
};

/// A number of each curve, at each of its points.
Eigen::VectorXd at_points(const LogCurves& curves,
                          const std::function<double(std::size_t curve)>& f) {
  Eigen::VectorXd values(curves.ln_a.size());
  for (std::size_t k = 0; k < curves.size(); ++k) {
    for (std::size_t i = curves.first[k]; i < curves.first[k + 1]; ++i) {
      values[static_cast<Eigen::Index>(i)] = f(k);
    }
  }
  return values;
}

Eigen::VectorXd places_of(const LogCurves& curves) {
  return at_points(curves, [&](std::size_t k) { return place_of(k, curves); });
}

Eigen::VectorXd ln_lags(const LogCurves& curves) {
  return Eigen::Map<const Eigen::ArrayXd>(curves.lags.data(),
                                          static_cast<Eigen::Index>(curves.lags.size()))
      .log();
}

/// Residual of a column after projection on the others, [n_points]; nothing where that is rounding:
/// where curves do not overlap, or have no more points than the function has parameters.
std::optional<Eigen::VectorXd> weights_beyond(const Eigen::VectorXd& column,
                                              const Eigen::MatrixXd& other_columns) {
  constexpr double rounding = 1e-9;
  Eigen::VectorXd weights = beyond_others(column, other_columns);
  if (!(weights.norm() > rounding * column.norm())) return std::nullopt;
  return weights;
}

struct Ages {
  LogCurves curves;
  Eigen::VectorXd t_w;  // [n_points]
};

// The curves whose waiting time is at least `least`.
Ages of_ages(const LogCurves& all, const std::vector<std::uint64_t>& waiting_times,
             std::uint64_t least) {
  Ages found;
  found.curves.first = {0};
  std::vector<Eigen::Index> rows;
  std::vector<double> t_w;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (waiting_times[k] < least) continue;
    found.curves.waiting_times.push_back(all.waiting_times[k]);
    for (std::size_t i = all.first[k]; i < all.first[k + 1]; ++i) {
      found.curves.lag_indices.push_back(all.lag_indices[i]);
      found.curves.lags.push_back(all.lags[i]);
      rows.push_back(static_cast<Eigen::Index>(i));
      t_w.push_back(static_cast<double>(waiting_times[k]));
    }
    found.curves.first.push_back(rows.size());
  }
  found.curves.ln_a = all.ln_a(rows);
  found.curves.influences = all.influences(rows, Eigen::seqN(0, all.influences.cols()));
  found.t_w = Eigen::Map<const Eigen::VectorXd>(t_w.data(), static_cast<Eigen::Index>(t_w.size()));
  return found;
}

// Requires a curve.
std::string first_of(const Ages& ages) {
  return finite_text("t_W = {:.0f}", ages.t_w[0]);
}

/// The least squares of ln A = F(ln t - mu ln t_W), or of that plus a scale that ages.
class PowerOfAge {
 public:
  /// scales: [n_points, 0 or 1].
  PowerOfAge(const Ages& ages, Eigen::MatrixXd scales)
      : curves_(ages.curves),
        ln_t_(ln_lags(ages.curves)),
        ln_age_(ages.t_w.array().log()),
        scales_(std::move(scales)) {
    for (int i = 0; i <= std::lround((most_mu - least_mu) / mu_step); ++i) {
      values_.push_back(least_mu + mu_step * i);
    }
    const auto squares = [&](double mu) { return curve_at(mu).residuals.squaredNorm(); };
    const double near = *std::ranges::min_element(values_, {}, squares);
    double low = std::max(near - mu_step, least_mu), high = std::min(near + mu_step, most_mu);
    while (high - low > 1e-4) {
      const double third = (high - low) / 3;
      if (squares(low + third) < squares(high - third)) {
        high -= third;
      } else {
        low += third;
      }
    }
    best_ = 0.5 * (low + high);
  }

  double best() const { return best_; }
  const std::vector<double>& values() const { return values_; }
  SmoothCurve curve_at(double mu) const { return {curves_, ln_t_ - mu * ln_age_, scales_}; }
  /// The derivative by mu.
  Eigen::VectorXd by_mu(const SmoothCurve& curve) const {
    return -curve.slope.cwiseProduct(ln_age_);
  }
  double t_of(double mu) const {
    const SmoothCurve curve = curve_at(mu);
    const auto weights = weights_beyond(by_mu(curve), curve.basis);
    if (!weights) return 0;  // nothing there refutes it
    return weights->dot(curve.residuals) / error_of_sum(curves_, *weights).error;
  }

 private:
  const LogCurves& curves_;
  Eigen::VectorXd ln_t_, ln_age_;  // [n_points]
  Eigen::MatrixXd scales_;
  std::vector<double> values_;  // grid of mu
  double best_;
};

AgeTrend scale_that_ages(const Ages& ages, const PowerOfAge& power, const TestedChange& words) {
  const Eigen::VectorXd places = places_of(ages.curves);
  const SmoothCurve best = power.curve_at(power.best());
  const Eigen::Index n_scales = best.scale.size(), n = best.basis.cols() - n_scales;
  Eigen::MatrixXd other_columns(places.size(), n + 1);
  other_columns << best.basis.leftCols(n), power.by_mu(best);
  const auto weights = weights_beyond(places, other_columns);
  if (!weights) return cannot_decide("the curves do not overlap");
  return tested_change(ages.curves, *weights,
                       n_scales == 0 ? best.residuals : best.residuals + best.scale[0] * places,
                       words);
}

/// Three significant digits, or as many as distinguish it from full ageing.
std::string end_text(double end) {
  return number_text(end, distinguishing_digits(end, 1, 3));
}

std::string words(const AgeingExponent& found) {
  const bool low = std::isfinite(found.low_95), high = std::isfinite(found.high_95);
  if (!low && !high) return "mu is not identifiable: no limit on either side (95 %)";
  if (!low || !high) {
    return fmt::format("mu has only {} limit: mu {} {} (95 %)", low ? "a lower" : "an upper",
                       low ? '>' : '<', end_text(low ? found.low_95 : found.high_95));
  }
  const auto misfit_of = [&](double mu) {
    return found.low_95 <= mu && mu <= found.high_95 ? "not rejected" : "rejected";
  };
  return fmt::format("mu is {} to {} (95 %), no ageing (0) {}, full ageing (1) {}",
                     end_text(found.low_95), end_text(found.high_95), misfit_of(0), misfit_of(1));
}

AgeingExponent no_exponent(const AgeTrend& collapse) {
  return {not_a_number,
          not_a_number,
          not_a_number,
          not_a_number,
          not_a_number,
          not_a_number,
          "mu has no estimate; " + collapse.verdict,
          collapse};
}

}  // namespace

AgeingExponent ageing_exponent(const LogCurves& all,
                               const std::vector<std::uint64_t>& waiting_times,
                               const std::string& name) {
  const Ages ages = of_ages(all, waiting_times, 1);
  const LogCurves& curves = ages.curves;
  if (curves.influences.cols() < fewest_realizations) {
    return no_exponent(cannot_decide(fmt::format("mu needs {} realizations", fewest_realizations)));
  }
  if (curves.size() < 2) {
    return no_exponent(cannot_decide("fewer than two waiting times above 0 have curves"));
  }
  const PowerOfAge power(ages, Eigen::MatrixXd(ages.t_w.size(), 0));
  // Without a scale, mu compensates much of an existing one, and a test about the best mu has
  // little power. Fitted together the two are so alike, where A is nearly a power, that errors are
  // too small. A scale is accepted if both find it, and excluded if neither does.
  const TestedChange change{name + " at equal t/t_W^mu", "collapse rejected",
                            "collapse not rejected", first_of(ages)};
  const AgeTrend about_mu = scale_that_ages(ages, power, change);
  const AgeTrend beside_mu = scale_that_ages(ages, PowerOfAge(ages, places_of(curves)), change);
  const AgeTrend collapse =
      agreed(about_mu, beside_mu, static_cast<std::size_t>(curves.influences.cols()), change);
  if (about_mu.p < refuted || beside_mu.p < refuted) return no_exponent(collapse);
  const SmoothCurve best = power.curve_at(power.best());
  const auto weights = weights_beyond(power.by_mu(best), best.basis);
  if (!weights) return no_exponent(cannot_decide("the curves do not constrain mu"));
  const ErrorOf error = error_of_sum(curves, *weights / weights->squaredNorm());
  const TestedEnds ends = tested_ends(power.values(), power.best(), error.dof,
                                      [&](double mu) { return power.t_of(mu); });
  AgeingExponent found{power.best(), error.error,  ends.low[0], ends.high[0],
                       ends.low[1],  ends.high[1], "",          collapse};
  found.verdict = words(found) + "; " + collapse.verdict;
  const bool has_limit = std::isfinite(found.low_95) || std::isfinite(found.high_95);
  if (!has_limit || !std::isfinite(found.low_68) || !std::isfinite(found.high_68))
    found.mu = found.error = not_a_number;
  return found;
}

AgeTrend logarithmic_collapse(const LogCurves& all, const std::vector<std::uint64_t>& waiting_times,
                              const std::string& name) {
  const Ages ages = of_ages(all, waiting_times, 2);
  const LogCurves& curves = ages.curves;
  if (curves.influences.cols() < fewest_realizations) {
    return cannot_decide(fmt::format("the logarithms need {} realizations", fewest_realizations));
  }
  if (curves.size() < 2) {
    return cannot_decide("fewer than two waiting times above 1 have curves");
  }
  const Eigen::ArrayXd lags = ln_lags(curves).array().exp(), t_w = ages.t_w.array();
  const SmoothCurve curve(curves, ((lags / t_w).log1p() / t_w.log()).log(),
                          Eigen::MatrixXd(t_w.size(), 0));
  const auto weights = weights_beyond(-curve.slope.cwiseProduct(places_of(curves)), curve.basis);
  if (!weights) return cannot_decide("the curves do not overlap");
  return tested_change(curves, *weights, curve.residuals,
                       {"ln(1 + t/t_W)/ln t_W at equal " + name, "collapse rejected",
                        "collapse not rejected", first_of(ages)});
}

TimeScaling cannot_scale(const std::string& reason) {
  return {no_exponent(cannot_decide(reason)), cannot_decide(reason)};
}

TimeScaling time_scaling(const LogCurves& curves, const AgeingGrid& grid, const std::string& name) {
  std::vector<std::uint64_t> waiting_times;
  for (const std::size_t k : curves.waiting_times) waiting_times.push_back(grid.waiting_times[k]);
  return {ageing_exponent(curves, waiting_times, name),
          logarithmic_collapse(curves, waiting_times, name)};
}

}  // namespace jostle::inline ensemble
