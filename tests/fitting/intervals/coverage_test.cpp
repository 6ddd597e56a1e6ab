#include <catch2/catch.hpp>
#include <cmath>
#include <iostream>

#include "fitting/fit.hpp"
#include "fitting/models/models.hpp"
#include "tests/fitting/noise.hpp"

// How often the intervals hold the truth, over synthetic curves with normal noise.
namespace jostle {
namespace {

struct Study {
  const char* model;
  ParameterValues truth;
  std::vector<double> t;
  double noise;  // noise of X, or relative to it for the power law
};

// Noise as in ensemble averages; every profile closes.
const std::vector<Study>& studies() {
  static const std::vector<Study> all = {
      {"inverse_log", {0.625, 0.045, 0.8, 3}, geometric(1, 10000, 54), 2e-4},
      {"inverse_log_height", {13.9, 14.67, 0.8, 4}, geometric(1, 10000, 54), 2e-3},
      {"two_exponentials", {13.5, 0.4, 8, 0.3, 400}, geometric(1, 4000, 60), 2e-3},
      {"kww", {0.658, 0.538, 1083, 0.2715}, geometric(1, 90000, 64), 3e-4},
      {"ageing", {0.5, 0.4, 20}, geometric(1, 10000, 45), 2e-3},
      {"profile", {0.6, 0.002, 2, 24}, geometric(5, 28, 60), 2e-3},
      {"pore_tail", {60, 0.03}, geometric(0.01, 0.2, 40), 0.2},
      {"power_law", {1e-7, 1.3}, geometric(1e-3, 0.5, 60), 0.1},
      {"normal", {1, 7.271, 1.255}, geometric(3, 13, 40), 3e-3}};
  return all;
}

// The seed of a curve is its number.
Curve synthetic(const Model& model, const Study& study, int number) {
  Noise noise(static_cast<std::uint64_t>(number));
  const bool relative = model.residual_scale() == ResidualScale::logarithmic;
  Curve curve{study.t, {}, {}};
  for (double t : study.t) {
    const double value = model.value(t, study.truth.data());
    curve.x.push_back(relative ? value * std::exp(study.noise * noise())
                               : value + study.noise * noise());
  }
  return curve;
}

// Within 4 binomial standard errors at every level for every parameter, where profiles close.
void check_coverage(const Study& study, int curves, bool sigma_given) {
  const auto model = make_model(study.model);
  const std::size_t n = study.truth.size();
  std::vector<int> covered[2] = {std::vector<int>(n), std::vector<int>(n)};
  int closed = 0;
  for (int number = 1; number <= curves; ++number) {
    Curve curve = synthetic(*model, study, number);
    if (sigma_given) curve.sigma.assign(curve.t.size(), study.noise);
    const Fit fitted = std::get<Fit>(fit(*model, curve));
    bool all_closed = true;
    for (std::size_t j = 0; j < n; ++j) {
      for (int level = 0; level < 2; ++level) {
        const Interval& interval = fitted.estimates[j].intervals[level];
        all_closed = all_closed && interval.closed();
        covered[level][j] += interval.lower <= study.truth[j] && study.truth[j] <= interval.upper;
      }
    }
    closed += all_closed;
  }
  INFO(study.model << (sigma_given ? ", sigma given" : ""));
  CHECK(closed >= 0.99 * curves);
  for (int level = 0; level < 2; ++level) {
    const double rate = interval_levels[level];
    const double error = std::sqrt(rate * (1 - rate) / curves);
    for (std::size_t j = 0; j < n; ++j) {
      INFO(model->parameters()[j].name << " at " << rate);
      const double found = static_cast<double>(covered[level][j]) / curves;
      CHECK(std::abs(found - rate) <= 4 * error);
      if (curves >= 1000) {
        std::cout << study.model << (sigma_given ? " (sigma)" : "") << ' '
                  << model->parameters()[j].name << ": " << found << " of " << rate << '\n';
      }
    }
  }
}

}  // namespace

TEST_CASE("intervals hold the truth at their stated rate, in 40 curves of the first law",
          "[statistics]") {
  check_coverage(studies().front(), 40, false);
  check_coverage(studies().front(), 40, true);
}

TEST_CASE("intervals hold the truth at their stated rate, in 100 curves", "[slow]") {
  for (const Study& study : studies()) check_coverage(study, 100, false);
  // Errors given: the power law's are relative, so it is left to the others.
  for (const Study& study : studies()) {
    if (std::string(study.model) != "power_law") check_coverage(study, 100, true);
  }
}

TEST_CASE("intervals hold the truth at their stated rate, in 1000 curves", "[nightly]") {
  for (const Study& study : studies()) check_coverage(study, 1000, false);
}

TEST_CASE("coverage of the sloppy inverse log is near nominal, an open side counting as the bound",
          "[nightly]") {
  const Study sloppy = {"inverse_log", {0.66, 0.076, 0.06, 15}, geometric(1, 4000, 60), 3e-4};
  const auto model = make_model(sloppy.model);
  int covered[2] = {0, 0}, open = 0;
  for (int number = 1; number <= 1000; ++number) {
    const Fit fitted = std::get<Fit>(fit(*model, synthetic(*model, sloppy, number)));
    const Estimate& x_inf = fitted.estimates[0];
    open += !x_inf.intervals[1].closed();
    for (int level = 0; level < 2; ++level) {
      const Interval& interval = x_inf.intervals[level];
      covered[level] += interval.lower <= sloppy.truth[0] && sloppy.truth[0] <= interval.upper;
    }
  }
  std::cout << "sloppy inverse_log, X_inf: " << covered[0] / 1000.0 << " of 0.683, "
            << covered[1] / 1000.0 << " of 0.95; open in " << open / 1000.0 << '\n';
  // Measured, not promised: but it must not be far off.
  CHECK(covered[1] > 850);
}

}  // namespace jostle
