#include "ensemble/statistics/resampled_fit.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "fitting/intervals/distributions.hpp"
#include "fitting/models/models.hpp"
#include "tests/ensemble/noise.hpp"
#include "tests/test_files.hpp"

namespace jostle {
namespace {

/// theta^(1/power) + t: its fit to a mean of x_r + t is mean(x)^power.
class PowerOfLevel final : public Model {
 public:
  explicit PowerOfLevel(int power) : power_(power) {}
  std::string name() const override { return "power_of_level"; }
  const std::vector<Parameter>& parameters() const override {
    static const std::vector<Parameter> list = {{.name = "theta", .meaning = "level", .lower = 0}};
    return list;
  }
  double value(double t, const double* p) const override {
    return std::pow(p[0], 1.0 / power_) + t;
  }

 private:
  int power_;
};

nlohmann::json reference() {
  std::ifstream file(test_data("jackknife_bootstrap.json"));
  return nlohmann::json::parse(file);
}

RealizationCurves shifted_lines(const std::vector<double>& x) {
  RealizationCurves curves;
  curves.t = {0, 1, 2};
  curves.realizations = static_cast<std::uint32_t>(x.size());
  for (double t : curves.t) {
    for (double value : x) curves.values.push_back(value + t);
  }
  return curves;
}

// Inverse logs whose realizations differ by a slow drift: the points of a mean are not independent.
RealizationCurves drifting(std::uint64_t seed, std::uint32_t realizations) {
  const ParameterValues truth = {0.625, 0.045, 0.8, 3};
  RealizationCurves curves;
  curves.t = geometric(1, 4000, 40);
  curves.realizations = realizations;
  RandomStream random = test_stream(seed);
  std::vector<double> drift(realizations, 0.0);
  for (double t : curves.t) {
    for (double& d : drift) {
      d = 0.9 * d + 5e-4 * noise(random);
      curves.values.push_back(InverseLog().value(t, truth.data()) + d);
    }
  }
  return curves;
}

}  // namespace

TEST_CASE("The jackknife of a mean and of its square agree with the reference") {
  const auto json = reference();
  const RealizationCurves curves = shifted_lines(json["x"].get<std::vector<double>>());
  for (int power : {1, 2}) {
    const PowerOfLevel model(power);
    const Fit fitted = std::get<Fit>(fit(model, mean_curve(curves)));
    const ResampledErrors errors = resample(model, curves, fitted, {});
    const double expected = power == 1 ? json["jackknife_se_of_mean"].get<double>()
                                       : json["jackknife_of_mean_squared"]["se"].get<double>();
    CHECK(errors.errors.at(0) == Approx(expected).epsilon(1e-6));
    CHECK(errors.resamples == 10);
    CHECK(errors.failed == 0);
  }
}

TEST_CASE("The bootstrap of a mean tends to its limit") {
  const auto json = reference();
  const RealizationCurves curves = shifted_lines(json["x"].get<std::vector<double>>());
  const PowerOfLevel model(1);
  const Fit fitted = std::get<Fit>(fit(model, mean_curve(curves)));
  const ResampledErrors errors =
      resample(model, curves, fitted, {.kind = Resampling::bootstrap, .count = 4000});
  // A bootstrap of n values tends to (n - 1)/n of the mean's variance.
  const double limit = json["bootstrap_se_of_mean_limit"].get<double>() * std::sqrt(10.0 / 9);
  CHECK(limit == Approx(json["jackknife_se_of_mean"].get<double>()).epsilon(1e-9));
  // The error of an error from n resamples is 1/sqrt(2 n) of it.
  CHECK(std::abs(errors.errors.at(0) - limit) <= 3 * limit / std::sqrt(2 * 4000.0));
  const double mean = json["mean"];
  const double of_68 = half_width(limit, 9), of_95 = half_width(limit, 9, 0.95);
  CHECK(errors.middle.at(0).lower == Approx(mean - of_68).margin(0.1 * limit));
  CHECK(errors.middle.at(0).upper == Approx(mean + of_68).margin(0.1 * limit));
  CHECK(errors.central.at(0).lower == Approx(mean - of_95).margin(0.2 * limit));
}

TEST_CASE("The limits of a bootstrap hold the truth as often as stated, of few realizations too",
          "[statistics]") {
  // A level, of normal realizations: the fit of the law to the mean is the mean.
  const PowerOfLevel model(1);
  constexpr int ensembles = 400;
  for (const std::uint32_t m : {2u, 3u, 4u, 8u}) {
    int held_68 = 0, held_95 = 0;
    double ratio = 0;
    for (std::uint64_t i = 0; i < ensembles; ++i) {
      RandomStream random = test_stream(1000 * m + i);
      std::vector<double> levels;
      for (std::uint32_t r = 0; r < m; ++r) levels.push_back(5 + noise(random));
      const RealizationCurves curves = shifted_lines(levels);
      const Fit fitted = std::get<Fit>(fit(model, mean_curve(curves), {.profiles = false}));
      const ResampledErrors drawn =
          resample(model, curves, fitted, {.kind = Resampling::bootstrap, .count = 400, .seed = i});
      CHECK(drawn.central[0].lower > 0);  // theta is positive
      held_68 += drawn.middle[0].lower <= 5 && 5 <= drawn.middle[0].upper;
      held_95 += drawn.central[0].lower <= 5 && 5 <= drawn.central[0].upper;
      ratio += drawn.errors[0] / resample(model, curves, fitted, {}).errors[0] / ensembles;
    }
    CAPTURE(m, held_68, held_95, ratio);
    CHECK(std::abs(ratio - 1) < 0.03);
    CHECK(held_95 >= 0.90 * ensembles);
    CHECK(held_95 <= 0.995 * ensembles);
    CHECK(held_68 >= 0.58 * ensembles);
    CHECK(held_68 <= 0.85 * ensembles);
  }
}

TEST_CASE("Resampled errors do not depend on the number of threads") {
  const RealizationCurves curves = drifting(1, 12);
  const InverseLog model;
  const Fit fitted = std::get<Fit>(fit(model, mean_curve(curves), {.profiles = false}));
  for (Resampling kind : {Resampling::jackknife, Resampling::bootstrap}) {
    const ResampledErrors single = resample(model, curves, fitted, {.kind = kind, .count = 50});
    for (int threads : {2, 3}) {
      const ResampledErrors larger =
          resample(model, curves, fitted, {.kind = kind, .count = 50, .threads = threads});
      CHECK(larger.errors == single.errors);
    }
  }
}

TEST_CASE("A fixed parameter stays fixed in every resample") {
  const RealizationCurves curves = drifting(2, 8);
  const InverseLog model;
  const Fit fitted =
      std::get<Fit>(fit(model, mean_curve(curves), {.fixed = {{"tau", 3}}, .profiles = false}));
  const ResampledErrors errors = resample(model, curves, fitted, {});
  CHECK(errors.errors.at(3) == 0);
  CHECK(errors.errors.at(2) > 0);
}

TEST_CASE("Where points are correlated, resampling gives the scatter that a fit's errors miss",
          "[statistics]") {
  // The true scatter of X_inf over 200 independent ensembles of 16.
  const InverseLog model;
  std::vector<double> found;
  double naive = 0, jackknife = 0;
  constexpr int ensembles = 200;
  for (int i = 1; i <= ensembles; ++i) {
    const RealizationCurves curves = drifting(static_cast<std::uint64_t>(100 + i), 16);
    const Fit fitted = std::get<Fit>(fit(model, mean_curve(curves), {.profiles = false}));
    found.push_back(fitted.estimates[0].value);
    naive += fitted.estimates[0].standard_error / ensembles;
    jackknife += resample(model, curves, fitted, {}).errors[0] / ensembles;
  }
  double mean = 0, square = 0;
  for (double x : found) mean += x / ensembles;
  for (double x : found) square += (x - mean) * (x - mean);
  const double scatter = std::sqrt(square / (ensembles - 1));
  // Scatter is known to 1/sqrt(2 * 200) = 5 %; the jackknife of 16 runs a few per cent high.
  CHECK(jackknife / scatter > 0.8);
  CHECK(jackknife / scatter < 1.3);
  CHECK(naive < 0.7 * scatter);
}

}  // namespace jostle
