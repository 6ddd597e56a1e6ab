#include "results/run_parts.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>

#include "results/error.hpp"
#include "results/publish.hpp"

namespace jostle {
namespace {

enum class Kind { state, segment, temporary };
struct PartName {
  Kind kind;
  RealizationId id;
  std::uint32_t segment = 0;
};

std::optional<PartName> parse_name(const std::string& name) {
  PartName part{Kind::state, {}, 0};
  int end = 0;
  const char* text = name.c_str();
  if (std::sscanf(text, "p%u_r%u.%n", &part.id.point, &part.id.realization, &end) != 2 || end == 0)
    return std::nullopt;
  const std::string ending = name.substr(static_cast<std::size_t>(end));
  if (ending.ends_with(".tmp")) {
    part.kind = Kind::temporary;
    return part;
  }
  if (ending == "state") return part;
  part.kind = Kind::segment;
  if (std::sscanf(ending.c_str(), "segment%u%n", &part.segment, &end) != 1 ||
      static_cast<std::size_t>(end) != ending.size())
    return std::nullopt;
  return part;
}

/// What a folder's owner, and nobody else, chose: a link here could make us remove files anywhere.
void require_own_folder(const std::string& folder) {
  struct stat status;
  if (::lstat(folder.c_str(), &status) != 0) {
    if (errno == ENOENT) return;
    fail_on_disk(folder, "open", errno);
  }
  if (!S_ISDIR(status.st_mode))
    throw ResultsError(folder,
                       "is no folder that jostle made, which needs this name: move it away, or "
                       "name the results file otherwise");
}

/// The files of the folder that are parts, by name; none where there is no folder.
std::map<std::string, PartName> list_parts(const std::string& results_path) {
  std::map<std::string, PartName> parts;
  require_own_folder(parts_folder(results_path));
  std::error_code error;
  for (std::filesystem::directory_iterator entry(parts_folder(results_path), error), end;
       !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename();
    if (const auto part = parse_name(name)) parts[entry->path()] = *part;
  }
  if (error && error != std::errc::no_such_file_or_directory)
    throw ResultsError(parts_folder(results_path), "cannot list: " + error.message());
  return parts;
}

/// Reads all segments and hands them over, then the tail; verifies that rows follow on rows.
template <class Take>
void for_each_piece(const std::string& results_path, const PartIdentity& identity,
                    const PartState& part, std::size_t n_columns, Take&& take) {
  const std::string path = state_path(results_path, identity.id);
  std::uint64_t next_row = part.base_rows;
  const auto accept = [&](const SeriesPiece& piece) {
    if (piece.first_row != next_row || piece.rows.size() % n_columns != 0)
      throw ResultsError(path, "its rows do not follow on one another");
    next_row += piece.rows.size() / n_columns;
    take(piece);
  };
  for (std::uint32_t k = 0; k < part.n_segments; ++k)
    accept(read_segment(segment_path(results_path, identity.id, k), identity, k));
  accept(part.tail);
  if (part.state && part.state->rows != next_row)
    throw ResultsError(path, "its state and its rows disagree");
}

}  // namespace

bool parts_exist(const std::string& results_path) {
  return !list_parts(results_path).empty();
}

void make_parts_folder(const std::string& results_path) {
  const std::string folder = parts_folder(results_path);
  struct stat status;
  const bool is_private =
      ::stat(results_path.c_str(), &status) == 0 && (status.st_mode & (S_IRGRP | S_IROTH)) == 0;
  if (::mkdir(folder.c_str(), is_private ? 0700 : 0777) == 0) return sync_folder_of(folder);
  if (errno != EEXIST) fail_on_disk(folder, "create", errno);
  require_own_folder(folder);
}

void remove_parts(const std::string& results_path) {
  const auto parts = list_parts(results_path);
  for (const auto& [path, part] : parts)
    if (part.kind == Kind::state) remove_file(path);
  for (const auto& [path, part] : parts)
    if (part.kind != Kind::state) remove_file(path);
  ::rmdir(parts_folder(results_path).c_str());
}

std::uint64_t parts_bytes(const std::string& results_path) {
  std::uint64_t bytes = 0;
  for (const auto& [path, part] : list_parts(results_path)) {
    struct stat status;
    if (::stat(path.c_str(), &status) == 0) bytes += static_cast<std::uint64_t>(status.st_size);
  }
  return bytes;
}

std::vector<RealizationId> realizations_with_parts(const std::string& results_path) {
  std::vector<RealizationId> ids;
  for (const auto& [path, part] : list_parts(results_path))
    if (part.kind == Kind::state) ids.push_back(part.id);
  std::sort(ids.begin(), ids.end());
  return ids;
}

RealizationSummary summary_of(RealizationId id, const PartState& part) {
  return {.id = id,
          .status = part.status,
          .rows = part.state ? part.state->rows : 0,
          .reason = part.reason,
          .work = part.work};
}

std::map<RealizationId, RealizationSummary> verify_parts(const std::string& results_path,
                                                         const std::string& run_id,
                                                         const Study& study) {
  std::map<RealizationId, RealizationSummary> summaries;
  std::map<RealizationId, std::uint32_t> n_segments;
  for (const RealizationId id : realizations_with_parts(results_path)) {
    const std::string path = state_path(results_path, id);
    if (id.point >= study.points.size() || id.realization >= study.realizations)
      throw ResultsError(path, "part of a realization that the study does not have");
    const PartState part = read_state(path, {run_id, id});
    const std::size_t n_columns = study.points[id.point].observables.size() + n_relaxation_columns;
    for_each_piece(results_path, {run_id, id}, part, n_columns, [](const SeriesPiece&) {});
    summaries[id] = summary_of(id, part);
    n_segments[id] = part.n_segments;
  }
  for (const auto& [path, part] : list_parts(results_path))
    if (part.kind == Kind::temporary ||
        (part.kind == Kind::segment && part.segment >= n_segments[part.id]))
      remove_file(path);
  return summaries;
}

RealizationRecord join(RealizationRecord base, const std::string& results_path,
                       const PartIdentity& identity, std::size_t n_columns) {
  const std::string path = state_path(results_path, identity.id);
  PartState part = read_state(path, identity);
  if (base.rows.size() < part.base_rows * n_columns)
    throw ResultsError(path, "goes on from taps that the results file does not hold");
  base.rows.resize(part.base_rows * n_columns);
  std::erase_if(base.snapshots,
                [&](const SnapshotRecord& record) { return record.tap >= part.base_rows; });
  for_each_piece(results_path, identity, part, n_columns, [&](const SeriesPiece& piece) {
    base.rows.insert(base.rows.end(), piece.rows.begin(), piece.rows.end());
    base.snapshots.insert(base.snapshots.end(), piece.snapshots.begin(), piece.snapshots.end());
  });
  base.status = part.status;
  base.reason = part.reason;
  base.work = part.work;
  base.state = std::move(part.state);
  return base;
}

}  // namespace jostle
