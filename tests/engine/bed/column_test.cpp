#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "engine/monte_carlo/trial_loop.hpp"
#include "tests/engine/sample_packings.hpp"

using namespace jostle;

namespace {

struct Estimate {
  double value, error;
};

// Time average of <Z> and its error from independent runs.
Estimate mean_height_at_rest(const Container& container, std::uint32_t n, double alpha, double step,
                             std::uint64_t sweeps, std::uint64_t seed) {
  constexpr int runs = 16;
  double sum = 0, squares = 0;
  for (int run = 0; run < runs; ++run) {
    const double height = 1 + 2.5 * n / footprint_area(container);
    Packing packing = random_packing(container, n, height, seed + static_cast<std::uint64_t>(run));
    const auto loop =
        make_trial_loop(container, MetropolisMove{step, alpha},
                        stream_key(seed, 0, static_cast<std::uint64_t>(run), Purpose::trials));
    loop->load(packing);
    loop->run(n * sweeps / 5);
    double heights = 0;
    std::uint64_t samples = 0;
    for (std::uint64_t sweep = 0; sweep < sweeps; sweep += 2) {
      loop->run(2 * n);
      heights += loop->mean_height();
      ++samples;
    }
    const double mean = heights / static_cast<double>(samples);
    sum += mean;
    squares += mean * mean;
  }
  const double mean = sum / runs;
  return {mean, std::sqrt((squares / runs - mean * mean) / (runs - 1))};
}

}  // namespace

TEST_CASE("hard spheres under gravity settle to the heights of an independent Monte Carlo",
          "[statistics]") {
  // tests/data/col_a.json, col_d.json (mean height above floor contact, its error).
  struct Row {
    double width;
    std::uint32_t n;
    double alpha, step, reference, error;
    std::uint64_t sweeps;
  };
  const auto row = GENERATE(Row{4, 64, 1, 0.35, 3.25460, 0.00203, 15'000},
                            Row{5, 50, 3, 0.25, 1.18663, 0.00056, 6'000});
  const Estimate own = mean_height_at_rest(PeriodicBox{row.width, row.width}, row.n, row.alpha,
                                           row.step, row.sweeps, 1905);
  const double above_contact = own.value - sphere_radius;
  WARN("alpha " << row.alpha << ": <Z> above contact " << above_contact << " +- " << own.error
                << ", reference " << row.reference << " +- " << row.error);
  CHECK(own.error <= std::max(row.error, 0.003 * row.reference));
  CHECK(std::abs(above_contact - row.reference) <= 3 * std::hypot(own.error, row.error));
}

TEST_CASE("one sphere obeys the barometric law in every container", "[statistics]") {
  // <z> = 1/2 + 1/alpha exactly.
  const double alpha = GENERATE(1.0, 10.0);
  for (const Container& container : {Container{PeriodicBox{3, 3}}, Container{WalledBox{2, 2}},
                                     Container{Cylinder{2}}, Container{Plates{3, 2}}}) {
    const Estimate own = mean_height_at_rest(container, 1, alpha, 2 / alpha, 200'000, 7);
    CAPTURE(container.index(), alpha, own.value, own.error);
    CHECK(own.error < 0.01 / alpha);
    CHECK(std::abs(own.value - (0.5 + 1 / alpha)) <= 3 * own.error);
  }
}
