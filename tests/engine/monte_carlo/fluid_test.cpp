#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "engine/bed/cells/cell_grid.hpp"
#include "engine/bed/geometry.hpp"
#include "engine/monte_carlo/trial_loop.hpp"
#include "engine/starts/starts.hpp"
#include "tests/engine/monte_carlo/contact_value.hpp"

using namespace jostle;

namespace {

constexpr std::uint32_t n_spheres = 1372;
constexpr int n_bins = n_contact_bins;
constexpr double bin_width = 0.005;

// Histogram of pair distances between 1 and 1 + n_bins bin_width.
void count_pairs(const Packing& packing, std::array<double, n_bins>& counts) {
  const auto& box = std::get<FullyPeriodicBox>(packing.container);
  CellGrid grid;
  grid.build(Boundary(packing.container), 1 + n_bins * bin_width, n_spheres,
             [&](std::uint32_t i) { return packing.centres[i]; });
  for (std::uint32_t i = 0; i < n_spheres; ++i) {
    grid.for_each_near(packing.centres[i], [&](std::uint32_t j) {
      if (j <= i) return;
      const double r =
          std::sqrt(norm_squared(separation(box, packing.centres[i], packing.centres[j])));
      const auto bin = static_cast<int>((r - 1) / bin_width);
      if (bin < n_bins) ++counts[bin];
    });
  }
}

double contact_value(const std::array<double, n_bins>& counts, double configurations,
                     double density) {
  std::array<double, n_bins> g{};
  for (int bin = 0; bin < n_bins; ++bin) {
    const double shell = shell_volume(1 + bin * bin_width, 1 + bin * bin_width + bin_width);
    g[bin] = 2 * counts[bin] / (configurations * n_spheres * density * shell);
  }
  return extrapolated_to_contact(g);
}

struct Estimate {
  double value, error;
};

Estimate measure_contact_value(double fraction, double step, int sweeps, std::uint64_t seed) {
  const double side = std::cbrt(n_spheres * sphere_volume / fraction);
  const FullyPeriodicBox box{side, side, side};
  RandomStream random(stream_key(seed, 0, 0, Purpose::start));
  Packing packing = make_start(Grow{}, box, n_spheres, random);
  const auto loop =
      make_trial_loop(box, MetropolisMove{step}, stream_key(seed, 0, 0, Purpose::trials));
  loop->load(packing);
  loop->run(std::uint64_t{n_spheres} * (sweeps / 4));  // equilibration
  constexpr int blocks = 20, every = 5;
  double sum = 0, squares = 0;
  for (int block = 0; block < blocks; ++block) {
    std::array<double, n_bins> counts{};
    const int configurations = sweeps / blocks / every;
    for (int k = 0; k < configurations; ++k) {
      loop->run(std::uint64_t{n_spheres} * every);
      loop->store(packing);
      count_pairs(packing, counts);
    }
    const double g = contact_value(counts, configurations, n_spheres / (side * side * side));
    sum += g;
    squares += g * g;
  }
  const double mean = sum / blocks;
  return {mean, std::sqrt((squares / blocks - mean * mean) / (blocks - 1))};
}

/// tests/data/bulk_0.30.json, bulk_0.40.json, bulk_0.49.json (g_contact, its error).
struct ContactValue {
  double fraction, step, reference, error;
  int sweeps;
};

void check_contact_value(const ContactValue& known) {
  const Estimate own = measure_contact_value(known.fraction, known.step, known.sweeps, 1957);
  CAPTURE(known.fraction, own.value, own.error);
  WARN("Phi " << known.fraction << ": g(contact) " << own.value << " +- " << own.error
              << ", reference " << known.reference << " +- " << known.error);
  CHECK(own.error <= std::max(known.error, 0.003 * known.reference));
  CHECK(std::abs(own.value - known.reference) <= 3 * std::hypot(own.error, known.error));
}

}  // namespace

TEST_CASE("the hard-sphere fluid has the contact value of an independent Monte Carlo",
          "[statistics]") {
  check_contact_value({0.40, 0.13, 3.71711, 0.00467, 12'000});
}

TEST_CASE("the hard-sphere fluid has the contact values of an independent Monte Carlo", "[slow]") {
  check_contact_value(GENERATE(ContactValue{0.30, 0.26, 2.48769, 0.00310, 12'000},
                               ContactValue{0.49, 0.07, 5.69737, 0.00453, 20'000}));
}
