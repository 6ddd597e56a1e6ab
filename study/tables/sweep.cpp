#include "study/tables/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string_view>
#include <system_error>

#include "config/json/json_text.hpp"
#include "config/sweep.hpp"
#include "ensemble/analysis/sweeps/sweep_curve.hpp"
#include "ensemble/protocol_steps.hpp"
#include "fitting/fit.hpp"
#include "fitting/intervals/distributions.hpp"
#include "results/file/layout.hpp"
#include "study/bad_input.hpp"
#include "study/observable_series.hpp"
#include "study/scenes/point_scenes.hpp"
#include "study/tables/analyse.hpp"
#include "study/tables/over_points.hpp"

namespace jostle::inline study {

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// One sweep point of one file as a point of the curve.
struct Member {
  const ResultsFile* file = nullptr;
  std::uint32_t point = 0;
  ReachedTaps reached;
  double x = not_a_number;
  SweptValue swept;
  std::string others;                // values of the sweep that do not vary with x
  std::vector<double> realizations;  // of the value, by number; empty for other quantities
  double y = not_a_number;
  ErrorOf y_error;
  Column label;
  std::pair<std::uint64_t, std::uint64_t> stream;  // seed, point id
  std::string taps;                                // whose mean the value is: "151 to 200"
  std::string no_value;                            // why it has none, where that is known
  bool error_is_no_basis = false;                  // a fit's, of too few realizations
};

/// "/protocol/0/tap/dilate" -> 0.
std::optional<std::size_t> tap_line(std::string_view pointer) {
  constexpr std::string_view before = "/protocol/";
  if (!pointer.starts_with(before)) return std::nullopt;
  pointer.remove_prefix(before.size());
  std::size_t line = 0;
  const char* const last = pointer.data() + pointer.size();
  const auto [end, error] = std::from_chars(pointer.data(), last, line);
  const std::string_view rest(end, last);
  const bool of_tap = rest == "/tap" || rest.starts_with("/tap/");
  return error == std::errc{} && of_tap ? std::optional(line) : std::nullopt;
}

/// The name of an axis: "dilate", "width_1".
std::string axis_name(const std::string& pointer) {
  std::string name = short_name(pointer);
  std::ranges::replace(name, '/', '_');
  return name;
}

/// The pointer of the sweep that ends with a name, as labels of points and axes have it.
std::string pointer_named(const std::string& name, const StudyPoint& swept) {
  std::string found;
  for (const auto& [pointer, value] : swept.sweep_values) {
    if (!pointer.ends_with("/" + name) && axis_name(pointer) != name) continue;
    if (!found.empty()) {
      throw BadInput(
          fmt::format("{} and {} are swept: name one of them by its JSON pointer", found, pointer));
    }
    found = pointer;
  }
  if (found.empty()) {
    throw BadInput(fmt::format(
        "{} is neither a name of what is swept nor a JSON pointer, which begins with /", name));
  }
  return found;
}

/// What is swept, and the values of the sweep that do not vary with it.
void set_x(Member& member, const StudyPoint& swept, const PointScenes& scenes, std::uint32_t point,
           std::string against) {
  if (against.empty()) {
    against = swept.sweep_values.empty() ? "/protocol/0/tap" : swept.sweep_values.front().first;
  } else if (against.front() != '/') {
    against = pointer_named(against, swept);
  }
  for (const auto& [pointer, value] : swept.sweep_values) {
    if (pointer == against || scenes.vary_together(pointer, against)) continue;
    member.others.append(member.others.empty() ? "" : ", ")
        .append(pointer)
        .append(" = ")
        .append(value);
  }
  const Scene& scene = scenes.at(point);
  const auto line = tap_line(against);
  if (line && *line < scene.protocol.size() && !scene.protocol[*line].ramp) {
    const Control strength = control(scene.protocol[*line].tap);
    member.x = strength.value;
    member.swept = {strength.name, strength.units, "strength of the taps"};
    return;
  }
  const std::optional<Json> value = scenes.value_at(point, against);
  if (!value) throw BadInput(fmt::format("the scene has no value at {}", against));
  if (!value->is_number()) {
    throw BadInput(fmt::format("{} is not a number: {}", against, value->dump()));
  }
  member.x = value->number();
  member.swept = {axis_name(against), "1", against};
}

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
    member.realizations.assign(member.file->study().realizations, not_a_number);
    for (std::size_t r = 0; r < means.size(); ++r)
      member.realizations[series.realizations()[r]] = means[r];
  }
}

const Quantity* quantity_named(const Table& table, const std::string& name) {
  for (const Quantity& quantity : table.quantities) {
    if (quantity.name == name) return &quantity;
  }
  return nullptr;
}

double number_at(const Quantity* quantity, std::size_t place) {
  const auto* numbers = quantity ? std::get_if<std::vector<double>>(&quantity->values) : nullptr;
  return numbers && place < numbers->size() ? (*numbers)[place] : not_a_number;
}

/// An error as tables hold it; where they do not give its degrees of freedom it is taken for known.
ErrorOf error_of(double error, double dof) {
  if (std::isnan(error)) return {};
  return {error, std::isnan(dof) ? std::numeric_limits<double>::infinity() : dof};
}

/// A single value of an analysis with its error.
bool take_single(Member& member, const Table& table, const std::string& name) {
  const Quantity* const found = quantity_named(table, name);
  if (!found || !found->axes.empty()) return false;
  member.y = number_at(found, 0);
  member.y_error = error_of(number_at(quantity_named(table, name + "_error"), 0),
                            number_at(quantity_named(table, name + "_dof"), 0));
  member.label = {name, found->units, found->long_name, found->source};
  return true;
}

std::string text_at(const Quantity* quantity, std::size_t place) {
  const auto* texts = quantity ? std::get_if<std::vector<std::string>>(&quantity->values) : nullptr;
  return texts && place < texts->size() ? (*texts)[place] : "";
}

/// Of three realizations and fewer too many points have no closed interval, and those that have one
/// scatter less than they should: their errors are no basis of a curve's.
constexpr double fewest_dof_of_a_point = 3;

/// The error of which Student's t makes the longer side of the 68 % interval of the fit.
ErrorOf error_of_interval(const Table& table, std::size_t place) {
  const double dof = number_at(quantity_named(table, "error_dof"), 0);
  const double value = number_at(quantity_named(table, "value"), place);
  const std::size_t end = 2 * place;  // [parameter, level], 68 % first
  const double side = std::max(number_at(quantity_named(table, "interval_upper"), end) - value,
                               value - number_at(quantity_named(table, "interval_lower"), end));
  if (!(side > 0 && dof >= fewest_dof_of_a_point)) return {};
  return {side / two_sided(interval_levels[0], dof), dof};
}

bool take_parameter(Member& member, const Table& table, const std::string& name) {
  const auto point = parameter_point(table, name);
  if (!point) return false;
  member.y = point->value;
  member.y_error = point->error;
  member.no_value = point->no_value;
  member.error_is_no_basis = point->no_value.empty() && !point->error.known();
  member.label = {name, "1", "parameter of a fit", ""};
  return true;
}

/// "kww/rho_inf" of fits, "steady/sigma" of analyses.
void set_derived(Member& member, std::span<const Table> analyses, std::span<const Table> fits,
                 std::uint32_t point, const std::string& observable, const std::string& quantity) {
  const std::size_t slash = quantity.find('/');
  if (slash == std::string::npos) {
    throw BadInput(
        fmt::format("{}: expected value, or analysis/quantity or law/parameter", quantity));
  }
  const std::string kind = quantity.substr(0, slash), name = quantity.substr(slash + 1);
  for (const Table& table : analyses) {
    if (table.name != fmt::format("{}/{}/{}", point_name(point), kind, observable)) continue;
    if (take_single(member, table, name)) return;
  }
  for (const Table& table : fits) {
    if (table.name != fmt::format("{}/{}/{}", point_name(point), observable, kind)) continue;
    if (take_parameter(member, table, name)) return;
  }
  throw BadInput(
      fmt::format("{} of {} is not kept for sweep point {}: make the analysis or the fit first",
                  quantity, observable, point));
}

Streams streams_of(std::span<const Member> members) {
  const bool paired = std::ranges::all_of(
      members, [&](const Member& member) { return member.stream == members.front().stream; });
  return paired ? Streams::matched : Streams::independent;
}

/// The point of the curve at this place of its axis, to the four digits that tables have of it,
/// where these leave one.
std::size_t point_at(const SweepCurve& curve, double x, const std::string& axis) {
  const auto in_table = [](double place) { return fmt::format("{:.4g}", place); };
  std::vector<std::size_t> alike;
  std::vector<std::string> places;
  for (std::size_t i = 0; i < curve.n_points(); ++i) {
    const double place = curve.x()[i];
    if (std::abs(place - x) <= 5e-6 * std::abs(place)) return i;  // to the digits listed below
    if (in_table(place) == in_table(x)) alike.push_back(i);
    places.push_back(fmt::format("{:.6g}", place));
  }
  if (alike.size() == 1) return alike.front();
  throw BadInput(fmt::format("reference {}: there is no such point; there are, of {}, {}", x, axis,
                             joined(places, ", ")));
}

/// Which taps are averaged, and which points have no value.
void add_notes(std::span<const Member> members, Table& table) {
  std::vector<std::string> taps;
  std::string left_out;
  for (const Member& member : members) {
    if (!member.taps.empty() && std::ranges::find(taps, member.taps) == taps.end())
      taps.push_back(member.taps);
    if (!member.no_value.empty()) {
      left_out.append(left_out.empty() ? "" : "; ")
          .append(fmt::format("at {:.4g}: {}", member.x, member.no_value));
    }
  }
  if (!taps.empty()) table.notes.emplace_back("taps", joined(taps, ", "));
  if (!left_out.empty()) table.notes.emplace_back("left_out", left_out);
  if (std::ranges::any_of(members, &Member::error_is_no_basis)) {
    table.notes.emplace_back("errors",
                             "those of fits to three realizations or fewer are not taken: too many "
                             "such fits set no limit, and the others scatter less than all would");
  }
}

Table curve_table(std::string name, std::span<const Member> members,
                  const std::optional<double>& reference) {
  std::vector<double> x, y;
  std::vector<ErrorOf> y_error;
  std::vector<std::vector<double>> realizations;
  for (const Member& member : members) {
    if (member.swept.name != members.front().swept.name) {
      throw BadInput(fmt::format("{} and {} are not one sweep", member.swept.name,
                                 members.front().swept.name));
    }
    x.push_back(member.x);
    y.push_back(member.y);
    y_error.push_back(member.y_error);
    realizations.push_back(member.realizations);
  }
  const bool means = std::ranges::any_of(
      members, [](const Member& member) { return !member.realizations.empty(); });
  const SweepCurve curve =
      means ? SweepCurve(x, realizations, streams_of(members)) : SweepCurve(x, y, y_error);
  std::optional<std::size_t> point;
  if (reference) point = point_at(curve, *reference, members.front().swept.name);
  Table table =
      sweep_table(std::move(name), members.front().swept, members.front().label, curve, point);
  add_notes(members, table);
  return table;
}

/// A file with what is read of it once for all sweeps.
class SweptFile {
 public:
  SweptFile(const ResultsFile& file, const MadeTables& made)
      : file_(file), scenes_(file), made_(made) {}

  const ResultsFile& file() const { return file_; }
  const PointScenes& scenes() const { return scenes_; }
  /// Those just made, then those that the file keeps.
  const MadeTables& tables() {
    if (!kept_are_read_) {
      kept_are_read_ = true;
      append(made_.analyses, file_.tables("analysis"));
      append(made_.fits, file_.tables("fits"));
    }
    return made_;
  }

 private:
  static void append(std::vector<Table>& tables, const std::vector<Table>& more) {
    tables.insert(tables.end(), more.begin(), more.end());
  }

  const ResultsFile& file_;
  PointScenes scenes_;
  MadeTables made_;
  bool kept_are_read_ = false;
};

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
      const ObservableSeries series(*file, point, observable);
      member.label = series.label();
      const StudyPoint& studied = file->study().points[point];
      member.reached = {studied.taps, series.n_rows()};
      set_x(member, studied, scenes, point, settings.against);
      if (member.reached.rows == 0) {
        member.no_value = "no realization has taps";
      } else if (settings.quantity != "value") {
        const MadeTables& tables = swept.tables();
        set_derived(member, tables.analyses, tables.fits, point, observable, settings.quantity);
      }
      member.stream = {studied.seed, scenes.at(point).streams == Streams::matched ? 0 : studied.id};
      members.push_back(std::move(member));
    }
  }
  if (std::ranges::all_of(members, [](const Member& one) { return one.reached.rows == 0; }))
    throw BadInput("no realization has taps, at any sweep point");
  return members;
}

std::string table_name(const AnalysisRequest<SweepSettings>& request) {
  std::string quantity = request.settings.quantity;
  std::ranges::replace(quantity, '/', '_');
  return fmt::format("sweep/{}/{}", request.observable, quantity);
}

}  // namespace

SweptPlace swept_place(const StudyPoint& swept, const PointScenes& scenes, std::uint32_t point,
                       const std::string& against) {
  Member member;
  set_x(member, swept, scenes, point, against);
  return {member.x, member.swept.name, member.swept.units, member.others};
}

std::optional<ParameterPoint> parameter_point(const Table& fit, const std::string& name) {
  for (const Quantity& axis : fit.axes) {
    const auto* names = std::get_if<std::vector<std::string>>(&axis.values);
    if (axis.name != "parameter" || !names) continue;
    const auto place = static_cast<std::size_t>(std::ranges::find(*names, name) - names->begin());
    if (place == names->size()) return std::nullopt;
    const std::string found = text_at(quantity_named(fit, "identifiability"), place);
    if (found == name_of(Identifiability::identified) || found == name_of(Identifiability::wide))
      return ParameterPoint{number_at(quantity_named(fit, "value"), place),
                            error_of_interval(fit, place), ""};
    return ParameterPoint{not_a_number,
                          {},
                          found.empty() ? "fitted by an earlier version: fit it again"
                                        : text_at(quantity_named(fit, "statement"), place)};
  }
  return std::nullopt;
}

std::vector<Table> sweep_tables(std::span<const ResultsFile* const> files, const MadeTables& made,
                                const std::vector<AnalysisRequest<SweepSettings>>& requests) {
  std::vector<Table> tables;
  if (requests.empty()) return tables;
  std::vector<SweptFile> swept;
  try {
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
        if (!groups.contains(member.others)) order.push_back(member.others);
        groups[member.others].push_back(std::move(member));
      }
      for (std::size_t i = 0; i < order.size(); ++i) {
        if (request.settings.quantity == "value")
          set_values(groups[order[i]], request.observable, request.settings.last);
        Table table = curve_table(order.size() == 1 ? name : fmt::format("{}_{:04}", name, i),
                                  groups[order[i]], request.settings.reference);
        if (!order[i].empty()) table.notes.emplace_back("at", order[i]);
        tables.push_back(std::move(table));
      }
    } catch (const BadInput& refusal) {
      tables.push_back({.name = name, .notes = {{"refused", refusal.what()}}});
    }
  }
  return tables;
}

}  // namespace jostle::inline study
