#include <fmt/format.h>

#include <array>
#include <catch2/catch.hpp>
#include <cstdio>
#include <filesystem>
#include <random>

#include "hdf5_mutations.hpp"
#include "results/disk/error.hpp"
#include "results/file/tables.hpp"
#include "runs.hpp"
#include "temporary_folder.hpp"

// Files that were changed on purpose and sealed again. None may crash, hang or take all memory:
// each is refused with its path, or used.
using namespace jostle;
using namespace jostle::synthetic;

namespace {

constexpr int few = 12, n_large = 400;  // few spheres of a kind

/// Half of the files are unfinished, so that they can be resumed.
void write_file(const std::string& path, bool finished) {
  if (finished) {
    run_to_end(path);
  } else {
    const Study all = study();
    const auto store = RunStore::create(path, all, {}, provenance());
    run_pending(*store, all, {.steps = 7});
    store->finish();
  }
  const Quantity taps{
      .name = "tap", .axes = {"tap"}, .values = std::vector<std::uint64_t>{1, 2, 3}};
  const Quantity mean{
      .name = "mean", .axes = {"tap"}, .values = std::vector<double>{0.5, 0.6, 0.7}};
  const Table table{.name = "point_0000/steady",
                    .axes = {taps},
                    .quantities = {mean},
                    .notes = {{"found", "steady"}}};
  store_tables(path, "analysis", std::span(&table, 1), provenance());
}

void try_forgeries(std::size_t kind, int n) {
  const TemporaryFolder folder;
  for (const bool finished : {true, false}) write_file(folder / (finished ? "1" : "0"), finished);
  std::mt19937_64 random(20240607 + kind);
  int refusals = 0, uses = 0;
  for (int i = 0; i < n; ++i) {
    std::array<std::uint8_t, 4096> bytes;
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
    Choices choices(bytes);
    const std::string path = folder / "forged.h5";
    std::filesystem::copy_file(folder / (i % 2 == 0 ? "1" : "0"), path,
                               std::filesystem::copy_options::overwrite_existing);
    CAPTURE(forgery_name(kind), i);
    forge(path, kind, choices);
    if (i % 4 == 3) forge(path, choices.integer_below(n_forgeries), choices);
    REQUIRE_NOTHROW(refusals += use_in_every_way(path));
    uses += n_uses();
    std::filesystem::remove_all(path + ".parts");
  }
  fmt::print("{:40} {:3} files, {:3} uses, {:3} refused\n", forgery_name(kind), n, uses, refusals);
  CHECK(refusals > 0);
  CHECK(refusals < uses);
}

}  // namespace

TEST_CASE("a forged results file is refused or used, and nothing else") {
  try_forgeries(GENERATE(range(std::size_t{0}, n_forgeries, std::size_t{12})), few);
}

TEST_CASE("a results file forged in any way is refused or used, and nothing else", "[slow]") {
  try_forgeries(GENERATE(range(std::size_t{0}, n_forgeries)), few);
}

TEST_CASE("hundreds of forged results files are refused or used", "[nightly]") {
  try_forgeries(GENERATE(range(std::size_t{0}, n_forgeries)), n_large);
}

TEST_CASE("a file that nobody forged is used in every way") {
  const TemporaryFolder folder;
  for (const bool finished : {true, false}) {
    const std::string path = folder / (finished ? "1" : "0");
    write_file(path, finished);
    CHECK(use_in_every_way(path) == (finished ? 0 : 1));  // an unfinished one is not merged
  }
}
