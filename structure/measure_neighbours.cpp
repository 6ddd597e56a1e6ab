#include <cmath>
#include <iomanip>
#include <set>
#include <sstream>
#include <string>

#include "engine/bed/boundary.hpp"
#include "engine/bed/slab.hpp"
#include "engine/numbers.hpp"
#include "structure/measure_parts.hpp"
#include "structure/order/bond_order.hpp"
#include "structure/order/crystal_order.hpp"
#include "structure/order/mixtures/partial_correlation.hpp"
#include "structure/order/ordered_front.hpp"
#include "structure/order/pair_correlation.hpp"
#include "structure/snapshot_statistics.hpp"

namespace jostle::inline structure {

namespace {

std::vector<double> cuts_up_to(const CoordinationSettings& settings) {
  std::vector<double> cuts;
  const auto n = static_cast<std::size_t>((settings.largest_cut - 1) / settings.step + 1e-9);
  for (std::size_t k = 0; k <= n; ++k) {
    cuts.push_back(1 + static_cast<double>(k) * settings.step);
  }
  return cuts;
}

/// Means of what some spheres have, bin by bin or over the region.
class Means {
 public:
  explicit Means(std::size_t n_bins) : sums_(n_bins, 0.0), counts_(n_bins, 0.0) {}

  void add(std::size_t bin, double value) {
    sums_[bin] += value;
    counts_[bin] += 1;
  }
  std::vector<double> values() const {
    std::vector<double> means(sums_.size());
    for (std::size_t k = 0; k < means.size(); ++k) means[k] = sums_[k] / counts_[k];
    return means;
  }

 private:
  std::vector<double> sums_, counts_;
};

struct OrderColumn {
  std::string_view name, at_height;
  std::string_view of_region, of_bin;
  std::string_view source;
};

constexpr const char* steinhardt = "Steinhardt et al. 1983, doi:10.1103/PhysRevB.28.784";
constexpr const char* stukowski = "Stukowski 2012, doi:10.1088/0965-0393/20/4/045021";
constexpr OrderColumn order_columns[] = {
    {"fcc", "fcc_at_height", "fraction of the region's spheres with fcc order",
     "fraction of a bin's spheres with fcc order", stukowski},
    {"hcp", "hcp_at_height", "fraction of the region's spheres with hcp order",
     "fraction of a bin's spheres with hcp order", stukowski},
    {"disordered", "disordered_at_height", "fraction of the region's spheres with neither",
     "fraction of a bin's spheres with neither", stukowski},
    {"q4", "q4_at_height", "mean q4 of the 12 nearest neighbours, region's spheres that have 12",
     "mean q4 of the 12 nearest neighbours, a bin's spheres that have 12", steinhardt},
    {"q6", "q6_at_height", "mean q6 of the 12 nearest neighbours, region's spheres that have 12",
     "mean q6 of the 12 nearest neighbours, a bin's spheres that have 12", steinhardt},
    {"w6", "w6_at_height", "mean w6 of the 12 nearest neighbours, region's spheres that have 12",
     "mean w6 of the 12 nearest neighbours, a bin's spheres that have 12", steinhardt}};
constexpr std::size_t n_order_columns = std::size(order_columns), first_bond_column = 3;

/// Neighbours of a mixture within a cut, by kinds.
void add_kinds(const MeasuredPacking& measured, double cut, Measurement& measurement) {
  const NeighbourTable near = neighbours_within_contacts(measured.packing, cut);
  KindPairs pairs(measured);
  for (std::size_t i = 0; i < near.size(); ++i) {
    for (const Neighbour& neighbour : near.neighbours_of(i)) pairs.add(i, neighbour.sphere);
  }
  pairs.write("n_c_of_pair", "n_c_of_pair_all",
              "mean number of neighbours of the second kind of one of the first, over the region",
              "mean number of neighbours of the second kind of one of the first, over all spheres",
              measurement);
}

/// A word of a quantity's name: letters, digits and underscores.
std::string word_of(const std::string& kind) {
  std::string word = kind;
  const auto is_kept = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  };
  for (char& c : word) {
    if (!is_kept(c)) c = '_';
  }
  return word;
}

/// The central spheres of each kind, and whether there are any.
void add_centres(const Packing& packing, HeightWindow heights, Measurement& measurement) {
  const Sizes& sizes = *packing.sizes;
  std::vector<std::string> names;
  for (const SphereKind& kind : sizes.kinds()) names.push_back(kind.name);
  std::vector<double> centres(names.size(), 0.0);
  double n_centres = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const double z = packing.centres[i].z;
    if (z < heights.low || z > heights.high) continue;
    centres[sizes.kind(i)] += 1;
    n_centres += 1;
  }
  measurement.places.push_back({"kind", std::move(names), "1", "kind of spheres"});
  measurement.quantities.push_back({.name = "centres_of_kind",
                                    .places = "kind",
                                    .values = std::move(centres),
                                    .long_name = "central spheres of a kind, of all packings",
                                    .pooling = Pooling::sum});
  measurement.quantities.push_back({.name = "packings",
                                    .values = {n_centres > 0 ? 1.0 : 0.0},
                                    .long_name = "packings that have a central sphere",
                                    .pooling = Pooling::sum});
}

Measurement measured_partial_pairs(const MeasuredPacking& measured, const PairsSettings& settings) {
  const double x_max = settings.r_max.value_or(widest_partial_pairs(measured.packing));
  const PairCorrelationSettings reach{.r_max = x_max, .bin_width = settings.bin_width};
  const std::vector<PartialCorrelation> all = partial_correlations(measured.packing, reach);
  Measurement measurement;
  measurement.places = {{"r", all.front().x, "sum of radii",
                         "distance of centres over the sum of the two radii, middle of a bin"}};
  const std::vector<SphereKind>& kinds = measured.packing.sizes->kinds();
  std::set<std::string> names;
  for (const PartialCorrelation& pairs : all) {
    const std::string words =
        word_of(kinds[pairs.first].name) + "_" + word_of(kinds[pairs.second].name);
    std::string name = words;  // names of two pairs may join to one text
    for (int number = 2; !names.insert(name).second; ++number)
      name = words + "_" + std::to_string(number);
    measurement.quantities.push_back(
        {.name = "g_" + name,
         .places = "r",
         .values = pairs.g(),
         .long_name = "pair correlation of two kinds; pairs of all packings over those of an "
                      "uncorrelated packing with the same heights and sizes",
         .pooling = Pooling::weighted,
         .weights = pairs.expected,
         .beyond = not_a_number});
    measurement.quantities.push_back(
        {.name = "pairs_" + name,
         .places = "r",
         .values = std::vector<double>(pairs.counts.begin(), pairs.counts.end()),
         .long_name = "pairs of two kinds found from the central spheres, of all packings",
         .pooling = Pooling::sum});
  }
  add_centres(measured.packing, central_heights(measured.packing, reach), measurement);
  return measurement;
}

}  // namespace

Measurement measure_part(MeasuredPacking& measured, const CoordinationSettings& settings) {
  const CoordinationCurve curve =
      coordination_curve(measured.packing, cuts_up_to(settings), measured.region);
  const std::vector<unsigned> numbers = coordination_numbers(measured.packing, settings.cut);
  std::vector<unsigned> in_region;
  double all = 0, mean = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    all += numbers[i];
    if (measured.in_region(i)) in_region.push_back(numbers[i]);
  }
  for (const unsigned number : in_region) mean += number;
  const std::vector<double> histogram = shares(neighbour_histogram(in_region));
  Measurement measurement;
  measurement.places = {{"cut", curve.cuts, measured.packing.sizes ? "sum of radii" : "diameter",
                         "centres at most so far away count"},
                        {"neighbours", whole_numbers(histogram.size()), "1",
                         "other centres within the setting `cut`"}};
  measurement.quantities = {
      {.name = "n_c_of_cut",
       .places = "cut",
       .values = curve.coordination,
       .long_name = "mean number of centres within the cut, over the region"},
      {.name = "neighbour_share",
       .places = "neighbours",
       .values = histogram,
       .long_name = "fraction of the region's spheres with so many neighbours",
       .source = "Rosato et al. 2010, fig. 8"},
      {.name = "n_c",
       .values = {mean / static_cast<double>(in_region.size())},
       .long_name = "mean number of other centres within the setting `cut`, over the region",
       .source = "Rosato et al. 2010, fig. 3"},
      {.name = "n_c_all",
       .values = {all / static_cast<double>(numbers.size())},
       .long_name = "the same over all spheres",
       .source = "Rosato et al. 2010, fig. 3"},
      {.name = "n_spheres",
       .values = {static_cast<double>(in_region.size())},
       .long_name = "spheres of the region",
       .is_compared = false}};
  if (measured.packing.sizes) add_kinds(measured, settings.cut, measurement);
  return measurement;
}

Measurement measure_part(MeasuredPacking& measured, const PairsSettings& settings) {
  if (measured.packing.sizes) return measured_partial_pairs(measured, settings);
  const double r_max = settings.r_max.value_or(widest_pairs(measured.packing.container));
  const PairCorrelation pairs =
      pair_correlation(measured.packing, {.r_max = r_max, .bin_width = settings.bin_width});
  const auto centres = static_cast<double>(pairs.n_centres);
  const std::vector<double> counts(pairs.counts.begin(), pairs.counts.end());
  std::vector<double> ends;
  for (const double r : pairs.r) ends.push_back(r + 0.5 * pairs.bin_width);
  Measurement measurement;
  measurement.places = {
      {"r", pairs.r, "diameter", "distance of centres, middle of a bin"},
      {"r_end", std::move(ends), "diameter", "distance of centres, end of a bin"}};
  measurement.quantities = {
      {.name = "g",
       .places = "r",
       .values = pairs.g(),
       .long_name = "pair correlation, corrected for floor, surface and sides; pairs of all "
                    "packings over those of an uncorrelated packing with the same heights",
       .source = "Stoyan & Stoyan 2000, Scand. J. Statist. 27, 641",
       .pooling = Pooling::weighted,
       .weights = pairs.expected,
       .beyond = not_a_number},
      {.name = "pairs",
       .places = "r",
       .values = counts,
       .long_name = "other centres found around the central spheres, of all packings",
       .pooling = Pooling::sum},
      {.name = "neighbours",
       .places = "r_end",
       .values = pairs.running_neighbours(),
       .long_name = "mean number of other centres up to this distance; at each distance around the "
                    "central spheres whose shell lies in the accessible region",
       .pooling = Pooling::weighted,
       .weights = pairs.shells,
       .beyond = not_a_number},
      {.name = "whole_shells",
       .places = "r_end",
       .values = pairs.shells,
       .long_name =
           "central spheres whose shell at this distance lies in the accessible region, of "
           "all packings",
       .pooling = Pooling::sum},
      {.name = "density",
       .values = {pairs.density},
       .units = "1/diameter^3",
       .long_name = "mean over all places open to centres, those at walls included; density x g "
                    "is not the number of neighbours: use `neighbours`",
       .pooling = Pooling::weighted,
       .weights = {centres}},
      {.name = "centres",
       .values = {centres},
       .long_name = "central spheres of all packings",
       .pooling = Pooling::sum},
      {.name = "packings",
       .values = {centres > 0 ? 1.0 : 0.0},
       .long_name = "packings that have a central sphere",
       .pooling = Pooling::sum}};
  if (pairs.widest_shell < r_max - 1e-9) {
    const double last = std::floor(pairs.widest_shell / pairs.bin_width + 1e-9) * pairs.bin_width;
    std::ostringstream text;
    text << "no value beyond r_end = " << std::setprecision(4) << last
         << ": no larger sphere about a centre has room between the sides";
    measurement.notes.emplace_back("neighbours", text.str());
  }
  return measurement;
}

namespace {

/// Spheres of the region, and how many of them have sides within 3/2: sites of neighbours at
/// contact lie beyond these sides, and what begins there is no bulk.
void add_nearness(const MeasuredPacking& measured, Measurement& measurement) {
  Region inner = measured.region;
  inner.from_sides = 3 * sphere_radius;
  double spheres = 0, near = 0;
  for (std::size_t i = 0; i < measured.packing.centres.size(); ++i) {
    if (!measured.in_region(i)) continue;
    ++spheres;
    near += inner.contains(measured.packing.container, measured.packing.centres[i]) ? 0 : 1;
  }
  measurement.quantities.push_back({.name = "n_spheres",
                                    .values = {spheres},
                                    .long_name = "spheres of the region",
                                    .with_error = false});
  measurement.quantities.push_back({.name = "near_sides",
                                    .values = {near / spheres},
                                    .long_name =
                                        "fraction of them less than 3/2 from a side, beyond which "
                                        "sites of their neighbours lie",
                                    .with_error = false});
  if (near > 0.5 * spheres) {
    measurement.notes.emplace_back(
        "sides",
        "most spheres of the region are less than 3/2 from a side and have no neighbours beyond "
        "it: crystals that do not begin at the side count as disordered, and q6 of gases is up to "
        "7 % too small");
  }
}

}  // namespace

Measurement measure_part(MeasuredPacking& measured, const OrderSettings& settings) {
  require_height_bins(measured.packing, settings.bin_width);
  const NeighbourTable nearest = nearest_neighbours(measured.packing);
  const std::vector<CrystalOrder> orders = crystal_order(nearest);
  const std::vector<BondOrder> bonds = bond_order(nearest);
  const auto bin = [&](double z) { return static_cast<std::size_t>(z / settings.bin_width); };
  const std::size_t n_bins = bin(top_height(measured.packing)) + 1;
  std::vector<Means> by_height(n_order_columns, Means(n_bins));
  std::vector<Means> of_region(n_order_columns, Means(1));
  for (std::size_t i = 0; i < orders.size(); ++i) {
    const double values[n_order_columns] = {orders[i] == CrystalOrder::fcc ? 1.0 : 0.0,
                                            orders[i] == CrystalOrder::hcp ? 1.0 : 0.0,
                                            orders[i] == CrystalOrder::disordered ? 1.0 : 0.0,
                                            bonds[i].q4,
                                            bonds[i].q6,
                                            bonds[i].w6};
    const bool surrounded =
        nearest.neighbours_of(i).size() == 12;  // or q4, q6, w6 compare with no other's
    for (std::size_t c = 0; c < n_order_columns; ++c) {
      if (c >= first_bond_column && !surrounded) continue;
      by_height[c].add(bin(measured.packing.centres[i].z), values[c]);
      if (measured.in_region(i)) of_region[c].add(0, values[c]);
    }
  }
  Measurement measurement;
  measurement.places = {{"height", middles_of_bins(n_bins, settings.bin_width), "diameter",
                         "height above the floor, middle of a bin"}};
  for (std::size_t c = 0; c < n_order_columns; ++c) {
    const auto& [name, at_height, of_region_name, of_bin_name, source] = order_columns[c];
    measurement.quantities.push_back({.name = std::string(at_height),
                                      .places = "height",
                                      .values = by_height[c].values(),
                                      .long_name = of_bin_name,
                                      .source = source,
                                      .beyond = not_a_number});
    measurement.quantities.push_back({.name = std::string(name),
                                      .values = of_region[c].values(),
                                      .long_name = of_region_name,
                                      .source = source});
  }
  if (Boundary(measured.packing.container).has_floor()) {
    measurement.quantities.push_back(
        {.name = "ordered_height",
         .values = {ordered_height(measured.packing, orders)},
         .units = "diameter",
         .long_name = "height up to which half of the spheres, layer by layer, are fcc or hcp",
         .source = stukowski});
  }
  add_nearness(measured, measurement);
  return measurement;
}

}  // namespace jostle::inline structure
