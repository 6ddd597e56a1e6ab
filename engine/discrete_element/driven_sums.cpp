#include "engine/discrete_element/driven_sums.hpp"

#include <algorithm>
#include <limits>

namespace jostle::inline engine {

namespace {

/// Nearly all bins above are empty: spheres that are thrown so far are counted in none.
constexpr double most_bins = 1e5;

}  // namespace

void add_sample(DrivenSums& sums, std::span<const GrainState> grains, double floor_height) {
  struct Sample {
    double n = 0;
    Vec3 mean;
  };
  std::vector<Sample> samples;
  const auto bin_of = [&](const GrainState& grain) {
    return static_cast<std::size_t>(std::max(0.0, grain.centre.z - floor_height) / sums.bin_width);
  };
  const auto is_counted = [&](const GrainState& grain) {
    return grain.centre.z - floor_height < most_bins * sums.bin_width;
  };
  for (const GrainState& grain : grains) {
    if (!is_counted(grain)) continue;
    const std::size_t bin = bin_of(grain);
    if (bin >= samples.size()) samples.resize(bin + 1);
    samples[bin].n += 1;
    samples[bin].mean = samples[bin].mean + grain.velocity;
  }
  if (samples.size() > sums.bins.size()) sums.bins.resize(samples.size());
  for (std::size_t bin = 0; bin < samples.size(); ++bin) {
    Sample& sample = samples[bin];
    if (!(sample.n > 0)) continue;
    sample.mean = (1 / sample.n) * sample.mean;
    sums.bins[bin].spheres += sample.n;
    sums.bins[bin].freedom += sample.n - 1;
  }
  for (const GrainState& grain : grains) {
    if (!is_counted(grain)) continue;
    const std::size_t bin = bin_of(grain);
    const Vec3 fluctuation = grain.velocity - samples[bin].mean;
    sums.bins[bin].lateral += 0.5 * (fluctuation.x * fluctuation.x + fluctuation.y * fluctuation.y);
    sums.bins[bin].vertical += fluctuation.z * fluctuation.z;
  }
  ++sums.samples;
}

DrivenBed driven_bed(const DrivenSums& sums, double seconds) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const double unit = 1 / (seconds * seconds);
  DrivenBed bed;
  double all = 0;
  for (const DrivenSums::Bin& bin : sums.bins) all += bin.spheres;
  std::size_t n_temperatures = 0;
  for (std::size_t k = 0; k < sums.bins.size(); ++k) {
    const DrivenSums::Bin& bin = sums.bins[k];
    bed.fraction.push_back(bin.spheres / all);
    bed.lateral.push_back(bin.freedom > 0 ? unit * bin.lateral / bin.freedom : none);
    bed.vertical.push_back(bin.freedom > 0 ? unit * bin.vertical / bin.freedom : none);
    if (bin.freedom > 0) n_temperatures = k + 1;
  }
  bed.lateral.resize(n_temperatures);
  bed.vertical.resize(n_temperatures);
  return bed;
}

}  // namespace jostle::inline engine
