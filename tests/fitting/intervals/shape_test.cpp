#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>

#include "fitting/fit.hpp"
#include "fitting/models/models.hpp"
#include "tests/fitting/noise.hpp"

// Intervals where realizations differ in shape: each has parameters of its own, and white noise.
// The truth is the law nearest to the mean curve of all realizations.
namespace jostle {
namespace {

struct Law {
  const char* model;
  ParameterValues centre;
  double noise;  // deviation of a realization at a point
  double last;   // t
};

const std::vector<Law>& laws() {
  static const std::vector<Law> all = {{"kww", {0.6, 0.55, 300, 0.6}, 1e-3, 3000},
                                       {"inverse_log", {0.58, 0.05, 1.0, 3}, 1e-3, 1000},
                                       {"two_exponentials", {13.5, 0.4, 8, 0.3, 100}, 0.01, 1000}};
  return all;
}

enum class Scatter { level, shape };

struct Ensemble {
  const Law& law;
  Scatter scatter = Scatter::shape;
  int n_realizations = 6;
};

constexpr double relative_scatter = 0.05;  // deviation of each parameter, relative
constexpr double level_scatter = 3;        // deviation of levels, in noise

std::vector<double> times(const Law& law) {
  return geometric(1, law.last, 60);
}

ParameterValues realization(const Law& law, Scatter scatter, Noise& noise) {
  ParameterValues p = law.centre;
  const bool second_level = std::string(law.model) == "kww";  // rho_0 is a level too
  if (scatter == Scatter::level) {
    const double shift = level_scatter * law.noise * noise();
    p[0] += shift;
    if (second_level) p[1] += shift;
    return p;
  }
  p[0] *= 1 + relative_scatter * noise();
  for (std::size_t j = 1; j < p.size(); ++j) p[j] *= std::exp(relative_scatter * noise());
  return p;
}

Curve curve_of(const Ensemble& ensemble, int number) {
  const Law& law = ensemble.law;
  const auto model = make_model(law.model);
  Noise noise(static_cast<std::uint64_t>(number));
  std::vector<ParameterValues> realizations;
  for (int r = 0; r < ensemble.n_realizations; ++r) {
    realizations.push_back(realization(law, ensemble.scatter, noise));
  }
  std::vector<double> values;
  for (const double t : times(law)) {
    for (const ParameterValues& p : realizations) {
      values.push_back(model->value(t, p.data()) + law.noise * noise());
    }
  }
  return mean_curve(times(law), std::move(values), realizations.size());
}

ParameterValues nearest(const Law& law, Scatter scatter) {
  if (scatter == Scatter::level) return law.centre;
  const auto model = make_model(law.model);
  constexpr int realizations = 20000;
  Noise noise(999);
  Curve mean{.t = times(law), .x = std::vector<double>(60, 0.0), .sigma = {}};
  for (int r = 0; r < realizations; ++r) {
    const ParameterValues p = realization(law, scatter, noise);
    for (std::size_t i = 0; i < mean.t.size(); ++i) {
      mean.x[i] += model->value(mean.t[i], p.data()) / realizations;
    }
  }
  return std::get<Fit>(fit(*model, mean, {.profiles = false})).values();
}

struct Coverage {
  int fits = 0, closed = 0;  // closed: all 95 % intervals of a fit
  std::vector<int> covered[2];
};

Coverage coverage(const Ensemble& ensemble, int ensembles) {
  const auto model = make_model(ensemble.law.model);
  const ParameterValues truth = nearest(ensemble.law, ensemble.scatter);
  Coverage found;
  for (auto& covered : found.covered) covered.assign(truth.size(), 0);
  for (int number = 1; number <= ensembles; ++number) {
    const Fit fitted = std::get<Fit>(fit(*model, curve_of(ensemble, number)));
    ++found.fits;
    bool closed = true;
    for (std::size_t j = 0; j < truth.size(); ++j) {
      closed = closed && fitted.estimates[j].intervals[1].closed();
      for (int level = 0; level < 2; ++level) {
        const Interval& interval = fitted.estimates[j].intervals[level];
        found.covered[level][j] += interval.lower <= truth[j] && truth[j] <= interval.upper;
      }
    }
    found.closed += closed;
  }
  return found;
}

// 90 to 99 % of the 95 % intervals of each parameter, 60 to 78 % of those of one error, beside 3
// errors of so many ensembles.
void check(const Ensemble& ensemble, int ensembles) {
  const Coverage found = coverage(ensemble, ensembles);
  const char* scatter = ensemble.scatter == Scatter::level ? "level" : "shape";
  std::printf("%-17s M %2d  %s  closed %5.1f ", ensemble.law.model, ensemble.n_realizations,
              scatter, 100.0 * found.closed / found.fits);
  const auto model = make_model(ensemble.law.model);
  const auto margin = [&](double rate) { return 3 * std::sqrt(rate * (1 - rate) / found.fits); };
  for (std::size_t j = 0; j < found.covered[0].size(); ++j) {
    const std::string& name = model->parameters()[j].name;
    const double value = 1.0 * found.covered[0][j] / found.fits;
    const double two = 1.0 * found.covered[1][j] / found.fits;
    std::printf(" %s %4.1f %4.1f ", name.c_str(), 100 * value, 100 * two);
    INFO(ensemble.law.model << ' ' << name << ", " << scatter << ", " << ensemble.n_realizations
                            << " realizations");
    CHECK(value >= 0.60 - margin(0.60));
    CHECK(value <= 0.78 + margin(0.78));
    CHECK(two >= 0.90 - margin(0.90));
    CHECK(two <= 0.99 + margin(0.99));
  }
  std::printf("\n");
}

}  // namespace

TEST_CASE("Realizations that differ in shape: parameters that they determine have both limits") {
  // A profile of rho_inf follows tau and beta to values that no realization has, and stays open.
  const Coverage found = coverage({.law = laws()[0]}, 12);
  CHECK(found.closed >= 10);
}

TEST_CASE("Realizations that differ in shape: intervals hold the nearest law", "[statistics]") {
  check({.law = laws()[0]}, 60);
}

TEST_CASE("Realizations that differ in level or shape: every number of realizations", "[nightly]") {
  for (const Law& law : laws()) {
    for (const Scatter scatter : {Scatter::level, Scatter::shape}) {
      for (const int m : {3, 6, 10, 20}) {
        check({.law = law, .scatter = scatter, .n_realizations = m}, 200);
      }
    }
  }
}

TEST_CASE("Restated parameters have intervals of the method of the fit") {
  // Realizations whose dX, B and tau differ by 60 %: B of eq. 4 is B of eq. 3 times Z_0/Z_inf.
  int different = 0;
  for (const std::size_t n_realizations : {3, 4}) {
    for (int number = 1; number <= 20; ++number) {
      Noise noise(static_cast<std::uint64_t>(number));
      std::vector<ParameterValues> realizations(n_realizations, laws()[1].centre);
      for (ParameterValues& p : realizations)
        for (std::size_t j = 1; j < p.size(); ++j) p[j] *= std::exp(0.6 * noise());
      std::vector<double> values;
      for (const double t : times(laws()[1])) {
        for (const ParameterValues& p : realizations)
          values.push_back(InverseLog().value(t, p.data()) + laws()[1].noise * noise());
      }
      const auto outcome =
          fit(InverseLog(), mean_curve(times(laws()[1]), std::move(values), n_realizations));
      const Fit& fitted = std::get<Fit>(outcome);
      if (!fitted.has_student_intervals || !fitted.restated) continue;
      ++different;
      const Estimate &b = fitted.estimates[2], &restated = fitted.restated->estimates[2];
      INFO(n_realizations << " realizations, ensemble " << number << ": " << b.statement << "; "
                          << restated.statement);
      REQUIRE(restated.parameter.name == "B");
      CHECK(restated.intervals[1].closed() == b.intervals[1].closed());
    }
  }
  CHECK(different >= 10);
}

}  // namespace jostle
