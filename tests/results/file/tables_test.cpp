#include "results/file/tables.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>

#include "results/disk/error.hpp"
#include "results/file/results_file.hpp"
#include "results/locks/lock.hpp"
#include "tests/results/runs.hpp"
#include "tests/results/temporary_folder.hpp"

using namespace jostle;

namespace {

Table sample(const std::string& name, double first = 1.5) {
  Table table;
  table.name = name;
  table.axes = {{"lag", {"lag"}, std::vector<std::uint64_t>{1, 10, 100}, "1", "taps waited", ""},
                {"kind", {"kind"}, std::vector<std::string>{"mean", "größte"}, "1", "", ""}};
  table.quantities = {
      {"z",
       {"kind", "lag"},
       std::vector<double>{first, 2, 3, -0.0, 1e-300, 7},
       "diameter",
       "height",
       "eq. 5"},
      {"count", {"lag"}, std::vector<std::uint64_t>{3, 2, 1}, "1", "realizations", ""},
      {"slope", {}, std::vector<double>{0.1}, "1", "", ""},
      {"verdict", {}, std::vector<std::string>{"not reached"}, "", "in words", ""}};
  table.notes = {{"asked", "lag 1:100"}, {"observable", "mean_height"}};
  return table;
}

void check_same(const Table& a, const Table& b) {
  CHECK(a.name == b.name);
  CHECK(a.notes == b.notes);
  const auto is_same = [](const std::vector<Quantity>& p, const std::vector<Quantity>& q) {
    REQUIRE(p.size() == q.size());
    for (std::size_t k = 0; k < p.size(); ++k) {
      CHECK(p[k].name == q[k].name);
      CHECK(p[k].axes == q[k].axes);
      CHECK((p[k].values == q[k].values));
      CHECK(p[k].units == q[k].units);
      CHECK(p[k].long_name == q[k].long_name);
      CHECK(p[k].source == q[k].source);
    }
  };
  is_same(a.axes, b.axes);
  is_same(a.quantities, b.quantities);
}

void store(const std::string& path, const std::string& group, const std::vector<Table>& tables) {
  store_tables(path, group, tables, synthetic::provenance());
}

}  // namespace

TEST_CASE("tables come back as they were stored, beside unchanged data") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  const std::string digest = synthetic::run_to_end(path);
  CHECK(read_tables(path, "analysis").empty());
  const Table first = sample("point_0000/ageing/z"), second = sample("point_0001/ageing/z", 9);
  store(path, "analysis", {second, first});
  const auto read = read_tables(path, "analysis");
  REQUIRE(read.size() == 2);
  check_same(read[0], first);
  check_same(read[1], second);
  CHECK(digest_of(path) == digest);
  CHECK(ResultsFile(path).state() == RunState::complete);
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    CHECK(entry.path() == path);  // neither a lock nor a temporary file
}

TEST_CASE("storing again replaces a table and leaves the others") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  const std::string digest = synthetic::run_to_end(path);
  store(path, "fits", {sample("a"), sample("b")});
  store(path, "structure", {sample("c")});
  for (int turn = 0; turn < 30; ++turn) store(path, "fits", {sample("b", turn)});
  CHECK(table_names(path) == std::vector<std::string>{"fits/a", "fits/b", "structure/c"});
  const auto fits = read_tables(path, "fits");
  REQUIRE(fits.size() == 2);
  check_same(fits[0], sample("a"));
  check_same(fits[1], sample("b", 29));
  CHECK(read_tables(path, "structure").size() == 1);
  CHECK(digest_of(path) == digest);
}

TEST_CASE("a table without results replaces one with results only where it is to") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  synthetic::run_to_end(path);
  const Table refused{.name = "b/c", .notes = {{"refused", "too few taps"}}};
  const std::vector<Table> none{refused};
  const auto leave = [&](const std::vector<Table>& tables) {
    return store_tables(path, "fits", tables, synthetic::provenance(), {}, StoredResults::left);
  };
  const auto written_before = std::filesystem::last_write_time(path);
  CHECK(leave(none).empty());
  CHECK(read_tables(path, "fits").empty());
  CHECK(std::filesystem::last_write_time(path) == written_before);
  CHECK(leave({sample("b/c", 1)}).empty());
  CHECK(leave({refused, sample("a", 2)}) == std::vector<std::string>{"b/c"});
  CHECK(leave({sample("b/c", 3)}).empty());
  const auto fits = read_tables(path, "fits");
  REQUIRE(fits.size() == 2);
  check_same(fits[0], sample("a", 2));
  check_same(fits[1], sample("b/c", 3));
  CHECK(ResultsFile(path).tables_without_results().empty());
  store(path, "fits", none);
  check_same(read_tables(path, "fits").at(1), refused);
  CHECK(ResultsFile(path).tables_without_results() == std::vector<std::string>{"fits/b/c"});
}

TEST_CASE("a file does not grow with the number of times its tables were replaced") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  synthetic::run_to_end(path);
  std::uint64_t state = 1;
  const auto random_table = [&](const std::string& name) {
    Table table{.name = name, .axes = {}, .quantities = {}, .notes = {}};
    std::vector<double> taps(3000);
    for (std::size_t i = 0; i < taps.size(); ++i) taps[i] = static_cast<double>(i);
    table.axes = {{"tap", {"tap"}, taps, "", "", ""}};
    for (int k = 0; k < 20; ++k) {
      std::vector<double> values(taps.size());
      for (double& value :
           values) {  // values that compress by little, and by a little more or less
        state = state * 6364136223846793005u + 1442695040888963407u;
        value = static_cast<double>(state >> 20);
      }
      table.quantities.push_back({"q" + std::to_string(k), {"tap"}, values, "1", "", ""});
    }
    return table;
  };
  const auto size_after = [&](int turns) {
    for (int turn = 0; turn < turns; ++turn)
      store(path, "analysis", {random_table("a"), random_table("b")});
    return static_cast<double>(std::filesystem::file_size(path));
  };
  // HDF5 loses 4 kB of references a time.
  const double first = size_after(1), late = size_after(40);
  CAPTURE(first, late);
  CHECK(late < 1.5 * first);
}

TEST_CASE("values that may be missing or extreme are kept") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  synthetic::run_to_end(path);
  Table table;
  table.name = "t";
  const double infinity = std::numeric_limits<double>::infinity();
  table.quantities = {{"bounds", {}, std::vector<double>{-infinity}, "", "", ""}};
  table.axes = {{"n", {"n"}, std::vector<std::uint64_t>{}, "", "", ""}};
  table.quantities.push_back({"none", {"n"}, std::vector<double>{}, "", "", ""});
  store(path, "fits", {table});
  const Table read = read_tables(path, "fits").at(0);
  CHECK(std::get<std::vector<double>>(read.quantities[0].values).at(0) == -infinity);
  CHECK(std::get<std::vector<double>>(read.quantities[1].values).empty());
}

TEST_CASE("a table of nothing but a word of why is kept") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  synthetic::run_to_end(path);
  store(path, "structure", {{.name = "t", .notes = {{"refused", "there is no floor"}}}});
  const Table read = read_tables(path, "structure").at(0);
  CHECK(read.axes.empty());
  CHECK(read.quantities.empty());
  CHECK(read.notes ==
        std::vector<std::pair<std::string, std::string>>{{"refused", "there is no floor"}});
}

TEST_CASE("tables that contradict themselves are refused before anything is written") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  synthetic::run_to_end(path);
  Table short_of = sample("a");
  std::get<std::vector<double>>(short_of.quantities[0].values).pop_back();
  CHECK_THROWS_AS(store(path, "fits", {short_of}), std::invalid_argument);
  Table bare = sample("a");
  bare.axes.pop_back();
  CHECK_THROWS_AS(store(path, "fits", {bare}), std::invalid_argument);
  CHECK(read_tables(path, "fits").empty());
}

TEST_CASE("a damaged, a locked and a missing file are refused and stay as they are") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  const std::string digest = synthetic::run_to_end(path);
  {
    const RunLock lock(path, false);
    CHECK_THROWS_AS(store(path, "fits", {sample("a")}), ResultsError);
  }
  CHECK(digest_of(path) == digest);
  const auto size = std::filesystem::file_size(path);
  {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(size / 2));
    file.put('!').put('?');
  }
  CHECK_THROWS_AS(store(path, "fits", {sample("a")}), ResultsError);
  CHECK_THROWS_AS(read_tables(path, "fits"), ResultsError);
  CHECK(std::filesystem::file_size(path) == size);
  CHECK_THROWS_AS(store(folder / "none.h5", "fits", {sample("a")}), ResultsError);
}
