#include "study/tables/points/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "engine/numbers.hpp"
#include "ensemble/analysis/sweeps/sweep_curve.hpp"
#include "ensemble/statistics/finite_text.hpp"
#include "study/bad_input.hpp"
#include "study/tables/analyse.hpp"
#include "study/tables/fits.hpp"
#include "study/tables/observable_series.hpp"
#include "study/tables/points/over_points.hpp"
#include "study/tables/points/point_scenes.hpp"
#include "study/tables/points/same_realizations.hpp"
#include "study/tables/points/swept_file.hpp"
#include "study/tables/points/swept_place.hpp"

namespace jostle::inline study {

namespace {

/// One sweep point of one file as a point of the curve.
struct Member {
  const ResultsFile* file = nullptr;
  std::uint32_t point = 0;
  const Scene* scene = nullptr;
  ReachedTaps reached;
  SweptPlace place;
  std::vector<double> realizations;  // with the value, by number; empty for other quantities
  double y = not_a_number;
  ErrorOf y_error;
  Column label;
  RandomKey key;
  std::string taps;                // whose mean the value is: "151 to 200"
  std::string strengths;           // where these differ in strength
  std::optional<Verdict> steady;   // verdict on these taps; none for too few
  std::string no_value;            // why it has none, where that is known
  std::string copies;              // text of ObservableSeries::copies()
  bool error_is_no_basis = false;  // a fit's, of too few realizations
  std::string law, conditions;     // a fit's, as in DerivedValue
};

/// The mean of the last taps that the points have in common, of each realization.
void set_values(std::span<Member> members, const std::string& observable,
                std::optional<std::uint64_t> last) {
  std::vector<ReachedTaps> reached;
  for (const Member& member : members) reached.push_back(member.reached);
  const SharedTaps shared = shared_taps(reached);
  for (std::size_t i = 0; i < members.size(); ++i) {
    Member& member = members[i];
    member.no_value = shared.reasons[i];
    if (!member.no_value.empty()) continue;
    const ObservableSeries series(*member.file, member.point, observable);
    const AnalysedSeries taps = last_taps(series, last, 4, 1, shared.rows[i]);
    const std::vector<double> means = series.means({taps.first_tap, taps.last_tap + 1});
    member.taps = fmt::format("{} to {}", taps.first_tap, taps.last_tap);
    member.strengths = several_strengths(*member.scene, taps);
    member.steady = steadiness(series, taps);
    member.realizations.assign(member.file->study().realizations, not_a_number);
    for (std::size_t r = 0; r < means.size(); ++r)
      member.realizations[series.realizations()[r]] = means[r];
  }
}

void set(Member& member, DerivedValue&& derived) {
  const std::string observable = member.label.units;
  member.y = derived.value;
  member.y_error = derived.error;
  member.label = std::move(derived.label);
  member.label.units = units_of_parameter(member.label.units, {observable, "taps"});
  member.no_value = std::move(derived.no_value);
  member.error_is_no_basis = derived.error_is_no_basis;
  member.taps = std::move(derived.taps);
  member.steady = derived.steady;
  member.law = std::move(derived.law);
  member.conditions = std::move(derived.conditions);
}

/// The point of the curve at this place of its axis, to the four digits that tables have of it,
/// where these leave one.
std::size_t point_at(const SweepCurve& curve, double x, const std::string& axis) {
  const auto in_table = [](double place) { return finite_text("{:.4g}", place); };
  std::optional<std::size_t> nearest;
  std::vector<std::size_t> alike;
  std::vector<std::string> places;
  for (std::size_t i = 0; i < curve.n_points(); ++i) {
    const double place = curve.x()[i];
    const double deviation = std::abs(place - x);
    const bool as_listed = deviation <= 5e-6 * std::abs(place);  // to the digits below
    if (as_listed && (!nearest || deviation < std::abs(curve.x()[*nearest] - x))) nearest = i;
    if (in_table(place) == in_table(x)) alike.push_back(i);
    places.push_back(finite_text("{:.6g}", place));
  }
  if (nearest) return *nearest;
  if (alike.size() == 1) return alike.front();
  throw BadInput(finite_text("reference {}: there is no such point; there are, of {}, {}", x, axis,
                             joined(places, ", ")));
}

/// Places of the points whose averaged taps have this verdict, with the settings that are swept
/// where these are not the places themselves: "0.1414 (dilate = 0.02)".
std::vector<std::string> places_of(std::span<const Member> members,
                                   const std::optional<Verdict>& verdict) {
  std::vector<std::string> places;
  for (const Member& member : members) {
    if (member.taps.empty() || member.steady != verdict) continue;
    const std::string& settings = member.file->study().points[member.point].label;
    places.push_back(finite_text("{:.4g}", member.place.x));
    if (!settings.empty() && !settings.starts_with(member.place.swept.name + " = "))
      places.back().append(" (").append(settings).append(")");
  }
  return places;
}

/// Means of beds that still move are kinetic: they depend on the number of taps, and so do results
/// of the curve. The verdicts on a maximum and a minimum report it.
void add_steadiness(std::span<const Member> members, Table& table) {
  if (std::ranges::all_of(members, [](const Member& member) { return member.taps.empty(); }))
    return;
  const auto moving = places_of(members, Verdict::not_reached);
  std::vector<std::string> open = places_of(members, Verdict::cannot_decide);
  const auto too_few = places_of(members, std::nullopt);
  open.insert(open.end(), too_few.begin(), too_few.end());
  const std::string axis = members.front().place.swept.name + " = ";
  std::string condition;
  if (!moving.empty())
    condition = "kinetic: the averaged taps still drift at " + axis + joined(moving, ", ");
  if (!open.empty()) {
    condition.append(condition.empty() ? "" : "; ")
        .append("the averaged taps are not shown to be steady at " + axis)
        .append(joined(open, ", "));
  }
  table.notes.emplace_back(
      "steady", condition.empty() ? "the averaged taps are steady at all points" : condition);
  if (condition.empty()) return;
  for (auto& [key, note] : table.notes)
    if (key == "maximum" || key == "minimum") note += "; " + condition;
}

/// Different texts of the points, each with the places that have it: "1:60 at dilate = 0.02,
/// 0.1; 1:10 at dilate = 0.3". Empty where all have the same.
std::string different(std::span<const Member> members, std::string Member::*kind) {
  std::vector<std::pair<std::string, std::vector<std::string>>> places;
  for (const Member& member : members) {
    const std::string& text = member.*kind;
    if (text.empty() || !member.no_value.empty()) continue;
    auto found = std::ranges::find(places, text, [](const auto& place) { return place.first; });
    if (found == places.end()) found = places.insert(found, {text, {}});
    found->second.push_back(finite_text("{:.4g}", member.place.x));
  }
  if (places.size() < 2) return "";
  std::vector<std::string> texts;
  for (const auto& [text, xs] : places)
    texts.push_back(
        fmt::format("{} at {} = {}", text, members.front().place.swept.name, joined(xs, ", ")));
  return joined(texts, "; ");
}

/// Parameters of fits to different ranges of t, or beside other fixed parameters, are different
/// numbers where the law is not the true one: the verdicts on a maximum and a minimum report it.
void add_conditions(std::span<const Member> members, Table& table) {
  const std::string conditions = different(members, &Member::conditions);
  if (conditions.empty()) return;
  table.notes.emplace_back("fits", "different: " + conditions);
  for (auto& [key, note] : table.notes)
    if (key == "maximum" || key == "minimum")
      note += "; the fits differ in their range of t or in what is fixed";
}

/// The averaged taps, and points without a value.
void add_notes(std::span<const Member> members, Table& table) {
  std::vector<std::string> taps, strengths;
  std::string left_out;
  for (const Member& member : members) {
    if (!member.strengths.empty() &&
        std::ranges::find(strengths, member.strengths) == strengths.end())
      strengths.push_back(member.strengths);
    if (!member.taps.empty() && std::ranges::find(taps, member.taps) == taps.end())
      taps.push_back(member.taps);
    if (!member.no_value.empty()) {
      left_out.append(left_out.empty() ? "" : "; ")
          .append(finite_text("at {:.4g}: {}", member.place.x, member.no_value));
    }
  }
  if (!taps.empty()) table.notes.emplace_back("taps", joined(taps, ", "));
  if (!strengths.empty()) table.notes.emplace_back("strengths", joined(strengths, "; "));
  if (!left_out.empty()) table.notes.emplace_back("left_out", left_out);
  std::string errors;
  const auto is_parameter = [](const Member& member) {
    return member.label.long_name == parameter_of_a_fit;
  };
  if (std::ranges::any_of(members, is_parameter))
    errors = "the error of a parameter is the longer side of the 68 % interval of its fit";
  if (std::ranges::any_of(members, &Member::error_is_no_basis))
    errors +=
        "; errors of fits to three realizations or fewer are not used: too many such fits set no "
        "limit, and the others scatter less than all would";
  if (!errors.empty()) table.notes.emplace_back("errors", errors);
}

Table curve_table(std::string name, std::span<const Member> members,
                  const std::optional<double>& reference) {
  if (const std::string laws = different(members, &Member::law); !laws.empty())
    throw BadInput(fmt::format(
        "the points have fits of different laws, {}: fit one law at every point", laws));
  std::vector<double> x, y;
  std::vector<ErrorOf> y_error;
  std::vector<std::vector<double>> realizations;
  std::vector<RandomKey> keys;
  for (const Member& member : members) {
    if (member.place.swept.name != members.front().place.swept.name) {
      throw BadInput(fmt::format("{} and {} are not one sweep", member.place.swept.name,
                                 members.front().place.swept.name));
    }
    x.push_back(member.place.x);
    y.push_back(member.y);
    y_error.push_back(member.y_error);
    realizations.push_back(member.realizations);
    keys.push_back(member.key);
  }
  const bool means = std::ranges::any_of(
      members, [](const Member& member) { return !member.realizations.empty(); });
  const SweepCurve curve =
      means ? SweepCurve(x, realizations, streams_of(keys)) : SweepCurve(x, y, y_error);
  std::optional<std::size_t> point;
  if (reference) point = point_at(curve, *reference, members.front().place.swept.name);
  const auto valued =
      std::ranges::find_if(members, [](const Member& member) { return member.no_value.empty(); });
  const Member& first = valued == members.end() ? members.front() : *valued;
  Table table = sweep_table(std::move(name), first.place.swept, first.label, curve, point);
  add_notes(members, table);
  add_conditions(members, table);
  add_steadiness(members, table);
  PointNotes copies;
  for (const Member& member : members) {
    copies.add(member.file->study().points[member.point].label, member.copies);
  }
  copies.note("copies", table);
  return table;
}

bool has_value(const Member& member) {
  return std::isfinite(member.y) ||
         std::ranges::any_of(member.realizations, [](double mean) { return std::isfinite(mean); });
}

/// The refusal of a sweep of which no point has a value.
std::string why_no_value(std::span<const Member> members,
                         const AnalysisRequest<SweepSettings>& request) {
  std::vector<std::pair<double, std::string>> reasons;
  for (const Member& member : members) reasons.emplace_back(member.place.x, member.no_value);
  return without_any_value(request.settings.quantity, request.observable,
                           members.front().place.swept.name, reasons);
}

/// Throws BadInput for a pointer to a value that is not swept and is the same at all points: the
/// curve would be one point.
void require_swept(std::span<const Member> members, const std::string& against) {
  if (!against.starts_with('/')) return;  // a name is one of what is swept
  std::vector<std::string> swept;
  for (const Member& member : members) {
    if (member.place.x != members.front().place.x) return;
    for (const auto& [pointer, value] : member.file->study().points[member.point].sweep_values) {
      const bool is_within =
          (pointer + "/").starts_with(against + "/") || (against + "/").starts_with(pointer + "/");
      if (is_within) return;
      if (std::ranges::find(swept, pointer) == swept.end()) swept.push_back(pointer);
    }
  }
  throw BadInput(fmt::format("\"{}\" is not swept (swept: {})", against,
                             swept.empty() ? "none" : joined(swept, ", ")));
}

std::vector<Member> members_of(std::span<SweptFile> files,
                               const AnalysisRequest<SweepSettings>& request) {
  const auto& [observable, settings] = request;
  std::vector<Member> members;
  for (SweptFile& swept : files) {
    const ResultsFile* const file = &swept.file();
    const PointScenes& scenes = swept.scenes();
    for (std::uint32_t point = 0; point < file->study().points.size(); ++point) {
      Member member;
      member.file = file;
      member.point = point;
      member.scene = &scenes.point_scene(point);
      const ObservableSeries series(*file, point, observable);
      member.label = series.label();
      member.copies = series.copies();
      const StudyPoint& studied = file->study().points[point];
      member.reached = {studied.taps, series.n_rows()};
      member.place = swept_place(studied, scenes, point, settings.against);
      if (member.reached.rows == 0) {
        member.no_value = "no realization has taps";
      } else if (settings.quantity != "value") {
        set(member, derived_value(swept.tables(), point, observable, settings.quantity));
      }
      member.key = {studied.seed,
                    scenes.point_scene(point).streams == Streams::matched ? 0 : studied.id};
      members.push_back(std::move(member));
    }
  }
  if (std::ranges::all_of(members, [](const Member& member) { return member.reached.rows == 0; }))
    throw BadInput("no realization has taps, at any sweep point");
  require_swept(members, settings.against);
  return members;
}

/// The curve of the points that share what does not vary with x, or why there is none.
Table table_of(const std::string& name, std::span<Member> members,
               const AnalysisRequest<SweepSettings>& request) {
  try {
    if (request.settings.quantity == "value")
      set_values(members, request.observable, request.settings.last);
    if (std::ranges::any_of(members, has_value))
      return curve_table(name, members, request.settings.reference);
    return {.name = name, .notes = {{"refused", why_no_value(members, request)}}};
  } catch (const BadArgument&) {
    throw;
  } catch (const BadInput& refusal) {
    return {.name = name, .notes = {{"refused", refusal.what()}}};
  }
}

std::string table_name(const AnalysisRequest<SweepSettings>& request) {
  std::string quantity = request.settings.quantity;
  std::ranges::replace(quantity, '/', '_');
  return fmt::format("sweep/{}/{}", request.observable, quantity);
}

}  // namespace

std::vector<Table> sweep_tables(std::span<const ResultsFile* const> files, const MadeTables& made,
                                const std::vector<AnalysisRequest<SweepSettings>>& requests) {
  std::vector<Table> tables;
  if (requests.empty()) return tables;
  std::vector<SweptFile> swept;
  try {
    if (files.size() > 1) require_different_ensembles(files);
    for (const ResultsFile* file : files) {
      swept.emplace_back(*file, file == files.front() ? made : MadeTables{});
    }
  } catch (const BadInput& refusal) {
    for (const auto& request : requests) {
      tables.push_back({.name = table_name(request), .notes = {{"refused", refusal.what()}}});
    }
    return tables;
  }
  for (const auto& request : requests) {
    const std::string name = table_name(request);
    try {
      std::map<std::string, std::vector<Member>> groups;
      std::vector<std::string> order;
      for (Member& member : members_of(swept, request)) {
        if (!groups.contains(member.place.fixed_values)) order.push_back(member.place.fixed_values);
        groups[member.place.fixed_values].push_back(std::move(member));
      }
      for (std::size_t i = 0; i < order.size(); ++i) {
        Table table = table_of(order.size() == 1 ? name : fmt::format("{}_{:04}", name, i),
                               groups[order[i]], request);
        if (!order[i].empty()) table.notes.emplace_back("at", order[i]);
        tables.push_back(std::move(table));
      }
    } catch (const BadArgument&) {
      throw;
    } catch (const BadInput& refusal) {
      tables.push_back({.name = name, .notes = {{"refused", refusal.what()}}});
    }
  }
  return tables;
}

}  // namespace jostle::inline study
