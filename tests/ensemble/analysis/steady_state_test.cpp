#include "ensemble/analysis/steady_state.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "tests/ensemble/synthetic_series.hpp"
#include "tests/test_files.hpp"

using namespace jostle;

namespace {

constexpr double rho = 0.9;

double exact_sigma() {
  return 1 / std::sqrt(1 - rho * rho);
}

// The variance of the mean of n taps, all pairs counted.
double exact_error(std::size_t n_taps) {
  const auto n = static_cast<double>(n_taps);
  const double pairs = rho / (1 - rho) - rho * (1 - std::pow(rho, n)) / (n * (1 - rho) * (1 - rho));
  return exact_sigma() * std::sqrt((1 + 2 * pairs) / n);
}

std::vector<double> numbers_of(const std::string& name) {
  std::ifstream file(test_data(name));
  std::vector<double> numbers;
  for (double number = 0; file >> number;) numbers.push_back(number);
  return numbers;
}

BlockingResult blocked(const std::vector<double>& series) {
  Blocking blocking;
  blocking.add(series);
  return blocking.result();
}

SteadyState steady_state(const std::vector<std::vector<double>>& ensemble) {
  SteadyStateTest test;
  for (const auto& series : ensemble) test.add(series);
  return test.result();
}

}  // namespace

TEST_CASE("Series that alternate have the time of AR(1), about means as about lines") {
  for (const double negative : {-0.3, -0.5, -0.7, -0.9, -0.98}) {
    Autocorrelation about_means(Removed::mean), about_lines(Removed::line);
    for (std::uint64_t r = 0; r < 6; ++r) {
      const auto series = synthetic::autoregressive(negative, 1000, 20261127, r);
      about_means.add(series);
      about_lines.add(series);
    }
    const double time = 0.5 * (1 + negative) / (1 - negative);
    const AutocorrelationTime by_mean = about_means.result(), by_line = about_lines.result();
    CAPTURE(negative, time, by_mean.time, by_mean.error, by_line.time, by_line.error);
    CHECK(std::abs(by_mean.time - time) < 3 * by_mean.error);
    CHECK(std::abs(by_line.time - time) < 3 * by_line.error);
    CHECK(std::abs(by_line.time - by_mean.time) < 0.2 * by_mean.error);
    CHECK(by_mean.error < 0.15 * time);
  }
}

TEST_CASE("A constant series is steady, in words without a number") {
  for (const std::size_t realizations : {1, 2, 5}) {
    const SteadyState state = steady_state({realizations, std::vector<double>(130, 0.1)});
    CHECK(state.verdict() == Verdict::reached);
    CHECK(state.statement() == "reached: no drift: the series is constant");
    CHECK(state.detectable() == 0);
  }
}

TEST_CASE("Blocking agrees with pyblock, and reports a series without a plateau") {
  const std::vector<double> series = numbers_of("stats/pyblock_data_1D.dat");
  REQUIRE(series.size() == 1024);
  std::ifstream file(test_data("stats/pyblock_reference.json"));
  const auto reference = nlohmann::json::parse(file);
  const BlockingResult result = blocked(series);
  REQUIRE(result.levels.size() == reference.at("rows").size());
  for (std::size_t i = 0; i < result.levels.size(); ++i) {
    const auto& row = reference.at("rows")[i];
    const BlockingLevel& level = result.levels[i];
    CHECK(level.n_blocks == row[0].get<std::size_t>());
    CHECK(level.block_length * level.n_blocks == 1024);
    CHECK(level.variance == Approx(row[1].get<double>()).epsilon(1e-12));
    CHECK(level.error == Approx(row[2].get<double>()).epsilon(1e-12));
    CHECK(level.error_error == Approx(row[3].get<double>()).epsilon(1e-12));
  }
  CHECK_FALSE(result.plateau);
  CHECK(result.error() == Approx(0.229525649398702).epsilon(1e-12));
  const SteadyState state = steady_state({series});
  CHECK(state.value == Approx(reference.at("mean").get<double>()).epsilon(1e-13));
  CHECK(state.verdict() == Verdict::cannot_decide);
}

TEST_CASE("Series of odd length lose their last value, no series has levels it cannot have") {
  const BlockingResult result = blocked({1, 2, 4, 7, 100});
  REQUIRE(result.levels.size() == 2);
  CHECK(result.levels[1].error == Approx(2).epsilon(1e-14));  // error of the values 1.5 and 5.5
  CHECK(std::isnan(blocked({1}).error()));
  const BlockingResult constant = blocked(std::vector<double>(64, 0.1));
  CHECK(constant.plateau == std::size_t{0});
  CHECK(constant.error() == 0);
}

TEST_CASE("The stored AR(1) series has the exact error and autocorrelation time") {
  const std::vector<double> series = numbers_of("psd/ar1_rho0.9_N4096.dat");
  std::ifstream file(test_data("psd/power_law_and_ar1.json"));
  const auto exact = nlohmann::json::parse(file).at("AR1");
  CHECK(exact_error(4096) ==
        Approx(exact.at("exact_se_of_mean").at("4096").get<double>()).epsilon(1e-12));
  const SteadyState state = steady_state({series});
  REQUIRE(state.blocking.plateau);
  const BlockingLevel& plateau = state.blocking.levels[*state.blocking.plateau];
  CHECK(std::abs(state.error.error - exact_error(4096)) < 3 * plateau.error_error);
  CHECK(std::abs(state.value) < 3 * exact_error(4096));
  const double time = 0.5 * exact.at("g_stat_ineff").get<double>();
  REQUIRE(state.autocorrelation.found());
  CHECK(std::abs(state.autocorrelation.time - time) < 3 * state.autocorrelation.error);
  CHECK(std::abs(state.sigma - exact_sigma()) < 3 * state.sigma_error.error);
  CHECK(state.verdict() == Verdict::reached);
}

namespace {

void check_errors(std::size_t realizations) {
  constexpr std::size_t n_taps = 4000, ensembles = 400;
  Moments values, errors, times, time_errors, sigmas, sigma_errors, plateaus;
  std::size_t drifting = 0;
  for (std::size_t e = 0; e < ensembles; ++e) {
    SteadyStateTest test;
    for (std::size_t r = 0; r < realizations; ++r) {
      test.add(synthetic::autoregressive(rho, n_taps, 100 + e, r));
    }
    const SteadyState state = test.result();
    values.add(state.value);
    errors.add(state.error.error * state.error.error);
    times.add(state.autocorrelation.time);
    time_errors.add(state.autocorrelation.error);
    sigmas.add(state.sigma);
    sigma_errors.add(state.sigma_error.error);
    if (state.blocking.plateau) plateaus.add(state.blocking.error());
    drifting += state.verdict() == Verdict::not_reached;
  }
  CAPTURE(realizations, times.mean(), time_errors.mean(), times.sigma(), sigmas.mean(), drifting);
  const double error = exact_error(n_taps) / std::sqrt(static_cast<double>(realizations));
  // 3 errors of a deviation of `ensembles` Gaussian values, and 3 % for blocks that share a little.
  const double spread = 3 / std::sqrt(2.0 * ensembles);
  CHECK(values.sigma() == Approx(error).epsilon(spread));
  CHECK(std::sqrt(errors.mean()) == Approx(error).epsilon(spread + 0.03));
  CHECK(plateaus.count() > 0.9 * ensembles);
  CHECK(plateaus.mean() == Approx(error).epsilon(0.05));
  // The sum ends at 6 times: what is left out is below 1 %.
  CHECK(times.mean() == Approx(9.5).epsilon(0.01).margin(3 * times.standard_error()));
  CHECK(time_errors.mean() == Approx(times.sigma()).epsilon(spread + 0.05));
  CHECK(sigmas.mean() == Approx(exact_sigma()).epsilon(0.002).margin(3 * sigmas.standard_error()));
  CHECK(sigma_errors.mean() == Approx(sigmas.sigma()).epsilon(spread + 0.05));
  // 3 deviations of 400 ensembles.
  CHECK(drifting <= Trend::level * ensembles + 3 * std::sqrt(Trend::level * ensembles));
}

}  // namespace

TEST_CASE("Errors of a steady state are what such states scatter by", "[statistics]") {
  check_errors(1);
}

TEST_CASE("Errors of steady states of ten realizations are what they scatter by", "[slow]") {
  check_errors(10);
}

TEST_CASE("Drift, a late step and a long memory are not a steady state") {
  const auto add_step = [](std::vector<double> series) {
    for (std::size_t i = series.size() * 3 / 4; i < series.size(); ++i) series[i] += 2;
    return series;
  };
  std::vector<std::vector<double>> drifting, stepping, slow;
  for (std::uint64_t r = 0; r < 10; ++r) {
    const std::vector<double> steady = synthetic::autoregressive(0.5, 1000, 31, r);
    drifting.push_back(synthetic::with_ramp(steady, 1));
    stepping.push_back(add_step(steady));
    slow.push_back(synthetic::autoregressive(0.99, 1000, 32, r));
  }
  CHECK(steady_state(drifting).statement().starts_with("not reached: it drifts: "));
  const SteadyState single = steady_state({synthetic::with_ramp(drifting[0], 4)});
  CHECK(single.verdict() == Verdict::not_reached);
  CHECK(steady_state(stepping).verdict() == Verdict::not_reached);
  const SteadyState undecided = steady_state(slow);
  CHECK(undecided.verdict() == Verdict::cannot_decide);
  CHECK(undecided.statement().find(
            "1000 taps are too few to estimate the autocorrelation time (") != std::string::npos);
}

TEST_CASE("A steady state names the drift that would have refuted it") {
  std::vector<std::vector<double>> ensemble;
  for (std::uint64_t r = 0; r < 3; ++r)
    ensemble.push_back(synthetic::autoregressive(0.5, 2000, 33, r));
  const SteadyState reached = steady_state(ensemble);
  CHECK(reached.verdict() == Verdict::reached);
  CHECK(reached.detectable() < 1);
  CHECK(reached.statement().find("; the test finds drifts of ") != std::string::npos);
  CHECK(reached.statement().find(" or more over the taps (80 % power), ") != std::string::npos);
  // The memory of one realization may be longer than it shows.
  CHECK(steady_state({ensemble.front()})
            .trend.power()
            .find("(80 % power, unless memory is underestimated), ") != std::string::npos);
  for (auto& series : ensemble) series.resize(150);
  const SteadyState undecided = steady_state(ensemble);
  CHECK(undecided.verdict() == Verdict::cannot_decide);
  CHECK(undecided.detectable() > 1);
  CHECK(undecided.statement().starts_with("cannot decide with 3 realizations: no drift found"));
  CHECK(undecided.statement().find(", but the test finds only drifts of ") != std::string::npos);
  // One of that size is found.
  for (auto& series : ensemble) {
    series = synthetic::with_ramp(series, 2 * undecided.trend.detectable);
  }
  CHECK(steady_state(ensemble).verdict() == Verdict::not_reached);
}

TEST_CASE("The unbiased time of AR(1) has an error, however short its series are") {
  std::size_t found = 0, within_3 = 0;
  for (std::uint64_t e = 0; e < 200; ++e) {
    for (const double time : {5.0, 25.0, 60.0}) {
      Autocorrelation autocorrelation(Removed::line);
      for (std::uint64_t r = 0; r < 4; ++r) {
        autocorrelation.add(
            synthetic::autoregressive((2 * time - 1) / (2 * time + 1), 100, 81000 + e, r));
      }
      const AutocorrelationTime unbiased = autocorrelation.unbiased();
      if (!unbiased.found()) continue;
      CHECK(unbiased.error > 0);
      if (time > 5) continue;
      ++found;
      within_3 += std::abs(unbiased.time - time) < 3 * unbiased.error;
    }
  }
  CHECK(found >= 190);
  CHECK(within_3 >= 0.9 * static_cast<double>(found));
}

TEST_CASE("Realizations that keep to themselves have a larger error than blocking sees") {
  std::vector<std::vector<double>> ensemble;
  synthetic::Gaussian level(41);
  for (std::uint64_t r = 0; r < 20; ++r) {
    std::vector<double> series = synthetic::autoregressive(0.5, 1000, 42, r);
    const double own = 3 * level();
    for (double& value : series) value += own;
    ensemble.push_back(series);
  }
  const SteadyState state = steady_state(ensemble);
  CHECK(state.error.error > 5 * state.blocking.error());
  CHECK(state.verdict() == Verdict::reached);
}

TEST_CASE("One realization has no error that its blocks refute: a slow memory beside a fast one") {
  int refuted = 0;
  for (std::uint64_t e = 0; e < 5; ++e) {
    const std::vector<double> fast = synthetic::autoregressive(0.7, 1000, 51 + e);
    CHECK(steady_state({fast}).error.known());
    std::vector<double> mixed = fast;
    for (std::size_t t = 0; t < mixed.size(); ++t)
      mixed[t] += 4 * std::sin(2 * std::numbers::pi * static_cast<double>(t) / 600);
    const SteadyState state = steady_state({mixed});
    CHECK(state.verdict() != Verdict::reached);
    if (state.error.known()) continue;
    ++refuted;
    CHECK(state.error.error >= state.blocking.error());
  }
  CHECK(refuted >= 4);
}
