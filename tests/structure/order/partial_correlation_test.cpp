// Partial pair correlations of fluids without gravity.
#include "structure/order/mixtures/partial_correlation.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "engine/monte_carlo/trial_loop.hpp"
#include "engine/starts/starts.hpp"

using namespace jostle;

namespace {

/// Boublik 1970, Grundke & Henderson 1972, Lee & Levesque 1973: g at contact of small spheres, of
/// unlike ones and of large ones, as many of diameter 1 as of diameter `ratio`.
std::array<double, 3> contact_values_of_theory(double ratio, double fraction) {
  const double x2 = fraction * (1 + ratio * ratio) / (1 + ratio * ratio * ratio);
  const double free = 1 - fraction;
  std::array<double, 3> values{};
  const std::array<double, 3> reduced{0.5, ratio / (1 + ratio), 0.5 * ratio};
  for (std::size_t k = 0; k < 3; ++k) {
    const double y = x2 * reduced[k] / free;
    values[k] = (1 + 3 * y + 2 * y * y) / free;
  }
  return values;
}

struct Estimate {
  std::array<double, 3> value{}, error{};
};

/// g at contact of a fluid of 2 x 200 spheres, by blocks of configurations three sweeps apart.
Estimate contact_values(double ratio, double fraction, int blocks, int of_block) {
  constexpr std::uint32_t n = 200;
  constexpr double bin_width = 0.01;
  std::vector<double> diameters(n, 1.0);
  diameters.insert(diameters.end(), n, ratio);
  std::vector<std::uint32_t> kinds(n, 0);
  kinds.insert(kinds.end(), n, 1);
  const auto sizes = std::make_shared<const Sizes>(
      diameters, kinds, std::vector<SphereKind>{{"small", 1}, {"large", 1}});
  const double side = std::cbrt(n * (1 + ratio * ratio * ratio) * sphere_volume / fraction);
  RandomStream random(stream_key(1973, 0, 0, Purpose::start));
  Packing packing = make_start(Grow{}, FullyPeriodicBox{side, side, side}, {2 * n, sizes}, random);
  const auto loop = make_trial_loop(packing.container, MetropolisMove{0.3},
                                    stream_key(1973, 0, 0, Purpose::trials), best_instruction_set(),
                                    Sampler::exhaustive, SphereSizes::several);
  loop->load(packing);
  loop->run(std::uint64_t{2} * n * 500);
  Estimate found;
  std::array<double, 3> squares{};
  for (int block = 0; block < blocks; ++block) {
    std::vector<PartialCorrelation> pooled;
    for (int k = 0; k < of_block; ++k) {
      loop->run(std::uint64_t{2} * n * 3);
      loop->store(packing);
      auto pairs = partial_correlations(packing, {.r_max = 1.1, .bin_width = bin_width});
      if (pooled.empty()) {
        pooled = std::move(pairs);
        continue;
      }
      for (std::size_t p = 0; p < 3; ++p) {
        for (std::size_t bin = 0; bin < pairs[p].x.size(); ++bin) {
          pooled[p].counts[bin] += pairs[p].counts[bin];
          pooled[p].expected[bin] += pairs[p].expected[bin];
        }
      }
    }
    for (std::size_t p = 0; p < 3; ++p) {
      const double g = contact_value(pooled[p], bin_width);
      found.value[p] += g / blocks;
      squares[p] += g * g / blocks;
    }
  }
  for (std::size_t p = 0; p < 3; ++p)
    found.error[p] = std::sqrt((squares[p] - found.value[p] * found.value[p]) / (blocks - 1));
  return found;
}

}  // namespace

TEST_CASE("partial g(r) of a fluid of two sizes has the contact values of theory") {
  for (const auto& [ratio, most_error] : {std::pair{1.4, 0.06}, std::pair{3.0, 0.12}}) {
    const Estimate found = contact_values(ratio, 0.30, 20, 40);
    const auto theory = contact_values_of_theory(ratio, 0.30);
    for (std::size_t p = 0; p < 3; ++p) {
      CAPTURE(ratio, p, found.value[p], found.error[p], theory[p]);
      CHECK(found.error[p] < most_error * theory[p]);
      CHECK(std::abs(found.value[p] - theory[p]) <= std::max(3 * found.error[p], 0.01 * theory[p]));
    }
  }
}
