#include "study/planning/shards.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <utility>

#include "results/disk/error.hpp"
#include "study/bad_input.hpp"
#include "study/running/stored_scene.hpp"

namespace jostle::inline study {
namespace {

namespace fs = std::filesystem;

/// Numbers in names are compared as numbers: 2.h5 comes before 10.h5.
bool comes_before(const std::string& a, const std::string& b) {
  const auto is_digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  const auto number_at = [&](const std::string& text, std::size_t index) {
    std::size_t end = index;
    while (end < text.size() && is_digit(text[end])) ++end;
    while (index + 1 < end && text[index] == '0') ++index;
    return std::pair(text.substr(index, end - index), end);
  };
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      const auto [first, end_of_one] = number_at(a, i);
      const auto [second, end_of_other] = number_at(b, j);
      if (first.size() != second.size()) return first.size() < second.size();
      if (first != second) return first < second;
      i = end_of_one;
      j = end_of_other;
    } else {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i, ++j;
    }
  }
  return a.size() - i != b.size() - j ? a.size() - i < b.size() - j : a < b;
}

std::vector<std::string> files_in(const std::string& folder) {
  std::vector<std::string> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (entry->path().extension() == ".h5" && !entry->is_directory(error))
      files.push_back(entry->path().string());
  }
  if (error) throw ResultsError(folder, "cannot list: " + error.message());
  std::ranges::sort(files, comes_before);
  return files;
}

ShardState state_of(const RunStatus& status) {
  if (status.owner && status.owner->alive) return ShardState::running;
  if (status.state == RunState::complete && status.parts_bytes == 0) return ShardState::done;
  return status.owner ? ShardState::dead : ShardState::stopped;  // a killed process leaves its lock
}

/// Finished and remaining work of a sweep point, over all shares. `rows` counts those whose cost
/// was reported.
struct PointWork {
  double seconds = 0;
  std::uint64_t rows = 0, rows_left = 0;
};

/// A study while its files are read.
struct Gathered {
  ShardsStatus status;
  std::vector<PointWork> points;
};

void gather(Gathered& study, const std::string& path, const LiveLook& look) {
  const auto& [file, status] = look;
  ShardStatus& place = study.status.shards.at(file.shard().index - 1);
  if (place.state != ShardState::missing) return study.status.twice.push_back(path);
  ShardStatus shard{
      .index = file.shard().index, .state = state_of(status), .path = path, .owner = status.owner};
  if (!file.provenance().empty()) shard.command = file.provenance().back().command_line;
  for (const RealizationSummary& realization : status.realizations) {
    const std::uint64_t taps = file.study().points[realization.id.point].taps, rows = taps + 1;
    PointWork& point = study.points[realization.id.point];
    ++shard.realizations;
    shard.all_taps += taps;
    shard.taps += realization.taps();
    point.seconds += realization.work.seconds;
    if (realization.work.seconds > 0) point.rows += realization.rows;
    if (realization.status == RealizationStatus::done) ++shard.done;
    if (realization.status == RealizationStatus::failed) ++shard.failed;
    const bool ended = realization.status == RealizationStatus::failed;
    point.rows_left += ended ? 0 : rows - std::min(realization.rows, rows);
  }
  place = std::move(shard);
}

/// The path of a shard's file, if it is named as that of another shard is: by the last number of
/// its name.
std::optional<std::string> path_like(const ShardStatus& model_shard, std::uint32_t index) {
  const std::size_t name = model_shard.path.find_last_of('/') + 1;  // 0 without a folder
  const std::size_t last = model_shard.path.find_last_of("0123456789", model_shard.path.rfind('.'));
  if (last == std::string::npos || last < name) return std::nullopt;
  std::size_t first = last;
  while (first > name && std::isdigit(static_cast<unsigned char>(model_shard.path[first - 1])) != 0)
    --first;
  const std::string number = model_shard.path.substr(first, last + 1 - first);
  const std::string padded = fmt::format("{:0{}}", model_shard.index, number.size());
  if (number != padded) return std::nullopt;
  return model_shard.path.substr(0, first) + fmt::format("{:0{}}", index, number.size()) +
         model_shard.path.substr(last + 1);
}

/// Files that cannot be read still hold shards: those in their names, otherwise any.
void place_unreadable(ShardsStatus& study, const std::vector<BadFile>& bad_files) {
  std::vector<std::string> paths;
  for (const BadFile& file : bad_files) paths.push_back(file.path);
  const auto known = std::ranges::find_if(study.shards, [](const ShardStatus& shard) {
    return !shard.path.empty() && path_like(shard, shard.index);
  });
  if (known != study.shards.end()) {
    const ShardStatus pattern = *known;
    for (ShardStatus& shard : study.shards) {
      if (shard.state != ShardState::missing) continue;
      const auto found = std::ranges::find(paths, *path_like(pattern, shard.index));
      if (found == paths.end()) continue;
      shard.state = ShardState::unreadable;
      shard.path = *found;
      paths.erase(found);
    }
  }
  if (!study.indices(ShardState::missing).empty()) study.unread = paths;
}

void count_missing(Gathered& study, const Study& stored) {
  const std::uint64_t points = stored.points.size(), all = points * stored.realizations;
  const std::uint64_t count = study.status.shards.size();
  for (ShardStatus& shard : study.status.shards) {
    if (shard.state != ShardState::missing && shard.state != ShardState::unreadable) continue;
    for (std::uint64_t n = shard.index - 1; n < all; n += count) {
      const std::uint64_t taps = stored.points[n % points].taps;
      ++shard.realizations;
      shard.all_taps += taps;
      study.points[n % points].rows_left += taps + 1;
    }
  }
}

/// Estimates remaining work from finished rows of the sweep point, or of all points where it has
/// not begun.
void estimate_left(Gathered& study) {
  double seconds = 0, rows = 0, rows_left = 0, left = 0;
  for (const PointWork& point : study.points) {
    seconds += point.seconds;
    rows += static_cast<double>(point.rows);
    rows_left += static_cast<double>(point.rows_left);
  }
  const auto computes = [](const ShardStatus& shard) {
    return shard.state == ShardState::running || shard.state == ShardState::dead || shard.taps > 0;
  };
  if (seconds > 0 || std::ranges::none_of(study.status.shards, computes))
    study.status.used = Seconds(seconds);
  if (rows == 0 && rows_left > 0) return;
  const double of_any = rows > 0 ? seconds / rows : 0;
  for (const PointWork& point : study.points) {
    const double a_row = point.rows > 0 ? point.seconds / static_cast<double>(point.rows) : of_any;
    left += a_row * static_cast<double>(point.rows_left);
  }
  study.status.left = Seconds(left);
}

/// A study, and the first of its files, which keeps nothing open.
struct KnownStudy {
  Gathered gathered;
  ResultsFile first;
};
/// By the scene and the number of shares.
using KnownStudies = std::map<std::pair<std::string, std::uint32_t>, KnownStudy>;

void look_at(KnownStudies& studies, const ResultsFile*& last, const std::string& path,
             SlurmQueue& queue) {
  LiveLook look = look_at_run(path, queue, last);
  const Study& study = look.file.study();
  const std::uint32_t count = look.file.shard().count;
  auto found = studies.find({study.resolved_scene, count});
  if (found == studies.end()) {
    Gathered fresh;
    const Json scene = stored_scene(look.file);
    const Json* const name = scene.find("name");
    fresh.status.scene = name != nullptr ? name->text() : "";
    fresh.points.resize(study.points.size());
    for (std::uint32_t i = 1; i <= count; ++i) fresh.status.shards.push_back({.index = i});
    gather(fresh, path, look);
    look.file.rest();
    found = studies
                .emplace(std::pair(study.resolved_scene, count),
                         KnownStudy{std::move(fresh), std::move(look.file)})
                .first;
  } else {
    gather(found->second.gathered, path, look);
  }
  last = &found->second.first;
}

}  // namespace

std::vector<std::string> results_files(std::span<const std::string> named) {
  std::vector<std::string> files;
  for (const std::string& path : named) {
    std::error_code unreadable;
    if (!fs::is_directory(path, unreadable)) {
      files.push_back(path);
      continue;
    }
    const std::vector<std::string> found = files_in(path);
    if (found.empty())
      throw BadInput(fmt::format(
          "{}: the folder has no .h5 file. If its jobs are still in the queue, repeat the "
          "command after the first has started",
          path));
    files.insert(files.end(), found.begin(), found.end());
  }
  return files;
}

const char* name_of(ShardState state) {
  switch (state) {
    case ShardState::done:
      return "done";
    case ShardState::running:
      return "running";
    case ShardState::stopped:
      return "stopped";
    case ShardState::dead:
      return "dead";
    case ShardState::missing:
      return "missing";
    case ShardState::unreadable:
      return "unreadable";
  }
  return "unknown";
}

std::vector<std::uint32_t> ShardsStatus::indices(ShardState state) const {
  std::vector<std::uint32_t> found;
  for (const ShardStatus& shard : shards)
    if (shard.state == state) found.push_back(shard.index);
  return found;
}

Overview overview_of(std::span<const std::string> files) {
  Overview overview;
  KnownStudies studies;
  const ResultsFile* last = nullptr;  // last entry of the study that the next file probably has
  SlurmQueue queue;
  for (const std::string& path : files) {
    try {
      look_at(studies, last, path, queue);
    } catch (const ResultsError& error) {
      overview.bad_files.push_back({path, error.what()});
    }
  }
  for (auto& [key, known] : studies) {
    place_unreadable(known.gathered.status, overview.bad_files);
    count_missing(known.gathered, known.first.study());
    estimate_left(known.gathered);
    overview.studies.push_back(std::move(known.gathered.status));
  }
  return overview;
}

std::string ranges_text(std::span<const std::uint32_t> ascending) {
  std::string text;
  for (std::size_t i = 0; i < ascending.size();) {
    std::size_t last = i;
    while (last + 1 < ascending.size() && ascending[last + 1] == ascending[last] + 1) ++last;
    if (!text.empty()) text += ',';
    text += fmt::to_string(ascending[i]);
    if (last > i) text += fmt::format("{}{}", last > i + 1 ? '-' : ',', ascending[last]);
    i = last + 1;
  }
  return text;
}

}  // namespace jostle::inline study
