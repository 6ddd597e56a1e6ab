#include <catch2/catch.hpp>

#include "ensemble/realization.hpp"
#include "tests/monte_carlo_plan.hpp"
#include "tests/two_samples.hpp"

using namespace jostle;

namespace {

constexpr std::uint32_t realizations = 200;

// Columns of the last tap, [column][realization]: sweeps, acceptance, then the observables.
std::vector<std::vector<double>> last_taps(const Plan& plan) {
  std::vector<std::vector<double>> columns(2 + plan.observables.size());
  for (std::uint32_t index = 0; index < realizations; ++index) {
    Realization realization(plan, index);
    TapRow last;
    while (!realization.finished()) {
      if (Slice slice = realization.advance(1'000'000); slice.row) last = std::move(*slice.row);
    }
    columns[0].push_back(diagnostic(last, "sweeps"));
    columns[1].push_back(diagnostic(last, "acceptance"));
    for (std::size_t k = 0; k < last.observables.size(); ++k) {
      columns[2 + k].push_back(last.observables[k]);
    }
  }
  return columns;
}

// Other seeds: the two samples share nothing.
void check_samplers(Plan plan) {
  plan.n_spheres = 80;
  plan.start = SteepestDescentPour{};
  monte_carlo(plan).relax.stop = {.rule = MeanHeightStop{.eta = 3e-5, .every_sweeps = 100}};
  plan.observables = {MeanHeight{}, BottomFraction{}, CorrectedFraction{},
                      BulkFraction{.window = HeightWindow{1.5, 3}}};
  plan.seed = 81;
  const auto exhaustive = last_taps(plan);
  plan.seed = 82;
  monte_carlo(plan).relax.sampler = Sampler::rejection_free;
  const auto skipping = last_taps(plan);
  const char* const names[] = {"sweeps", "acceptance", "<Z>", "Phi_b", "<Phi_c>", "bulk"};
  for (std::size_t k = 0; k < exhaustive.size(); ++k) {
    check_same_law(names[k], exhaustive[k], skipping[k]);
  }
}

}  // namespace

TEST_CASE("realizations of both samplers have one law: polar, periodic", "[statistics]") {
  Plan plan;
  plan.container = PeriodicBox{4, 4};
  plan.protocol = {{Dilate{.epsilon = 0.03}, 2}};
  check_samplers(plan);
}

TEST_CASE("realizations of both samplers have one law: Metropolis, walls", "[statistics]") {
  Plan plan;
  plan.container = WalledBox{4.5, 4.5};
  plan.protocol = {{Lift{.gamma = 0.25}, 2}};
  monte_carlo(plan).relax.move = MetropolisMove{};
  check_samplers(plan);
}

TEST_CASE("realizations of both samplers have one law: polar, cylinder", "[statistics]") {
  Plan plan;
  plan.container = Cylinder{5};
  plan.protocol = {{Dilate{.epsilon = 0.03}, 2}};
  check_samplers(plan);
}
