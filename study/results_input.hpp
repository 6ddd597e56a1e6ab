#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "results/file/results_file.hpp"
#include "study/bad_input.hpp"

// Sources of results.
namespace jostle::inline study {

/// By its first bytes. Throws ResultsError where there is no such file.
bool is_results_file(const std::string& path);

/// Throws ResultsError for an input that a command does not read: a folder, or else for `reason`.
[[noreturn]] void reject_input(const std::string& path, const std::string& reason);

/// True if two names refer to one file, existing or not.
bool is_same_file(const std::string& a, const std::string& b);

/// Data that are read of a run in progress or a killed run: its file alone, or its checkpoints too.
enum class Live { no, yes };

/// A run in progress, or a killed run, has no data yet in the selected source.
class NoTapsYet : public BadInput {
 public:
  NoTapsYet(const std::string& path, Live live);
  const std::string& path() const { return path_; }
  Live live() const { return live_; }

 private:
  std::string path_;
  Live live_;
};

/// A results file to be read; it may be unfinished (ResultsFile::state). Throws
/// NoTapsYet, and ResultsError for the file.
ResultsFile open_results(const std::string& path, Live live = Live::no);

/// Throws BadInput where a file is named twice: it would count as more data than there are.
void require_different(std::span<const std::string> paths);
/// Rejects copies of a file, which hold one run.
void require_different_runs(std::span<const ResultsFile> files);

/// The sweep points that `wanted` names, by number ("2", "number=2"), label, value ("0.05") or as
/// "pointer=value"; all if it is empty. Throws BadArgument with the list of points, and where a
/// number is also a value or label of another point.
std::vector<std::uint32_t> chosen_points(const Study& study, const std::string& wanted);
/// The only sweep point that `wanted` names; the first if it is empty. Throws BadArgument.
std::uint32_t chosen_point(const Study& study, const std::string& wanted);

}  // namespace jostle::inline study
