#include "study/results_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <numeric>
#include <optional>

#include "config/json/suggestion.hpp"
#include "config/sweep.hpp"
#include "results/disk/error.hpp"
#include "results/disk/publish.hpp"
#include "results/disk/seal.hpp"
#include "results/run/live_run.hpp"
#include "study/number_text.hpp"

namespace jostle::inline study {

namespace {

namespace fs = std::filesystem;

/// A string without its quotes, and an object of one part by the part's name, name a value too.
bool is_value(const std::string& value, const std::string& text) {
  return value == text || value == '"' + text + '"' || value.starts_with("{\"" + text + "\":");
}

/// By a pointer, or by as much of its end as is given; as tables label points, too ("dilate =
/// 0.05").
bool has_value(const StudyPoint& point, std::string wanted) {
  if (const auto equals = wanted.find(" = "); equals != wanted.npos) wanted.replace(equals, 3, "=");
  const auto equals = wanted.find('=');
  return std::ranges::any_of(point.sweep_values, [&](const auto& value) {
    if (equals == wanted.npos) return is_value(value.second, wanted);
    const std::string pointer = wanted.substr(0, equals);
    return (value.first == pointer || value.first.ends_with("/" + pointer)) &&
           is_value(value.second, wanted.substr(equals + 1));
  });
}

constexpr const char* number_prefix = "number=";

/// True if the scene names the point, whose label is otherwise made of its values.
bool has_own_label(const StudyPoint& point) {
  return !std::ranges::all_of(point.sweep_values, [&](const auto& value) {
    return point.label.find(" = " + value.second) != std::string::npos;
  });
}

/// The sweep points that can be named, one per line.
std::string known(const Study& study) {
  constexpr std::size_t most_lines = 50;
  std::string lines;
  for (std::size_t i = 0; i < std::min(study.points.size(), most_lines); ++i) {
    lines += fmt::format("\n  {}", i);
    if (has_own_label(study.points[i])) lines += "  " + study.points[i].label;
    for (const auto& [pointer, value] : study.points[i].sweep_values) {
      lines += fmt::format("  {}={}", pointer, value);
    }
  }
  if (study.points.size() > most_lines) {
    lines += fmt::format("\n  ... and {} more", study.points.size() - most_lines);
  }
  return lines;
}

/// The nearest label, where a label and not a number was written.
std::string nearest_label(const Study& study, const std::string& wanted) {
  if (read_number(wanted)) return {};
  std::vector<std::string> labels;
  for (const StudyPoint& point : study.points) labels.push_back(point.label);
  return did_you_mean(wanted, labels);
}

std::optional<std::uint32_t> point_numbered(const Study& study, const std::string& text) {
  for (std::uint32_t i = 0; i < study.points.size(); ++i)
    if (text == fmt::to_string(i)) return i;
  return std::nullopt;
}

std::vector<std::uint32_t> points_with(const Study& study, const std::string& label_or_value) {
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < study.points.size(); ++i) {
    const StudyPoint& point = study.points[i];
    if (label_or_value == point.label || has_value(point, label_or_value)) found.push_back(i);
  }
  return found;
}

/// A text that names a point by a value, "lift=2", and not by its number; of a label the number.
std::string by_value(const Study& study, std::uint32_t point, const std::string& text) {
  for (const auto& [pointer, value] : study.points[point].sweep_values) {
    if (!is_value(value, text)) continue;
    const std::string name = short_name(pointer);
    const bool is_shared =
        std::ranges::count_if(study.points[point].sweep_values, [&](const auto& swept) {
          return swept.first.ends_with("/" + name);
        }) > 1;
    return fmt::format("{}={}", is_shared ? pointer : name, text);
  }
  return fmt::format("{}{}", number_prefix, point);
}

/// `number`: of the point that has `wanted` as its number; `named`: those with it as a value.
void require_unambiguous(const Study& study, const std::string& wanted, std::uint32_t number,
                         std::span<const std::uint32_t> named) {
  const auto second = std::ranges::find_if(named, [&](std::uint32_t i) { return i != number; });
  if (second == named.end()) return;
  throw BadArgument(
      Argument::sweep_point, wanted,
      fmt::format("{} is the number of a sweep point ({}) and a value or label of another, number "
                  "{} ({}): write {}{} or {}",
                  wanted, study.points[number].label, *second, study.points[*second].label,
                  number_prefix, number, by_value(study, *second, wanted)));
}

}  // namespace

bool is_results_file(const std::string& path) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  if (status.type() == fs::file_type::not_found) fail_on_disk(path, "open", ENOENT);
  if (!fs::is_regular_file(status)) return false;  // and nothing is taken out of a pipe
  return is_hdf5_file(path);
}

void reject_input(const std::string& path, const std::string& reason) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored))
    throw ResultsError(path, "it is a folder, not a file: name a file in it");
  throw ResultsError(path, reason);
}

bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error)) return true;
  const fs::path first = fs::weakly_canonical(fs::absolute(a), error);
  if (error) return false;
  const fs::path second = fs::weakly_canonical(fs::absolute(b), error);
  return !error && first == second;
}

NoTapsYet::NoTapsYet(const std::string& path, Live live)
    : BadInput(
          fmt::format("{}: its run is not finished or was killed, and {}", path,
                      live == Live::yes ? "it has no checkpoint yet" : "its file has no taps yet")),
      path_(path),
      live_(live) {}

ResultsFile open_results(const std::string& path, Live live) {
  ResultsFile file = live == Live::yes ? live_results(path) : ResultsFile(path);
  if (file.state() == RunState::running) throw NoTapsYet(path, live);
  return file;
}

void require_different(std::span<const std::string> paths) {
  for (std::size_t i = 0; i < paths.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (!is_same_file(paths[i], paths[j])) continue;
      throw BadInput(fmt::format("{} is given twice, and counts once", paths[i]));
    }
  }
}

void require_different_runs(std::span<const ResultsFile> files) {
  for (std::size_t i = 0; i < files.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (files[i].run_id() != files[j].run_id()) continue;
      throw BadInput(fmt::format("{} and {} hold the same run, which counts once", files[j].path(),
                                 files[i].path()));
    }
  }
}

std::vector<std::uint32_t> chosen_points(const Study& study, const std::string& wanted) {
  if (wanted.empty()) {
    std::vector<std::uint32_t> all(study.points.size());
    std::iota(all.begin(), all.end(), 0U);
    return all;
  }
  if (wanted.starts_with(number_prefix)) {
    const auto number = point_numbered(study, wanted.substr(std::strlen(number_prefix)));
    if (number) return {*number};
  }
  std::vector<std::uint32_t> chosen = points_with(study, wanted);
  if (const auto number = point_numbered(study, wanted)) {
    require_unambiguous(study, wanted, *number, chosen);
    return {*number};
  }
  if (!chosen.empty()) return chosen;
  throw BadArgument(Argument::sweep_point, wanted,
                    fmt::format("there is none.{} The sweep points are{}",
                                nearest_label(study, wanted), known(study)));
}

std::uint32_t chosen_point(const Study& study, const std::string& wanted) {
  if (wanted.empty()) return 0;
  const std::vector<std::uint32_t> chosen = chosen_points(study, wanted);
  if (chosen.size() == 1) return chosen.front();
  throw BadArgument(
      Argument::sweep_point, wanted,
      fmt::format("points {} have this value, and the command uses only one point: choose it by "
                  "number, as {}{}",
                  fmt::join(chosen, ", "), number_prefix, chosen.front()));
}

}  // namespace jostle::inline study
