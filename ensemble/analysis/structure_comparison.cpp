#include "ensemble/analysis/structure_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "engine/numbers.hpp"
#include "ensemble/analysis/sweeps/sweep_curve.hpp"

namespace jostle::inline ensemble {

namespace {

const MeasuredQuantity* found(const std::vector<Measurement>& parts, std::size_t part,
                              std::string_view name) {
  return part < parts.size() ? parts[part].find(name) : nullptr;
}

bool is_number(const MeasuredQuantity& quantity) {
  return quantity.places.empty() && quantity.pooling == Pooling::mean && quantity.with_error &&
         quantity.is_compared;
}

/// A number of one part in every packing.
PackingNumber number_in(const EnsembleStructure& structure, std::size_t part,
                        std::string_view part_name, const MeasuredQuantity& example) {
  PackingNumber number{std::string(part_name),
                       std::string(example.name),
                       std::string(example.units),
                       std::string(example.long_name),
                       {}};
  for (const auto& realizations : structure.packings) {
    auto& row = number.values.emplace_back();
    for (const auto& parts : realizations) {
      const MeasuredQuantity* const quantity = found(parts, part, example.name);
      row.push_back(quantity != nullptr ? quantity->value_at(0) : not_a_number);
    }
  }
  return number;
}

/// The last tap of which all points keep packings.
std::optional<std::uint64_t> last_common_tap(std::span<const ComparedPoint> points) {
  const auto have_it = [&](std::uint64_t tap) {
    return std::ranges::all_of(points, [tap](const ComparedPoint& point) {
      return std::ranges::binary_search(point.taps, tap);
    });
  };
  const std::vector<std::uint64_t>& taps = points.front().taps;
  const auto last = std::find_if(taps.rbegin(), taps.rend(), have_it);
  return last == taps.rend() ? std::nullopt : std::optional(*last);
}

/// Values over realizations at a tap; null where the point does not have the number.
const std::vector<double>* values_at(const ComparedPoint& point, const PackingNumber& example,
                                     std::uint64_t tap) {
  const auto number = std::ranges::find_if(point.numbers, [&](const PackingNumber& packing_number) {
    return packing_number.part == example.part && packing_number.name == example.name;
  });
  if (number == point.numbers.end()) return nullptr;
  const auto place = std::ranges::lower_bound(point.taps, tap) - point.taps.begin();
  return &number->values[static_cast<std::size_t>(place)];
}

/// ComparisonLines of a table of differences.
struct ComparisonLines {
  std::vector<std::uint64_t> line, from_point, to_point;
  std::vector<std::string> quantity, units, start, end;
  std::vector<double> from_value, to_value, value, error, dof, p, corrected;
};

void add_lines(std::span<const ComparedPoint> points, const PackingNumber& number,
               std::uint64_t tap, Streams streams, ComparisonLines& lines) {
  std::vector<double> places;
  std::vector<std::vector<double>> values;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::vector<double>* const own = values_at(points[i], number, tap);
    if (own == nullptr) continue;
    places.push_back(static_cast<double>(i));
    values.push_back(*own);
  }
  const SweepCurve curve(places, values, streams);
  if (curve.n_points() < 2) return;
  const ComparedPairs pairs = points.size() <= most_compared_pairwise ? ComparedPairs::all_pairs
                                                                      : ComparedPairs::with_first;
  for (const SweepDifference& difference : differences(curve, pairs)) {
    const auto& first = points[static_cast<std::size_t>(curve.x()[difference.start])];
    const auto& second = points[static_cast<std::size_t>(curve.x()[difference.end])];
    lines.line.push_back(lines.line.size());
    lines.quantity.push_back(number.name);
    lines.units.push_back(number.units);
    lines.start.push_back(first.label);
    lines.end.push_back(second.label);
    lines.from_point.push_back(first.point);
    lines.to_point.push_back(second.point);
    lines.from_value.push_back(curve.y()[difference.start]);
    lines.to_value.push_back(curve.y()[difference.end]);
    lines.value.push_back(difference.value);
    lines.error.push_back(error_or_nan(difference.error));
    lines.dof.push_back(difference.error.known() ? difference.error.dof : 0);
    lines.p.push_back(difference.p);
    lines.corrected.push_back(difference.corrected);
  }
}

std::string test_note(std::size_t n_points, Streams streams) {
  std::string note = streams == Streams::matched
                         ? "paired by realization (matched streams): Student's t"
                         : "independent realizations: Welch's test";
  note += n_points <= most_compared_pairwise ? "; every pair of sweep points"
                                             : "; each sweep point with the first";
  return note + "; p_corrected allows for the pairs of one quantity (Holm 1979)";
}

Table table_of(const std::string& part, std::uint64_t tap, std::size_t n_points, Streams streams,
               ComparisonLines lines) {
  Table table{.name = "comparison/" + part};
  table.axes = {{"line", {"line"}, std::move(lines.line), "1", "lines of the comparison", ""}};
  const auto add = [&](const char* name, auto values, const char* long_name,
                       const char* source = "") {
    table.quantities.push_back({name, {"line"}, std::move(values), "1", long_name, source});
  };
  add("quantity", std::move(lines.quantity), "number of a packing");
  add("units", std::move(lines.units), "units of its means, difference and error");
  add("from", std::move(lines.start), "sweep point that the difference is taken from");
  add("to", std::move(lines.end), "sweep point whose mean it is taken to");
  add("from_mean", std::move(lines.from_value), "mean over the realizations of `from`");
  add("to_mean", std::move(lines.to_value), "mean over the realizations of `to`");
  add("difference", std::move(lines.value),
      streams == Streams::matched ? "mean of `to` less `from`, of the realizations that both have"
                                  : "mean at `to` less that at `from`");
  add("difference_error", std::move(lines.error), "standard error of the difference");
  add("difference_dof", std::move(lines.dof), "degrees of freedom of difference_error");
  add("p", std::move(lines.p), "p-value of no difference, this pair alone",
      streams == Streams::matched ? "Student 1908" : "Welch 1947");
  add("p_corrected", std::move(lines.corrected), "p-value, corrected for the pairs of the quantity",
      "Holm 1979");
  add("from_point", std::move(lines.from_point), "number of the sweep point `from`");
  add("to_point", std::move(lines.to_point), "number of the sweep point `to`");
  table.notes = {{"tap", std::to_string(tap)}, {"test", test_note(n_points, streams)}};
  return table;
}

}  // namespace

ComparedPoint packing_numbers(std::string label, std::uint32_t point,
                              const EnsembleStructure& structure) {
  ComparedPoint all{std::move(label), point, structure.taps, {}};
  for (const auto& realizations : structure.packings) {
    for (const auto& parts : realizations) {
      for (std::size_t part = 0; part < parts.size(); ++part) {
        for (const MeasuredQuantity& quantity : parts[part].quantities) {
          const bool is_known = std::ranges::any_of(all.numbers, [&](const PackingNumber& number) {
            return number.part == parts[part].part && number.name == quantity.name;
          });
          if (is_number(quantity) && !is_known) {
            all.numbers.push_back(number_in(structure, part, parts[part].part, quantity));
          }
        }
      }
    }
  }
  return all;
}

std::vector<Table> comparison_tables(std::span<const ComparedPoint> points, Streams streams) {
  std::vector<Table> tables;
  if (points.size() < 2) return tables;
  const std::optional<std::uint64_t> tap = last_common_tap(points);
  if (!tap) return tables;
  std::vector<const PackingNumber*> numbers;  // each once, in the order of the parts
  for (const ComparedPoint& point : points) {
    for (const PackingNumber& number : point.numbers) {
      const bool is_known = std::ranges::any_of(numbers, [&](const PackingNumber* known) {
        return known->part == number.part && known->name == number.name;
      });
      if (!is_known) numbers.push_back(&number);
    }
  }
  std::vector<std::pair<std::string, ComparisonLines>> parts;
  for (const PackingNumber* const number : numbers) {
    auto part =
        std::ranges::find(parts, number->part, &std::pair<std::string, ComparisonLines>::first);
    if (part == parts.end()) part = parts.insert(parts.end(), {number->part, ComparisonLines{}});
    add_lines(points, *number, *tap, streams, part->second);
  }
  for (auto& [part, lines] : parts) {
    if (lines.line.empty()) continue;
    tables.push_back(table_of(part, *tap, points.size(), streams, std::move(lines)));
  }
  return tables;
}

}  // namespace jostle::inline ensemble
