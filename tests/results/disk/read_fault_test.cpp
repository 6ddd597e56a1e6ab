#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>

#include "results/disk/input_file.hpp"
#include "results/export/extended_xyz.hpp"
#include "results/export/packing_file.hpp"
#include "results/file/tables.hpp"
#include "tests/results/disk/file_text.hpp"
#include "tests/results/forked.hpp"
#include "tests/results/runs.hpp"
#include "tests/results/temporary_folder.hpp"

// Every read of a file fails once, comes back short, or is interrupted: what was read is whole, or
// refused. A read that fails is never the end of a file.
using namespace jostle;

namespace {

/// Result of a reader for a file, as text.
using Reading = std::function<std::string(const std::string& path)>;

std::string summary_of(const ResultsFile& file) {
  std::string text = file.study().resolved_scene;
  for (const RealizationSummary& realization : file.realizations()) {
    const RealizationRecord record = file.record(realization.id);
    text += fmt::format("{} {}\n", realization.rows, record.snapshots.size());
    for (const double number : record.rows) text += fmt::format("{} ", number);
  }
  for (const EnsembleSeries& series : file.ensemble(0)) text += fmt::format("{}", series.mean[0]);
  return text;
}

std::string frames_text(const std::vector<Packing>& frames) {
  std::string text;
  for (const Packing& packing : frames)
    for (const Vec3 r : packing.centres) text += fmt::format("{} {} {}\n", r.x, r.y, r.z);
  return text;
}

struct Case {
  const char* name;
  std::function<void(const std::string& path)> write;
  Reading read;
};

void write_results_with_tables(const std::string& path) {
  synthetic::run_to_end(path);
  const Table table{.name = "t", .axes = {}, .quantities = {}, .notes = {{"a", "b"}}};
  store_tables(path, "analysis", std::span(&table, 1), synthetic::provenance());
}

void write_frames(const std::string& path) {
  std::ofstream file(path);
  for (int frame = 0; frame < 3; ++frame) {
    file << "900\nLattice=\"9 0 0 0 9 0 0 0 9\" pbc=\"T T F\"\n";
    for (int i = 0; i < 900; ++i) file << fmt::format("X {} {} {}.123456789\n", i % 9, frame, i);
  }
}

/// A run that is half done: a file and its parts.
void write_half_a_run(const std::string& path) {
  const Study study = synthetic::study({});
  const auto store = RunStore::create(path, study, {}, synthetic::provenance());
  synthetic::run_pending(*store, study, {.leave_without_end = true});
}

std::string resume(const std::string& path) {
  const Study study = synthetic::study({});
  const auto store = RunStore::resume(path, study, {}, synthetic::provenance());
  synthetic::run_pending(*store, study);
  store->finish();
  return digest_of(path);
}

std::string store_once_more(const std::string& path) {
  const Table table{.name = "u", .axes = {}, .quantities = {}, .notes = {{"c", "d"}}};
  store_tables(path, "fits", std::span(&table, 1), synthetic::provenance());
  std::string text = digest_of(path);
  for (const std::string& name : table_names(path)) text += "\n" + name;
  return text;
}

const Case cases[] = {
    {"a.h5", write_results_with_tables,
     [](const std::string& path) { return summary_of(ResultsFile(path)); }},
    {"digest.h5", write_results_with_tables, digest_of},
    {"tables.h5", write_results_with_tables,
     [](const std::string& path) {
       return fmt::format("{}", read_tables(path, "analysis").size());
     }},
    {"start.h5", write_results_with_tables,
     [](const std::string& path) { return frames_text({read_packing(path)}); }},
    {"stored.h5", write_results_with_tables, store_once_more},
    {"resumed.h5", write_half_a_run, resume},
    {"a.xyz", write_frames,
     [](const std::string& path) { return frames_text(read_extended_xyz_frames(path)); }},
    {"last.xyz", write_frames,
     [](const std::string& path) { return frames_text({read_packing(path)}); }},
    {"a.csv", write_frames, [](const std::string& path) { return read_text_file(path); }},
};

/// Reads in a process of its own; what it made of the file goes to `output`.
Ending read_with(const TemporaryFolder& folder, const Case& fault_case,
                 std::map<std::string, std::string> environment) {
  environment["JOSTLE_FAULT_OF"] = "reads";
  environment["JOSTLE_FAULT_PATH"] = folder / fault_case.name;
  return run_forked(environment, folder / "messages", [&] {
    const std::string text = fault_case.read(folder / fault_case.name);
    std::ofstream(folder / "output") << text;
  });
}

/// Lets each of about `most` reads, spread over all, fail in the way of `action`.
void try_reads(const Case& fault_case, const std::string& action, long most) {
  long calls = 1;
  std::string whole;
  {
    const TemporaryFolder folder;
    fault_case.write(folder / fault_case.name);
    REQUIRE(read_with(folder, fault_case, {{"JOSTLE_FAULT_COUNT", folder / "count"}}).code == 0);
    calls = std::stol(text_of(folder / "count"));
    whole = text_of(folder / "output");
  }
  // A digest is computed in a child process, whose reads are not in the count.
  if (std::string(fault_case.name) == "digest.h5") calls = std::max(calls, 20L);
  REQUIRE(calls > 0);
  REQUIRE_FALSE(whole.empty());
  long refused = 0, tried = 0;
  for (long call = 1; call <= calls; call += std::max(1L, calls / most)) {
    ++tried;
    CAPTURE(fault_case.name, action, call, calls);
    const TemporaryFolder folder;
    fault_case.write(folder / fault_case.name);
    const Ending ending =
        read_with(folder, fault_case,
                  {{"JOSTLE_FAULT_ACTION", action}, {"JOSTLE_FAULT_AT", fmt::format("{}", call)}});
    REQUIRE(ending.signal == 0);
    if (ending.code == 0) {
      CHECK(text_of(folder / "output") == whole);
    } else {
      ++refused;
      CHECK(text_of(folder / "messages").find(fault_case.name) != std::string::npos);
    }
  }
  if (action == "broken") {
    CHECK(refused == tried);
  } else {
    CHECK(refused == 0);
  }
}

}  // namespace

TEST_CASE("a read that fails, is short or is interrupted is never the end of a file") {
  const Case& fault_case = GENERATE(from_range(std::begin(cases), std::end(cases)));
  try_reads(fault_case, GENERATE("broken", "shortened", "interrupted"), 2);
}

TEST_CASE("wherever one of eight reads fails, it is never the end of a file", "[slow]") {
  const Case& fault_case = GENERATE(from_range(std::begin(cases), std::end(cases)));
  try_reads(fault_case, GENERATE("broken", "shortened", "interrupted"), 8);
}

TEST_CASE("wherever a read fails, it is never the end of a file", "[nightly]") {
  const Case& fault_case = GENERATE(from_range(std::begin(cases), std::end(cases)));
  try_reads(fault_case, GENERATE("broken", "shortened", "interrupted"), 1'000'000);
}
