#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>

#include "fitting/fit.hpp"
#include "fitting/models/models.hpp"
#include "tests/fitting/noise.hpp"

// How often intervals hold the truth where points remember: few realizations, or one alone, of
// white noise and of AR(1) noise with a correlation of up to 0.99 from point to point.
namespace jostle {
namespace {

struct Law {
  const char* model;
  ParameterValues truth;
  std::vector<double> t;
  double noise;  // deviation of a realization, of X or relative to it for the power law
};

std::vector<double> taps(int n) {
  std::vector<double> t;
  for (int tap = 1; tap <= n; ++tap) t.push_back(tap);
  return t;
}

std::vector<double> steps(double first, double last, int n) {
  std::vector<double> t;
  for (int i = 0; i < n; ++i) t.push_back(first + (last - first) * i / (n - 1));
  return t;
}

// Typical of runs: 400 taps, and deviations of a bed of about a thousand spheres.
const std::vector<Law>& laws() {
  static const std::vector<Law> all = {
      {"inverse_log", {0.58, 0.05, 1.0, 3}, taps(400), 1e-3},
      {"inverse_log_height", {13.9, 14.67, 0.8, 4}, taps(400), 0.01},
      {"two_exponentials", {13.5, 0.4, 8, 0.3, 100}, taps(400), 0.01},
      {"kww", {0.6, 0.55, 30, 0.6}, taps(400), 1e-3},
      {"ageing", {0.5, 0.8, 10}, taps(400), 5e-3},
      {"profile", {0.6, 0.002, 2, 24}, steps(5, 28, 116), 5e-3},
      {"pore_tail", {60, 0.03}, steps(0.01, 0.2, 96), 0.5},
      {"power_law", {1e-7, 1.3}, geometric(1e-3, 0.5, 60), 0.2},
      {"normal", {1, 7.271, 1.255}, steps(3, 13, 101), 5e-3},
      {"k_gamma", {1, 1.2, 12}, steps(0.8, 2.2, 71), 0.05}};
  return all;
}

// [n, n_realizations], AR(1) from point to point, its deviation that of the law.
Curve ensemble(const Model& model, const Law& law, int n_realizations, double rho, int number) {
  Noise noise(static_cast<std::uint64_t>(number));
  const bool relative = model.residual_scale() == ResidualScale::logarithmic;
  std::vector<double> memory(static_cast<std::size_t>(n_realizations)), values;
  for (double& state : memory) state = noise();
  for (const double t : law.t) {
    const double value = model.value(t, law.truth.data());
    for (double& state : memory) {
      values.push_back(value + law.noise * state * (relative ? value : 1));
      state = rho * state + std::sqrt(1 - rho * rho) * noise();
    }
  }
  return mean_curve(law.t, std::move(values), static_cast<std::size_t>(n_realizations));
}

struct Coverage {
  int examined = 0;         // intervals, of all parameters
  int covered[2] = {0, 0};  // at interval_levels; an open side holds everything beyond it
  int closed = 0;           // number of closed 95 % intervals
  double share(int level) const { return static_cast<double>(covered[level]) / examined; }
};

Coverage coverage(const Law& law, int n_realizations, double rho, int ensembles) {
  const auto model = make_model(law.model);
  Coverage found;
  for (int number = 1; number <= ensembles; ++number) {
    const auto result = fit(*model, ensemble(*model, law, n_realizations, rho, number));
    const Fit& fitted = std::get<Fit>(result);
    for (std::size_t j = 0; j < law.truth.size(); ++j) {
      const Estimate& estimate = fitted.estimates[j];
      if (estimate.identifiability == Identifiability::not_examined) continue;
      ++found.examined;
      found.closed += estimate.intervals[1].closed();
      for (int level = 0; level < 2; ++level) {
        const Interval& interval = estimate.intervals[level];
        found.covered[level] += interval.lower <= law.truth[j] && law.truth[j] <= interval.upper;
      }
    }
  }
  return found;
}

// 90 to 99 % of the 95 % intervals, 60 to 78 % of those of one error, beside 3 errors of so many
// ensembles (the parameters of one fit count as one).
void check(const Law& law, int n_realizations, double rho, int ensembles) {
  const Coverage found = coverage(law, n_realizations, rho, ensembles);
  const std::size_t expected = law.truth.size() * static_cast<std::size_t>(ensembles);
  std::printf("%-20s M %2d  rho %4.2f  68 %%: %5.1f  95 %%: %5.1f  closed %5.1f  examined %5.1f\n",
              law.model, n_realizations, rho, 100 * found.share(0), 100 * found.share(1),
              100.0 * found.closed / found.examined,
              100.0 * found.examined / static_cast<double>(expected));
  INFO(law.model << ", " << n_realizations << " realizations, rho " << rho);
  const auto margin = [&](double rate) { return 3 * std::sqrt(rate * (1 - rate) / ensembles); };
  CHECK(found.share(0) >= 0.60 - margin(0.60));
  CHECK(found.share(0) <= 0.78 + margin(0.78));
  CHECK(found.share(1) >= 0.90 - margin(0.90));
  CHECK(found.share(1) <= 0.99 + margin(0.99));
}

void check_few_realizations(const std::string& model) {
  for (const Law& law : laws()) {
    if (law.model != model) continue;
    check(law, 3, 0, 20);
    check(law, 3, 0.99, 20);
    check(law, 10, 0.99, 20);
  }
}

void check_one_realization(const std::string& model) {
  for (const Law& law : laws()) {
    if (law.model != model) continue;
    for (const double rho : {0.5, 0.9}) check(law, 1, rho, 40);
    // 400 points that remember for 100 are worth 2: an error would be a guess.
    const Coverage found = coverage(law, 1, 0.99, 40);
    CHECK(found.examined <= 0.2 * 40 * static_cast<double>(law.truth.size()));
  }
}

}  // namespace

TEST_CASE("Few realizations with memory: intervals hold the truth at their stated rate",
          "[statistics]") {
  check_few_realizations("power_law");
}

TEST_CASE("Few realizations with memory: intervals of other laws hold the truth", "[slow]") {
  for (const char* model : {"inverse_log", "kww"}) check_few_realizations(model);
}

TEST_CASE("One realization with memory: intervals hold the truth, or none are given", "[slow]") {
  for (const char* model : {"inverse_log", "kww"}) check_one_realization(model);
}

TEST_CASE("Where B and tau diverge together, their ratio has limits that hold the truth") {
  // 1 - 1/(1 + t/50): the inverse log's limit of B and tau without bound, B/tau = 1/50.
  int covered = 0, found = 0;
  constexpr int curves = 40;
  for (int number = 1; number <= curves; ++number) {
    Noise noise(static_cast<std::uint64_t>(number));
    Curve curve{.t = geometric(1, 1000, 60), .x = {}, .sigma = std::vector<double>(60, 1e-3)};
    for (const double t : curve.t) curve.x.push_back(1 - 1 / (1 + t / 50) + 1e-3 * noise());
    const Fit fitted = std::get<Fit>(fit(InverseLog(), curve));
    if (fitted.combinations.empty()) continue;
    ++found;
    CHECK(fitted.combinations[0].parameter.name == "B/tau");
    const Interval& interval = fitted.combinations[0].intervals[1];
    covered += interval.lower <= 0.02 && 0.02 <= interval.upper;
  }
  CHECK(found >= curves / 2);
  // 95 %, a one-sided limit of B beside it; 3 errors of so many.
  CHECK(covered >= 0.95 * found - 3 * std::sqrt(0.95 * 0.05 * found));
}

TEST_CASE("The calibration table: every law, 2 to 20 realizations, memories up to 0.99",
          "[nightly]") {
  // A quarter of an hour in all: -c NAME takes one law.
  for (const Law& law : laws()) {
    DYNAMIC_SECTION(law.model) {
      for (const int n_realizations : {2, 3, 4, 10, 20}) {
        for (const double rho : {0.0, 0.9, 0.99}) check(law, n_realizations, rho, 200);
      }
    }
  }
}

}  // namespace jostle
