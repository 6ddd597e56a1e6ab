#include "engine/monte_carlo/state.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "engine/monte_carlo/monte_carlo.hpp"
#include "engine/starts/starts.hpp"

using namespace jostle;

namespace {

const MonteCarloState some_state{.tapping = true,
                                 .progress = {DynamicsStatus::capped, 1, 2, true, 0.5, 3},
                                 .move = {4, 0.25, 5, 6, 7},
                                 .sampler = {true, 8, 9, 10, 11, 0.125},
                                 .dropped_offsets = 12,
                                 .stop_window = {1.5, 2.5}};

}  // namespace

TEST_CASE("A state of Monte Carlo comes back from its bytes") {
  CHECK(monte_carlo_state(bytes_of(some_state)) == some_state);
  CHECK(monte_carlo_state(bytes_of({})) == MonteCarloState{});
}

TEST_CASE("A state of a mixture keeps the heights of its kinds") {
  MonteCarloState state = some_state;
  state.progress.kind_heights = {1.25, 7.5};
  const std::vector<std::byte> whole = bytes_of(state);
  CHECK(monte_carlo_state(whole) == state);
  for (std::size_t n = 0; n < whole.size(); ++n)
    CHECK_THROWS_AS(monte_carlo_state(std::span(whole).first(n)), StateError);
  auto longer = whole;
  longer.push_back(std::byte{0});
  CHECK_THROWS_AS(monte_carlo_state(longer), StateError);
  state.progress.kind_heights[1] = std::numeric_limits<double>::infinity();
  CHECK_THROWS_AS(monte_carlo_state(bytes_of(state)), StateError);
}

TEST_CASE("Bytes of another version, of another length or of no state are refused") {
  const std::vector<std::byte> whole = bytes_of(some_state);
  for (std::size_t n = 0; n < whole.size(); ++n) {
    CHECK_THROWS_AS(monte_carlo_state(std::span(whole).first(n)), StateError);
  }
  auto longer = whole;
  longer.push_back(std::byte{0});
  CHECK_THROWS_AS(monte_carlo_state(longer), StateError);
  auto other_version = whole;
  other_version[0] ^= std::byte{1};
  CHECK_THROWS_WITH(
      monte_carlo_state(other_version),
      Catch::Contains("another version") && Catch::Contains("resume with the version"));
  auto no_flag = whole;
  no_flag[4] = std::byte{2};
  CHECK_THROWS_AS(monte_carlo_state(no_flag), StateError);
}

TEST_CASE("A state from which no trial can be made is refused") {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  for (const double step : {none, -1.0, std::numeric_limits<double>::infinity()}) {
    MonteCarloState state = some_state;
    state.move.step = step;
    CHECK_THROWS_AS(monte_carlo_state(bytes_of(state)), StateError);
    state = some_state;
    state.sampler.reference_step = step;
    CHECK_THROWS_AS(monte_carlo_state(bytes_of(state)), StateError);
  }
  for (const HeightWindow window : {HeightWindow{2, 1}, HeightWindow{none, 1}}) {
    MonteCarloState state = some_state;
    state.stop_window = window;
    CHECK_THROWS_AS(monte_carlo_state(bytes_of(state)), StateError);
  }
}

TEST_CASE("At rest a state holds nothing of the relaxation that ended") {
  const MonteCarlo settings{.relax = {.move = PolarMove{}, .stop = {SweepsStop{30}}}};
  const auto dynamics = make_dynamics(settings, {StreamKey{1}, StreamKey{2}});
  RandomStream start_random(StreamKey{3}), tap_random(StreamKey{4});
  const Start start = SteepestDescentPour{};
  dynamics->load(make_start(start, PeriodicBox{4, 4}, 60, start_random));
  dynamics->settle(start);
  CHECK(dynamics->advance(1'000'000) == DynamicsStatus::settled);  // a pour is at rest as it is
  CHECK(dynamics->effort().units == 0);
  CHECK(dynamics->diagnostics().size() == columns(settings).size());

  dynamics->tap(Shake{.lambda = 0.05, .lateral_radius = 0.3, .retries = 0}, tap_random);
  CHECK(dynamics->advance(600) == DynamicsStatus::running);
  const MonteCarloState moving = monte_carlo_state(dynamics->save());
  CHECK(moving.tapping);
  CHECK(moving.progress.trials == 600);
  CHECK(moving.dropped_offsets > 0);
  CHECK(dynamics->advance(1'000'000) == DynamicsStatus::settled);
  CHECK(dynamics->effort().units == 1800);
  const MonteCarloState at_rest = monte_carlo_state(dynamics->save());
  CHECK(at_rest.progress == RelaxationProgress{.status = DynamicsStatus::settled});
  CHECK(at_rest.dropped_offsets == 0);
  CHECK(at_rest.move.next_trial == 1800);
}
