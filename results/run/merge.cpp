#include "results/run/merge.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <map>
#include <vector>

#include "results/disk/checksum.hpp"
#include "results/disk/error.hpp"
#include "results/disk/output_path.hpp"
#include "results/disk/publish.hpp"
#include "results/disk/temporary_file.hpp"
#include "results/file/results_file.hpp"
#include "results/file/results_writer.hpp"
#include "results/locks/lock.hpp"
#include "results/run/merge_inputs.hpp"
#include "results/run/run_parts.hpp"

namespace jostle::inline results {
namespace {

/// Where a realization of the merged study is read from.
struct Source {
  std::size_t file;      // its number among the inputs
  RealizationId stored;  // by the file's own numbers of points
};
using Owners = std::map<RealizationId, Source>;

std::string named(RealizationId id) {
  return fmt::format("realization {} of sweep point {}", id.realization, id.point);
}

void check_same_study(const ResultsFile& first, const ResultsFile& second) {
  if (first.study().resolved_scene != second.study().resolved_scene ||
      first.study().realizations != second.study().realizations ||
      first.study().points.size() != second.study().points.size())
    throw ResultsError(second.path(), "holds another scene than " + first.path() +
                                          "; compare /scene/resolved of both");
}

/// Points of one scene start alike.
void check_same_starts(const ResultsFile& first, const ResultsFile& second) {
  if (const auto point = other_start(second.study(), first.study()))
    throw ResultsError(second.path(),
                       fmt::format("starts sweep point {} from another packing than {}: "
                                   "the file it was read from had changed",
                                   *point, first.path()));
}

void claim(Owners& owners, MergeInputs& inputs, std::size_t number, const Study& study) {
  const ResultsFile& file = inputs.open(number);
  if (file.study().realizations != study.realizations)
    throw ResultsError(file.path(),
                       fmt::format("has {} realizations per sweep point, not {}; resume "
                                   "its run with more",
                                   file.study().realizations, study.realizations));
  const PointNumbers numbers(study);
  for (const RealizationSummary& summary : file.realizations(Realizations::of_its_share)) {
    if (summary.status == RealizationStatus::missing) continue;
    const auto point = numbers.find(file.study().points[summary.id.point].id);
    if (!point)
      throw ResultsError(file.path(), fmt::format("holds sweep point {}, which is not of the "
                                                  "merged scene",
                                                  summary.id.point));
    const RealizationId id{*point, summary.id.realization};
    const auto [owner, is_new] = owners.emplace(id, Source{number, summary.id});
    if (!is_new)
      throw ResultsError(file.path(),
                         fmt::format("overlaps {}: both hold {}",
                                     inputs.files()[owner->second.file].path(), named(id)));
  }
}

/// Shares of which no file is there, as "3, 7 of 40"; empty where the files are no shares of one
/// run.
std::string missing_shares(const std::vector<ResultsFile>& files) {
  const std::uint32_t count = files.front().shard().count;
  std::vector<bool> is_there(std::size_t{count} + 1, false);
  for (const ResultsFile& file : files) {
    if (file.shard().count != count) return "";
    is_there[file.shard().index] = true;
  }
  constexpr std::size_t most = 50;
  std::string text;
  std::size_t n = 0;
  for (std::uint32_t index = 1; index <= count; ++index) {
    if (is_there[index] || ++n > most) continue;
    text += fmt::format("{}{}", text.empty() ? "" : ", ", index);
  }
  if (n > most) text += fmt::format(" and {} more", n - most);
  return n == 0 ? "" : fmt::format("{} of {}", text, count);
}

void check_gaps(const Owners& owners, const Study& study, const std::vector<ResultsFile>& files,
                const std::string& output) {
  for (const RealizationId id : realizations_of(study, {})) {
    if (owners.contains(id)) continue;
    if (const std::string shares = missing_shares(files); !shares.empty())
      throw ResultsError(output, fmt::format("cannot be merged: no input holds shard {} ({}, for "
                                             "one)",
                                             shares, named(id)));
    throw ResultsError(output, fmt::format("cannot be merged: no input holds {}; a shard or "
                                           "a point of the joined sweep is missing",
                                           named(id)));
  }
}

/// Every unfinished file is named, so that all can be resumed at once.
void require_finished(const std::vector<ResultsFile>& files) {
  constexpr std::size_t most = 20;
  std::vector<std::string> unfinished;
  for (const ResultsFile& file : files)
    if (file.state() != RunState::complete || parts_exist(file.path()))
      unfinished.push_back(file.path());
  if (unfinished.empty()) return;
  std::string other_inputs;
  for (std::size_t i = 1; i < std::min(unfinished.size(), most); ++i)
    other_inputs += (i > 1 ? ", " : "") + unfinished[i];
  if (unfinished.size() > most)
    other_inputs += fmt::format(" and {} more", unfinished.size() - most);
  const std::string nor = unfinished.size() == 2 ? ", nor is " : ", nor are ";
  throw ResultsError(unfinished.front(),
                     fmt::format("is not finished{}; resume {} to the end",
                                 other_inputs.empty() ? "" : nor + other_inputs,
                                 other_inputs.empty() ? "its run" : "their runs"));
}

/// The merged file holds what its inputs hold, compressed alike.
std::uint64_t bytes_of(std::span<const std::string> files) {
  std::uint64_t bytes = 0;
  for (const std::string& file : files) {
    struct stat status;
    if (::stat(file.c_str(), &status) == 0) bytes += static_cast<std::uint64_t>(status.st_size);
  }
  return bytes;
}

std::vector<Provenance> all_processes(const std::vector<ResultsFile>& files,
                                      const Provenance& own) {
  std::vector<Provenance> processes;
  for (const ResultsFile& file : files)
    processes.insert(processes.end(), file.provenance().begin(), file.provenance().end());
  processes.push_back(own);
  return processes;
}

}  // namespace

void merge_files(std::span<const std::string> inputs, const std::string& named,
                 const Provenance& provenance, bool force, const std::optional<Study>& whole,
                 const Patience& patience) {
  const std::string output = output_path(named);
  const RunLock lock(output, force, LockUse::run, patience);
  require_replaceable_file(output);
  remove_stale_temporaries(output);
  struct stat status;
  if (!force && ::stat(output.c_str(), &status) == 0) refuse_existing(output);
  if (!force && parts_exist(output))
    throw ResultsError(
        parts_folder(output),
        "holds parts of another run, which the merged file would cut off from theirs; "
        "choose another name, or discard them",
        ResultsError::Force::helps);
  if (inputs.empty()) throw ResultsError(output, "nothing to merge");
  MergeInputs read(inputs);
  const std::vector<ResultsFile>& files = read.files();
  require_finished(files);
  Owners owners;
  for (std::size_t number = 0; number < files.size(); ++number) {
    if (!whole) check_same_study(files.front(), files[number]);
    check_same_starts(files.front(), files[number]);
    claim(owners, read, number, whole ? *whole : files.front().study());
  }
  check_gaps(owners, whole ? *whole : files.front().study(), files, output);
  // Scenes that mean the same may be written differently: whatever the order of the inputs, one is
  // kept.
  const Study& study = whole ? *whole : files[owners.begin()->second.file].study();
  require_free_space(output, bytes_of(inputs));
  write_results(output,
                {study, Shard{}, all_processes(files, provenance), random_identity(),
                 [&](RealizationId id) {
                   const Source& source = owners.at(id);
                   return read.realization(source.file, source.stored);
                 }},
                [&] { remove_parts(output); });
}

}  // namespace jostle::inline results
