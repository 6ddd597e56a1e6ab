#include "study/results_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>

#include "results/disk/publish.hpp"
#include "results/disk/seal.hpp"
#include "results/run/live_run.hpp"

namespace jostle::inline study {

namespace {

namespace fs = std::filesystem;

/// By a pointer, or by as much of its end as is given; as tables label points, too ("dilate =
/// 0.05").
bool has_value(const StudyPoint& point, std::string wanted) {
  if (const auto equals = wanted.find(" = "); equals != wanted.npos) wanted.replace(equals, 3, "=");
  // A string without its quotes, and an object of one part by the part's name, name a value too.
  const auto is_value = [](const std::string& value, const std::string& text) {
    return value == text || value == '"' + text + '"' || value.starts_with("{\"" + text + "\":");
  };
  const auto equals = wanted.find('=');
  return std::ranges::any_of(point.sweep_values, [&](const auto& value) {
    if (equals == wanted.npos) return is_value(value.second, wanted);
    const std::string pointer = wanted.substr(0, equals);
    return (value.first == pointer || value.first.ends_with("/" + pointer)) &&
           is_value(value.second, wanted.substr(equals + 1));
  });
}

/// The sweep points that can be named, one per line.
std::string known(const Study& study) {
  constexpr std::size_t most_lines = 50;
  std::string lines;
  for (std::size_t i = 0; i < std::min(study.points.size(), most_lines); ++i) {
    lines += fmt::format("\n  {}", i);
    for (const auto& [pointer, value] : study.points[i].sweep_values) {
      lines += fmt::format("  {}={}", pointer, value);
    }
  }
  if (study.points.size() > most_lines) {
    lines += fmt::format("\n  ... and {} more", study.points.size() - most_lines);
  }
  return lines;
}

}  // namespace

bool is_results_file(const std::string& path) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  if (status.type() == fs::file_type::not_found) fail_on_disk(path, "open", ENOENT);
  if (!fs::is_regular_file(status)) return false;  // and nothing is taken out of a pipe
  return is_hdf5_file(path);
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
  std::vector<std::uint32_t> chosen;
  for (std::uint32_t i = 0; i < study.points.size(); ++i) {
    if (wanted == fmt::to_string(i)) return {i};  // a number is a point before it is a value
  }
  for (std::uint32_t i = 0; i < study.points.size(); ++i) {
    const bool is_label = wanted == study.points[i].label;
    if (wanted.empty() || is_label || has_value(study.points[i], wanted)) {
      chosen.push_back(i);
    }
  }
  if (chosen.empty()) {
    throw BadArgument(Argument::sweep_point, wanted, "there is none; the file has" + known(study));
  }
  return chosen;
}

}  // namespace jostle::inline study
