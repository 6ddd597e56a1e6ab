#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>

#include "fitting/fit.hpp"
#include "fitting/models/models.hpp"
#include "tests/fitting/noise.hpp"

// Intervals of a law that misses the curve: they hold the parameters of the law that is nearest to
// the curve without noise. Errors of J^T J alone are then too short, by up to a factor of 3.
namespace jostle {
namespace {

const ParameterValues& true_law() {
  static const ParameterValues values = {0.64, 0.06, 1.0, 20};
  return values;
}

// [n, n_realizations] about an inverse log, each with a level of its own and AR(1) noise of 0.7.
Curve ensemble(int n_realizations, double noise_size, int number) {
  const InverseLog law;
  Noise noise(static_cast<std::uint64_t>(number));
  const std::vector<double> t = geometric(1, 1e4, 45);
  std::vector<double> memory, levels, values;
  for (int r = 0; r < n_realizations; ++r) {
    memory.push_back(noise());
    levels.push_back(2 * noise_size * noise());
  }
  for (const double time : t) {
    for (std::size_t r = 0; r < memory.size(); ++r) {
      values.push_back(law.value(time, true_law().data()) + levels[r] + noise_size * memory[r]);
      memory[r] = 0.7 * memory[r] + std::sqrt(1 - 0.7 * 0.7) * noise();
    }
  }
  return mean_curve(t, std::move(values), memory.size());
}

ParameterValues nearest(const Model& model) {
  const InverseLog law;
  Curve curve{.t = geometric(1, 1e4, 45), .x = {}, .sigma = {}};
  for (const double t : curve.t) curve.x.push_back(law.value(t, true_law().data()));
  return std::get<Fit>(fit(model, curve, {.profiles = false})).values();
}

struct Coverage {
  int examined = 0, covered[2] = {0, 0};
};

void check(const char* name, int n_realizations, double noise_size, int ensembles) {
  const auto model = make_model(name);
  const ParameterValues truth = nearest(*model);
  Coverage found;
  for (int number = 1; number <= ensembles; ++number) {
    const Fit fitted = std::get<Fit>(fit(*model, ensemble(n_realizations, noise_size, number)));
    for (std::size_t j = 0; j < truth.size(); ++j) {
      ++found.examined;
      for (int level = 0; level < 2; ++level) {
        const Interval& interval = fitted.estimates[j].intervals[level];
        found.covered[level] += interval.lower <= truth[j] && truth[j] <= interval.upper;
      }
    }
  }
  const double coverage = 1.0 * found.covered[0] / found.examined;
  const double two = 1.0 * found.covered[1] / found.examined;
  std::printf("%-18s M %2d  noise %6.4f  68 %%: %5.1f  95 %%: %5.1f\n", name, n_realizations,
              noise_size, 100 * coverage, 100 * two);
  INFO(name << ", " << n_realizations << " realizations, noise " << noise_size);
  const auto margin = [&](double rate) { return 3 * std::sqrt(rate * (1 - rate) / ensembles); };
  CHECK(coverage >= 0.60 - margin(0.60));
  CHECK(coverage <= 0.78 + margin(0.78));
  CHECK(two >= 0.90 - margin(0.90));
  CHECK(two <= 0.99 + margin(0.99));
}

}  // namespace

TEST_CASE("A law that misses the curve: intervals hold the law nearest to it", "[statistics]") {
  check("kww", 5, 2.5e-4, 60);
}

TEST_CASE("Two exponentials that miss the curve: intervals hold those nearest to it", "[slow]") {
  check("two_exponentials", 5, 2.5e-4, 60);
}

TEST_CASE("A law that misses the curve: every number of realizations", "[nightly]") {
  for (const char* name : {"two_exponentials", "kww", "inverse_log"})
    for (const int n_realizations : {3, 5, 10, 20})
      for (const double noise : {1e-4, 2.5e-4, 1e-3}) check(name, n_realizations, noise, 200);
}

}  // namespace jostle
