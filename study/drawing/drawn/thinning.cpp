#include "study/drawing/drawn/thinning.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace jostle::inline study {
namespace {

std::size_t size_of(const Quantity& quantity) {
  return std::visit([](const auto& values) { return values.size(); }, quantity.values);
}

using KeptPlaces = std::map<std::string, std::vector<std::size_t>>;

/// The kept values of a quantity with `axes`, outermost first, `lengths` long.
template <class Value>
std::vector<Value> kept_values(const std::vector<Value>& values,
                               const std::vector<std::size_t>& lengths,
                               const std::vector<const std::vector<std::size_t>*>& kept) {
  std::vector<std::size_t> rows = {0};  // offsets of what is kept, axis after axis
  for (std::size_t a = 0; a < lengths.size(); ++a) {
    std::vector<std::size_t> next;
    next.reserve(rows.size() * kept[a]->size());
    for (const std::size_t row : rows) {
      for (const std::size_t place : *kept[a]) next.push_back(row * lengths[a] + place);
    }
    rows = std::move(next);
  }
  std::vector<Value> selected;
  selected.reserve(rows.size());
  for (const std::size_t row : rows) selected.push_back(values[row]);
  return selected;
}

/// Places along its last axis where a quantity has its least and its greatest value, of each row at
/// which it is kept along the axes before.
std::vector<std::size_t> extreme_places(const Quantity& quantity,
                                        const std::map<std::string, std::size_t>& lengths,
                                        const KeptPlaces& kept) {
  const auto* const values = std::get_if<std::vector<double>>(&quantity.values);
  if (values == nullptr || quantity.axes.empty() || quantity.name.ends_with("_error")) return {};
  std::vector<std::size_t> rows = {0};
  std::size_t n = 1;
  for (const std::string& axis : quantity.axes) {
    if (!kept.contains(axis)) return {};
    n *= lengths.at(axis);
    if (axis == quantity.axes.back()) break;
    std::vector<std::size_t> next;
    for (const std::size_t row : rows) {
      for (const std::size_t place : kept.at(axis)) next.push_back(row * lengths.at(axis) + place);
    }
    rows = std::move(next);
  }
  if (n != values->size()) return {};
  const std::size_t length = lengths.at(quantity.axes.back());
  std::vector<std::size_t> places;
  for (const std::size_t row : rows) {
    const std::span<const double> own = std::span(*values).subspan(row * length, length);
    for (const std::size_t place : extremes_of(own)) places.push_back(place);
  }
  return places;
}

}  // namespace

std::vector<std::size_t> extremes_of(std::span<const double> values) {
  std::optional<std::size_t> least, greatest;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) continue;
    if (!least || values[i] < values[*least]) least = i;
    if (!greatest || values[i] > values[*greatest]) greatest = i;
  }
  if (!least) return {};
  return {*least, *greatest};
}

std::vector<std::size_t> joined(std::vector<std::size_t> first,
                                const std::vector<std::size_t>& second) {
  first.insert(first.end(), second.begin(), second.end());
  std::ranges::sort(first);
  const auto repeated = std::ranges::unique(first);
  first.erase(repeated.begin(), repeated.end());
  return first;
}

std::vector<std::size_t> evenly_spread(std::size_t n, std::size_t most) {
  std::vector<std::size_t> chosen;
  if (n <= most) {
    for (std::size_t i = 0; i < n; ++i) chosen.push_back(i);
    return chosen;
  }
  if (most == 1) return {n - 1};
  for (std::size_t i = 0; i < most; ++i) chosen.push_back(i * (n - 1) / (most - 1));
  return chosen;
}

std::vector<std::size_t> logarithmically_spread(std::size_t n, std::size_t per_decade,
                                                std::size_t evenly) {
  std::vector<std::size_t> chosen = evenly_spread(n, std::max<std::size_t>(2, evenly));
  for (std::size_t k = 0; n > 1; ++k) {
    const double place =
        std::round(std::pow(10, static_cast<double>(k) / static_cast<double>(per_decade)));
    if (place >= static_cast<double>(n)) break;
    chosen.push_back(static_cast<std::size_t>(place));
  }
  return joined(std::move(chosen), {});
}

Table thinned(const Table& table, const TableThinning& thinning) {
  KeptPlaces kept;
  std::map<std::string, std::size_t> lengths;
  for (const Quantity& axis : table.axes) {
    const std::size_t n = size_of(axis);
    lengths[axis.name] = n;
    if (axis.name == "t") {
      kept[axis.name] = n <= thinning.whole
                            ? evenly_spread(n, n)
                            : logarithmically_spread(n, thinning.per_decade, thinning.per_decade);
    } else {
      kept[axis.name] =
          evenly_spread(n, axis.name == "tap" ? thinning.most_taps : thinning.most_places);
    }
  }
  KeptPlaces extremes;
  for (const Quantity& quantity : table.quantities) {
    for (const std::size_t place : extreme_places(quantity, lengths, kept)) {
      extremes[quantity.axes.back()].push_back(place);
    }
  }
  for (const auto& [axis, places] : extremes) {
    if (axis != "tap") kept[axis] = joined(std::move(kept[axis]), places);
  }
  Table thinned_table{.name = table.name, .axes = {}, .quantities = {}, .notes = table.notes};
  if (kept.contains("t") && kept["t"].size() < lengths["t"]) {
    thinned_table.notes.emplace_back("drawn",
                                     fmt::format("{} of {}", kept["t"].size(), lengths["t"]));
  }
  const auto keep = [&](const Quantity& quantity, const std::vector<std::string>& axes,
                        std::vector<Quantity>& target) {
    std::vector<std::size_t> shape;
    std::vector<const std::vector<std::size_t>*> places;
    std::size_t n = 1;
    for (const std::string& axis : axes) {
      if (!kept.contains(axis)) return;
      shape.push_back(lengths[axis]);
      places.push_back(&kept[axis]);
      n *= shape.back();
    }
    if (n != size_of(quantity)) return;
    Quantity thinned_quantity = quantity;
    std::visit([&](auto& values) { values = kept_values(values, shape, places); },
               thinned_quantity.values);
    target.push_back(std::move(thinned_quantity));
  };
  for (const Quantity& axis : table.axes) keep(axis, {axis.name}, thinned_table.axes);
  for (const Quantity& quantity : table.quantities)
    keep(quantity, quantity.axes, thinned_table.quantities);
  return thinned_table;
}

std::size_t n_values(const Table& table) {
  std::size_t n = 0;
  for (const Quantity& axis : table.axes) n += size_of(axis);
  for (const Quantity& quantity : table.quantities) n += size_of(quantity);
  return n;
}

}  // namespace jostle::inline study
