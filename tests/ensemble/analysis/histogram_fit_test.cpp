#include "ensemble/analysis/histogram_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "ensemble/moments.hpp"
#include "ensemble/statistics/jackknife.hpp"
#include "fitting/models/models.hpp"
#include "tests/ensemble/noise.hpp"

namespace jostle {
namespace {

/// Samples of a law of known parameters, of the size that users have, counted in bins.
struct Sample {
  std::string name;
  std::unique_ptr<Model> law;
  std::vector<double> truth;
  std::size_t parameter;  // the one looked at
  std::vector<Bin> bins;
  std::function<void(RandomStream&, std::vector<double>& counts)> packing;  // adds to [n_bins]
};

double exponential(RandomStream& random) {
  return -std::log1p(-random.uniform());
}

// The large pores of a packing of 9000: about 900 above v = 0.15, in bins of 0.02 in xi.
// `draw`: their volumes beyond 0.15, in v0.
Sample pore_sample(double v0, const std::function<double(RandomStream&)>& draw, int n_pooled = 1) {
  constexpr double width = 0.02;
  constexpr std::size_t first = 27;  // its middle is the first above 0.15^(1/3)
  const double low = std::pow(first * width, 3);
  Sample sample{"pore tail, v0", make_model("pore_tail"), {0, v0}, 1, {}, {}};
  for (std::size_t k = first; k < 75; ++k) {
    sample.bins.push_back({std::pow(k * width, 3), std::pow((k + 1) * width, 3)});
  }
  sample.packing = [=](RandomStream& random, std::vector<double>& counts) {
    const int n = static_cast<int>((900 + 30 * noise(random)) / n_pooled);
    for (int i = 0; i < n; ++i) {
      const double v = low + v0 * draw(random);
      const auto k = static_cast<std::size_t>(std::cbrt(v) / width);
      if (k < 75) counts[k - first] += n_pooled;
    }
  };
  return sample;
}

// Faces of 1500 cells of a region, a discrete normal law.
Sample face_sample(std::size_t parameter) {
  const std::vector<double> truth = {1, 14.3, 1.4};
  Sample sample{parameter == 1 ? "faces, mean" : "faces, width",
                make_model("normal"),
                truth,
                parameter,
                {},
                {}};
  std::vector<double> up_to;
  for (int k = 0; k < 40; ++k) {
    sample.bins.push_back({static_cast<double>(k), static_cast<double>(k)});
    up_to.push_back((k > 0 ? up_to.back() : 0) + Normal().value(k, truth.data()));
  }
  sample.packing = [up_to](RandomStream& random, std::vector<double>& counts) {
    for (int i = 0; i < 1500; ++i) {
      const auto found = std::ranges::lower_bound(up_to, up_to.back() * random.uniform());
      counts[static_cast<std::size_t>(found - up_to.begin())] += 1;
    }
  };
  return sample;
}

// Free volumes of 1500 cells above the least, in bins of 0.02 of which the first is cut.
Sample cell_sample() {
  Sample sample{"cells, k", make_model("k_gamma"), {1, 0.4, 14}, 2, {}, {}};
  const auto low = [](std::size_t k) {
    return std::max(0.0, 0.02 * static_cast<double>(k) - 0.013);
  };
  for (std::size_t k = 0; k < 90; ++k) sample.bins.push_back({low(k), low(k + 1)});
  sample.packing = [](RandomStream& random, std::vector<double>& counts) {
    for (int i = 0; i < 1500; ++i) {
      double t = 0;
      for (int j = 0; j < 14; ++j) t += 0.4 / 14 * exponential(random);
      const auto k = static_cast<std::size_t>((t + 0.013) / 0.02);
      if (k < counts.size()) counts[k] += 1;
    }
  };
  return sample;
}

Histogram draw(const Sample& sample, std::uint32_t realizations, std::uint64_t seed) {
  RandomStream random = test_stream(seed);
  Histogram histogram{.bins = sample.bins, .counts = {}, .realizations = realizations};
  const std::size_t n = sample.bins.size();
  histogram.counts.assign(n * realizations, 0);
  for (std::uint32_t r = 0; r < realizations; ++r) {
    std::vector<double> counts(n, 0.0);
    sample.packing(random, counts);
    for (std::size_t k = 0; k < n; ++k) histogram.counts[k * realizations + r] = counts[k];
  }
  return histogram;
}

// Least squares at the middles of bins, weighted by the roots of what was counted: what this
// replaces.
double least_squares(const Sample& sample, const Histogram& histogram) {
  Curve curve;
  for (std::size_t k = 0; k < histogram.bins.size(); ++k) {
    const auto [low, high] = histogram.bins[k];
    const double width = high > low ? high - low : 1;
    double sum = 0;
    for (std::uint32_t r = 0; r < histogram.realizations; ++r) {
      sum += histogram.counts[k * histogram.realizations + r];
    }
    curve.t.push_back(0.5 * (low + high));
    curve.x.push_back(sum / width);
    curve.sigma.push_back(std::sqrt(std::max(sum, 1.0)) / width);
  }
  return std::get<Fit>(fit(*sample.law, curve, {.profiles = false})).values()[sample.parameter];
}

struct Calibration {
  Moments moments_before, moments_after;
  int held_68 = 0, held_95 = 0, refuted_5 = 0, refuted_1 = 0;
};

Calibration calibrate(const Sample& sample, std::uint32_t realizations, int ensembles,
                      std::uint64_t first_seed, bool with_before = true) {
  Calibration found;
  const double truth = sample.truth[sample.parameter];
  for (int e = 0; e < ensembles; ++e) {
    const Histogram histogram =
        draw(sample, realizations, first_seed + static_cast<std::uint64_t>(e));
    const HistogramFit fit = fit_histogram(*sample.law, histogram);
    INFO(sample.name << ", " << realizations << " realizations: " << fit.status);
    REQUIRE(std::isfinite(fit.values[sample.parameter]));
    found.moments_after.add(fit.values[sample.parameter]);
    if (with_before) found.moments_before.add(least_squares(sample, histogram));
    found.refuted_5 += fit.p < 0.05;
    found.refuted_1 += fit.p < 0.01;
    if (realizations < 2) continue;
    const double deviation = std::abs(fit.values[sample.parameter] - truth);
    const double error = fit.errors[sample.parameter];
    found.held_68 += deviation <= student_half_width(error, realizations);
    found.held_95 += deviation <= student_half_width(error, realizations, 0.95);
  }
  return found;
}

std::string row(const Sample& sample, std::uint32_t m, int n, const Calibration& found) {
  const double truth = sample.truth[sample.parameter];
  const auto percent = [&](int count) { return 100.0 * count / n; };
  const auto bias = [&](const Moments& moments) { return 100 * (moments.mean() / truth - 1); };
  return fmt::format("{:16} {:3} {:10.2f} {:10.2f} +- {:.2f} {:7.1f} {:6.1f} {:7.1f} {:6.1f}\n",
                     sample.name, m, bias(found.moments_before), bias(found.moments_after),
                     100 * found.moments_after.standard_error() / truth, percent(found.held_68),
                     percent(found.held_95), percent(found.refuted_5), percent(found.refuted_1));
}

constexpr const char* heading =
    "\nlaw                M   before, %    after, %           68 %   95 %  p<0.05 p<0.01\n";

// Tests if `count` of n agrees with a probability, by three binomial errors.
bool agrees(int count, int n, double chance) {
  return std::abs(count - n * chance) <= 3 * std::sqrt(n * chance * (1 - chance));
}

std::array<Sample, 4> all_samples() {
  return {pore_sample(0.09, exponential), face_sample(1), face_sample(2), cell_sample()};
}

void check_calibration(std::uint32_t m, int n, std::uint64_t seed, std::string& table) {
  for (const Sample& sample : all_samples()) {
    const Calibration found = calibrate(sample, m, n, seed);
    table += row(sample, m, n, found);
    CAPTURE(sample.name, m);
    const double truth = sample.truth[sample.parameter];
    // k of few cells is itself biased by about 3 k / n, 0.2 % of 1500 cells.
    const double own_bias =
        sample.parameter == 2 && sample.law->name() == "k_gamma" ? 3 * truth / (1500.0 * m) : 0;
    CHECK(std::abs(found.moments_after.mean() - truth - own_bias) <=
          3 * found.moments_after.standard_error());
    CHECK(agrees(found.refuted_5, n, 0.05));
    if (m < 2) continue;
    CHECK(agrees(found.held_68, n, interval_levels[0]));
    CHECK(agrees(found.held_95, n, interval_levels[1]));
  }
}

}  // namespace

TEST_CASE("Laws fitted to counts are unbiased and their intervals hold the truth", "[statistics]") {
  std::string table = heading;
  check_calibration(1, 100, 1000, table);
  WARN(table);
}

TEST_CASE(
    "Laws fitted to counts of four realizations are unbiased and their intervals hold the truth",
    "[slow]") {
  std::string table = heading;
  check_calibration(4, 100, 4000, table);
  WARN(table);
}

TEST_CASE("Laws fitted to counts are unbiased at every number of realizations", "[nightly]") {
  std::string table = heading;
  for (const std::uint32_t m : {1u, 2u, 3u, 4u, 10u}) {
    check_calibration(m, 400, 100'000 * m, table);
  }
  WARN(table);
}

TEST_CASE("Pores that come together widen the errors and refute no law", "[statistics]") {
  const Sample sample = pore_sample(0.09, exponential, 3);
  constexpr int n = 200;
  std::string table = heading;
  for (const std::uint32_t m : {2u, 4u}) {
    const Calibration found = calibrate(sample, m, n, 7000 * m, false);
    table += row(sample, m, n, found);
    CAPTURE(m);
    CHECK(agrees(found.held_95, n, 0.95));
    CHECK(agrees(found.refuted_5, n, 0.05));
  }
  WARN(table);
}

TEST_CASE("A tail that is not exponential is refuted", "[statistics]") {
  // A Weibull tail of shape 0.7: ln rho_v bends upwards.
  const Sample sample = pore_sample(
      0.09, [](RandomStream& random) { return std::pow(exponential(random), 1 / 0.7); });
  constexpr int n = 50;
  for (const std::uint32_t m : {1u, 4u}) {
    const Calibration found = calibrate(sample, m, n, 9000 * m, false);
    CAPTURE(m, found.refuted_1);
    CHECK(found.refuted_1 >= n - 2);
  }
  const HistogramFit fitted = fit_histogram(*sample.law, draw(sample, 4, 1));
  CHECK(fitted.status.find(" does not hold: F test over") != std::string::npos);
}

TEST_CASE("Counts that limit no law give none, with a reason") {
  const Sample sample = pore_sample(0.09, exponential);
  Histogram flat{.bins = sample.bins, .counts = {}, .realizations = 1};
  for (const Bin& bin : flat.bins) flat.counts.push_back(1000 * (bin.high - bin.low));
  const HistogramFit fit = fit_histogram(*sample.law, flat);
  CHECK(std::isnan(fit.values[1]));
  CHECK(fit.status == "the data do not limit v0");
  flat.counts.assign(flat.bins.size(), 0);
  CHECK(fit_histogram(*sample.law, flat).status == "too few places that hold anything");
  flat.realizations = 0;
  CHECK(fit_histogram(*sample.law, flat).status == "no packing");
}

}  // namespace jostle
