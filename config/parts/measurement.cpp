#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "config/parts/kinds.hpp"
#include "config/parts/parts.hpp"
#include "ensemble/statistics/finite_text.hpp"

namespace jostle::inline config {

namespace {

constexpr std::size_t longest_name = 64;
constexpr double highest = 1e6;
constexpr double widest_taper = 10;  // diameters

struct Bounds {
  double low, high;
};

std::optional<Bounds> read_bounds(const Reader& in, double most) {
  if (!in.is_list(2, 2, "numbers, low and high")) return std::nullopt;
  const auto low = in.element(0).number(between(0, most));
  const auto high = in.element(1).number(between(0, most));
  if (!low || !high) return std::nullopt;
  if (*low < *high) return Bounds{*low, *high};
  in.fault(finite_text("the window from {} to {} is empty: the first number must be the lower",
                       *low, *high));
  return std::nullopt;
}

QuantileWindow read_quantiles(const Reader& in) {
  const auto bounds = read_bounds(in, 1);
  return bounds ? QuantileWindow{bounds->low, bounds->high} : QuantileWindow{};
}

/// Letters, digits and underscores, beginning with a lower-case letter: a name in a file.
bool is_name(const std::string& name) {
  const auto lower = [](char c) { return c >= 'a' && c <= 'z'; };
  return !name.empty() && name.size() <= longest_name && lower(name.front()) &&
         std::all_of(name.begin(), name.end(),
                     [&](char c) { return lower(c) || (c >= '0' && c <= '9') || c == '_'; });
}

Observable read_bulk_fraction(const Reader& in) {
  BulkFraction bulk;
  if (!in.is_object_of({"name", "heights", "quantiles", "taper"})) return bulk;
  if (const auto name = in.find("name")) {
    bulk.name = name->text().value_or(bulk.name);
    if (!is_name(bulk.name)) {
      name->fault(
          fmt::format("expected lower-case letters, digits and underscores, a letter "
                      "first, at most {} of them",
                      longest_name));
    }
  }
  const auto heights = in.find("heights");
  const auto quantiles = in.find("quantiles");
  if (heights) bulk.window = read_heights(*heights);
  if (quantiles) bulk.window = read_quantiles(*quantiles);
  if (heights && quantiles) in.fault("expected only one of the keys heights, quantiles");
  in.read("taper", bulk.taper, between(0, widest_taper));
  const auto* window = std::get_if<HeightWindow>(&bulk.window);
  if (window && window->low < 0.5 * bulk.taper) {
    in.fault(
        finite_text("a window from {} tapered over {} begins below the floor: begin at {} or more",
                    window->low, bulk.taper, 0.5 * bulk.taper));
  }
  return bulk;
}

Observable read_corrected_fraction(const Reader& in) {
  CorrectedFraction corrected;
  if (in.is_object_of({"depth"})) in.read("depth", corrected.depth, above(0, 1));
  return corrected;
}

template <class Plain>
Observable read_plain(const Reader& in) {
  in.is_object_of({});
  return Plain{};
}

/// Of an observable without settings: its name alone stands for it.
template <class Plain>
Json written_plain(const Plain&) {
  return nullptr;
}

Json written_corrected_fraction(const CorrectedFraction& corrected) {
  return {{"depth", plain_number(corrected.depth)}};
}

Json written_bulk_fraction(const BulkFraction& bulk) {
  Json settings{{"name", bulk.name}};
  settings.update(written(bulk.window));
  if (bulk.taper > 0) settings["taper"] = plain_number(bulk.taper);
  return settings;
}

constexpr Kinds<Observable> observable_kinds{
    {"mean_height", read_plain<MeanHeight>, written_plain<MeanHeight>},
    {"bottom_fraction", read_plain<BottomFraction>, written_plain<BottomFraction>},
    {"corrected_fraction", read_corrected_fraction, written_corrected_fraction},
    {"bulk_fraction", read_bulk_fraction, written_bulk_fraction},
    {"crystalline_fraction", read_plain<CrystallineFraction>, written_plain<CrystallineFraction>},
    {"grown_layers", read_plain<GrownLayers>, written_plain<GrownLayers>},
    {"ordered_height", read_plain<OrderedHeight>, written_plain<OrderedHeight>}};

Observable read_observable(const Reader& in) {
  const auto choice = in.named_choice(names_of(observable_kinds));
  if (!choice) return MeanHeight{};
  return read_kind(observable_kinds, *choice);
}

Json written(const Observable& observable) {
  const bool plain = written_settings(observable_kinds, observable).is_null();
  return plain ? Json(name_of(observable_kinds, observable))
               : written_kind(observable_kinds, observable);
}

std::vector<std::uint64_t> read_tap_list(const Reader& in) {
  std::set<std::uint64_t> taps;
  if (!in.is_list(0, 100'000, "tap numbers")) return {};
  for (std::size_t i = 0; i < in.value().size(); ++i) {
    const auto tap = in.element(i).whole_number(0, most_taps);
    if (tap && !taps.insert(*tap).second) {
      in.element(i).fault(fmt::format("tap {} is listed twice", *tap));
    }
  }
  return {taps.begin(), taps.end()};
}

LogarithmicTaps read_logarithmic_taps(const Reader& in) {
  LogarithmicTaps grid;
  if (!in.is_object_of({"log", "also"})) return grid;
  if (const auto log = in.find("log")) {
    if (log->is_object_of({"from", "to", "per_decade"})) {
      if (!log->find("to")) log->missing("to", "the tap at which the grid ends");
      log->read_whole("from", grid.from, 1, most_taps);
      log->read_whole("to", grid.to, 1, most_taps);
      log->read_whole("per_decade", grid.per_decade, 1, 100);
    }
    if (log->sound() && grid.from > grid.to) {
      log->fault(fmt::format("the grid from {} to {} is empty: from must not be above to",
                             grid.from, grid.to));
    }
  } else {
    in.missing("log", "an object with the keys from, to, per_decade");
  }
  if (const auto also = in.find("also")) grid.also = read_tap_list(*also);
  return grid;
}

struct KeptPart {
  const char* name;
  bool SnapshotChoice::*kept;
  bool of_grains = false, beside_positions = false, on_request = false;
};
constexpr KeptPart kept_parts[] = {
    {"positions", &SnapshotChoice::positions},
    {"coordination", &SnapshotChoice::coordination},
    {"height_histogram", &SnapshotChoice::height_histogram},
    {"velocities", &SnapshotChoice::velocities, true, true},
    {"contacts", &SnapshotChoice::contacts, true, true},
    {"granular_temperature", &SnapshotChoice::granular_temperature, true},
    {"forces", &SnapshotChoice::forces, true},
    {"driven_temperature", &SnapshotChoice::driven_temperature, true, false, true}};

void read_keep(const Reader& in, SnapshotChoice& snapshots) {
  std::vector<std::string> names;
  for (const KeptPart& part : kept_parts) names.emplace_back(part.name);
  if (!in.is_list(0, names.size(), "of the strings " + listed(names))) return;
  std::set<std::string> kept;
  for (std::size_t i = 0; i < in.value().size(); ++i) {
    const Reader element = in.element(i);
    const auto what = element.one_of(names);
    if (what && !kept.insert(*what).second) element.fault(*what + " is listed twice");
  }
  for (const KeptPart& part : kept_parts) snapshots.*part.kept = kept.contains(part.name);
}

}  // namespace

HeightWindow read_heights(const Reader& in) {
  const auto bounds = read_bounds(in, highest);
  return bounds ? HeightWindow{bounds->low, bounds->high} : HeightWindow{};
}

Json written_bounds(double low, double high) {
  return Json::array({plain_number(low), plain_number(high)});
}

Window read_window(const Reader& in) {
  const auto window = in.choice({"heights", "quantiles"});
  if (!window) return QuantileWindow{};
  if (window->name == "heights") return read_heights(window->settings);
  return read_quantiles(window->settings);
}

std::vector<Observable> read_observables(const Reader& in) {
  std::vector<Observable> observables;
  if (!in.is_list(0, 100, "observables")) return observables;
  for (std::size_t i = 0; i < in.value().size(); ++i) {
    observables.push_back(read_observable(in.element(i)));
  }
  return observables;
}

TapChoice read_taps(const Reader& in) {
  if (in.value().is_object()) return read_logarithmic_taps(in);
  return read_tap_list(in);
}

SnapshotChoice default_snapshots(bool grains) {
  SnapshotChoice snapshots;
  for (const KeptPart& part : kept_parts)
    snapshots.*part.kept = (grains || !part.of_grains) && !part.on_request;
  return snapshots;
}

std::optional<std::string> keep_fault(const SnapshotChoice& snapshots, bool grains) {
  for (const KeptPart& part : kept_parts) {
    if (!(snapshots.*part.kept)) continue;
    if (part.of_grains && !grains)
      return fmt::format(
          "\"{}\" is of discrete elements only: Monte Carlo has no times and no forces; leave it "
          "out",
          part.name);
    if (part.beside_positions && !snapshots.positions)
      return fmt::format("\"{}\" stands beside positions: keep positions, too", part.name);
  }
  return std::nullopt;
}

SnapshotChoice read_snapshots(const Reader& in, bool grains) {
  SnapshotChoice snapshots = default_snapshots(grains);
  if (!in.is_object_of({"taps", "keep", "contact_cut", "bin_width"})) return snapshots;
  if (const auto taps = in.find("taps")) snapshots.taps = read_taps(*taps);
  if (const auto keep = in.find("keep")) read_keep(*keep, snapshots);
  in.read("contact_cut", snapshots.contact_cut, between(1, 3));
  in.read("bin_width", snapshots.bin_width, between(0.001, 10));
  return snapshots;
}

std::vector<Observable> default_observables() {
  return {MeanHeight{}, BottomFraction{}, CorrectedFraction{}, BulkFraction{}};
}

Json written(const Window& window) {
  if (const auto* heights = std::get_if<HeightWindow>(&window)) {
    return {{"heights", written_bounds(heights->low, heights->high)}};
  }
  const auto& quantiles = std::get<QuantileWindow>(window);
  return {{"quantiles", written_bounds(quantiles.low, quantiles.high)}};
}

Json written(const std::vector<Observable>& observables) {
  Json list = Json::array();
  for (const Observable& observable : observables) list.push_back(written(observable));
  return list;
}

Json written_taps(const TapChoice& choice) {
  if (const auto* grid = std::get_if<LogarithmicTaps>(&choice)) {
    return {{"log", {{"from", grid->from}, {"to", grid->to}, {"per_decade", grid->per_decade}}},
            {"also", grid->also}};
  }
  return std::get<std::vector<std::uint64_t>>(choice);
}

Json written(const SnapshotChoice& snapshots) {
  Json out;
  out["taps"] = written_taps(snapshots.taps);
  out["keep"] = Json::array();
  for (const KeptPart& part : kept_parts)
    if (snapshots.*part.kept) out["keep"].push_back(part.name);
  out["contact_cut"] = plain_number(snapshots.contact_cut);
  out["bin_width"] = plain_number(snapshots.bin_width);
  return out;
}

}  // namespace jostle::inline config
