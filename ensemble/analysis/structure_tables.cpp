#include "ensemble/analysis/structure_tables.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "engine/numbers.hpp"
#include "ensemble/analysis/structure_fits.hpp"
#include "ensemble/moments.hpp"
#include "ensemble/statistics/jackknife.hpp"

namespace jostle::inline ensemble {

namespace {

/// The longest list of each kind of places.
std::map<std::string_view, Places> longest_places(const PartPackings& part) {
  std::map<std::string_view, Places> longest;
  for (const auto& realizations : part) {
    for (const Measurement* measurement : realizations) {
      if (measurement == nullptr) continue;
      for (const Places& places : measurement->places) {
        Places& known = longest[places.name];
        if (known.size() < places.size()) known = places;
      }
    }
  }
  return longest;
}

struct MeansAndErrors {
  std::vector<double> means, errors, dof;
};

double degrees_of_freedom(std::size_t n_packings) {
  return n_packings > 0 ? static_cast<double>(n_packings - 1) : 0;
}

/// Sum over packings of what they have, or the ratio of the sums of value times weight and of
/// weight with its error by the jackknife over packings (Efron 1982, Jackknife, Bootstrap and Other
/// Resampling Plans, sec. 3), [n_taps, n_places].
MeansAndErrors pooled(const PartPackings& part, const MeasuredQuantity& example,
                      std::size_t n_places) {
  MeansAndErrors means;
  for (const auto& realizations : part) {
    for (std::size_t place = 0; place < n_places; ++place) {
      double top = 0, bottom = 0;
      std::vector<std::pair<double, double>> terms;
      for (const Measurement* packing : realizations) {
        const auto* quantity = packing ? packing->find(example.name) : nullptr;
        if (quantity == nullptr) continue;
        const bool weighted = example.pooling == Pooling::weighted;
        const double weight = weighted ? quantity->weight_at(place) : 1;
        if (weight == 0 || std::isnan(weight)) continue;
        terms.emplace_back(quantity->value_at(place) * weight, weight);
        top += terms.back().first;
        bottom += terms.back().second;
      }
      std::vector<double> left_out;
      for (const auto& [value, weight] : terms) {
        left_out.push_back((top - value) / (bottom - weight));
      }
      means.means.push_back(example.pooling == Pooling::sum ? top : top / bottom);
      means.errors.push_back(jackknife_error(left_out));
      means.dof.push_back(degrees_of_freedom(left_out.size()));
    }
  }
  return means;
}

/// Over realizations, [n_taps, n_places]; of the changes since the first tap where `change`.
MeansAndErrors averages(const PartPackings& part, std::string_view name, std::size_t n_places,
                        bool change) {
  MeansAndErrors means;
  for (const auto& realizations : part) {
    for (std::size_t place = 0; place < n_places; ++place) {
      Moments moments;
      for (std::size_t r = 0; r < realizations.size(); ++r) {
        const auto* quantity = realizations[r] ? realizations[r]->find(name) : nullptr;
        if (quantity == nullptr) continue;
        double value = quantity->value_at(place);
        if (change) {
          const auto* start = part[0][r] ? part[0][r]->find(name) : nullptr;
          value -= start != nullptr ? start->value_at(place) : not_a_number;
        }
        moments.add(value);
      }
      means.means.push_back(moments.mean());
      means.errors.push_back(moments.standard_error());
      means.dof.push_back(degrees_of_freedom(moments.count()));
    }
  }
  return means;
}

/// `since`: the tap that changes are counted from; absent: the values themselves.
void add_averages(const PartPackings& part, const MeasuredQuantity& quantity, std::size_t n_places,
                  std::optional<std::uint64_t> since, Table& table) {
  std::vector<std::string> axes = {"tap"};
  if (!quantity.places.empty()) axes.emplace_back(quantity.places);
  MeansAndErrors found = quantity.pooling == Pooling::mean
                             ? averages(part, quantity.name, n_places, since.has_value())
                             : pooled(part, quantity, n_places);
  std::string name(quantity.name), long_name(quantity.long_name);
  const std::string units(quantity.units);
  if (since) {
    name.append("_change");
    long_name.append(", change since tap ").append(std::to_string(*since));
  }
  table.quantities.push_back(
      {name, axes, std::move(found.means), units, long_name, std::string(quantity.source)});
  if (!quantity.with_error || quantity.pooling == Pooling::sum) return;
  table.quantities.push_back({name + "_error", axes, std::move(found.errors), units,
                              quantity.pooling == Pooling::weighted
                                  ? "standard error by the jackknife over packings"
                                  : "standard error over realizations",
                              ""});
  table.quantities.push_back({name + "_dof", std::move(axes), std::move(found.dof), "1",
                              "degrees of freedom of the error", ""});
}

/// The packings that have a value, [n_taps, n_places].
void add_packings_with_value(const PartPackings& part, const MeasuredQuantity& quantity,
                             std::size_t n_places, Table& table) {
  std::vector<std::uint64_t> counts;
  for (const auto& realizations : part) {
    for (std::size_t place = 0; place < n_places; ++place) {
      counts.push_back(static_cast<std::uint64_t>(
          std::ranges::count_if(realizations, [&](const Measurement* measurement) {
            const auto* found = measurement != nullptr ? measurement->find(quantity.name) : nullptr;
            return found != nullptr && !std::isnan(found->value_at(place));
          })));
    }
  }
  std::vector<std::string> axes = {"tap"};
  if (!quantity.places.empty()) axes.emplace_back(quantity.places);
  table.quantities.push_back({std::string(quantity.name) + "_packings", std::move(axes),
                              std::move(counts), "1", "packings that have it, of realizations",
                              ""});
}

/// Notes where a pair correlation scatters by more than a fifth from bin to bin.
void note_few_pairs(const PartPackings& part, const std::vector<std::uint64_t>& taps,
                    Table& table) {
  constexpr double fewest = 25;  // pairs of a bin beyond contact: one in five by Poisson's law
  std::string few;
  for (std::size_t tap = 0; tap < part.size(); ++tap) {
    double centres = 0, packings = 0, expected = 0, bins = 0;
    for (const Measurement* packing : part[tap]) {
      const MeasuredQuantity* g = packing != nullptr ? packing->find("g") : nullptr;
      if (g == nullptr) continue;
      centres += packing->find("centres")->value_at(0);
      packings += packing->find("packings")->value_at(0);
      const auto beyond = g->weights.size() / 2;
      bins = static_cast<double>(g->weights.size() - beyond);
      for (std::size_t k = beyond; k < g->weights.size(); ++k) expected += g->weights[k];
    }
    if (expected >= fewest * bins) continue;
    const auto number = [](double value) { return std::to_string(std::llround(value)); };
    if (!few.empty()) few.append("; ");
    few.append("tap ").append(std::to_string(taps[tap])).append(": ");
    few.append(number(centres)).append(" central spheres in ").append(number(packings));
    few.append(" packings, about ").append(number(bins > 0 ? expected / bins : 0));
    few.append(" pairs per bin");
  }
  if (few.empty()) return;
  table.notes.emplace_back("few_pairs",
                           few.append(": g scatters by more than 20 % from bin to bin; "
                                      "take a wider bin_width or more packings"));
}

Quantity number_of_packings(const PartPackings& part) {
  std::vector<std::uint64_t> counts;
  for (const auto& realizations : part) {
    counts.push_back(realizations.size() -
                     static_cast<std::uint64_t>(std::ranges::count(realizations, nullptr)));
  }
  return {"realizations", {"tap"}, std::move(counts), "1", "packings averaged over", ""};
}

/// The first packing's of each kind.
void add_notes(const Measurement& measurement, Table& table) {
  for (const auto& note : measurement.notes) {
    const bool known = std::ranges::any_of(
        table.notes, [&](const auto& entry) { return entry.first == note.first; });
    if (!known) table.notes.push_back(note);
  }
}

/// The packings' quantities in the order of the first that has each.
std::vector<const MeasuredQuantity*> quantities_of(const PartPackings& part) {
  std::vector<const MeasuredQuantity*> all;
  for (const auto& realizations : part) {
    for (const Measurement* measurement : realizations) {
      if (measurement == nullptr) continue;
      for (const MeasuredQuantity& quantity : measurement->quantities) {
        const bool known = std::ranges::any_of(
            all, [&](const auto* entry) { return entry->name == quantity.name; });
        if (!known) all.push_back(&quantity);
      }
    }
  }
  return all;
}

/// The part of every packing, those that refuse it left out.
PartPackings part_of(const EnsembleStructure& structure, std::size_t index, Table& table) {
  PartPackings part;
  std::string refusal;
  bool any = false;
  for (const auto& realizations : structure.packings) {
    auto& row = part.emplace_back();
    for (const auto& parts : realizations) {
      const Measurement* measurement = parts.empty() ? nullptr : &parts[index];
      if (measurement != nullptr && !measurement->refused.empty()) {
        if (refusal.empty()) refusal = measurement->refused;
        measurement = nullptr;
      }
      if (measurement != nullptr) add_notes(*measurement, table);
      any = any || measurement != nullptr;
      row.push_back(measurement);
    }
  }
  if (!refusal.empty()) table.notes.emplace_back(any ? "refused_by_some" : "refused", refusal);
  return part;
}

}  // namespace

std::vector<Table> structure_tables(const std::string& prefix, const EnsembleStructure& structure,
                                    const StructureSettings& settings) {
  const std::vector<Measurement>* example = nullptr;
  for (const auto& realizations : structure.packings) {
    for (const auto& parts : realizations) {
      if (example == nullptr && !parts.empty()) example = &parts;
    }
  }
  std::vector<Table> tables;
  for (std::size_t k = 0; example != nullptr && k < example->size(); ++k) {
    Table table{.name = prefix + std::string((*example)[k].part)};
    const PartPackings part = part_of(structure, k, table);
    const std::vector<const MeasuredQuantity*> quantities = quantities_of(part);
    if (!quantities.empty()) {
      const auto places = longest_places(part);
      table.axes.push_back(
          {"tap", {"tap"}, structure.taps, "taps", "taps made before; of a file, the frame", ""});
      for (const auto& [name, list] : places) {
        const std::string axis_name(name);
        Quantity axis{
            axis_name, {axis_name}, {}, std::string(list.units), std::string(list.long_name), ""};
        std::visit([&](const auto& values) { axis.values = values; }, list.values);
        table.axes.push_back(std::move(axis));
      }
      table.quantities.push_back(number_of_packings(part));
      for (const MeasuredQuantity* quantity : quantities) {
        const std::size_t n = quantity->places.empty() ? 1 : places.at(quantity->places).size();
        add_averages(part, *quantity, n, std::nullopt, table);
        if (quantity->with_packings) add_packings_with_value(part, *quantity, n, table);
        if (quantity->with_change) {
          add_averages(part, *quantity, n, structure.taps.front(), table);
        }
      }
      add_fits((*example)[k].part, part, settings, table);
      if ((*example)[k].part == "pair_correlation") note_few_pairs(part, structure.taps, table);
    }
    tables.push_back(std::move(table));
  }
  return tables;
}

}  // namespace jostle::inline ensemble
