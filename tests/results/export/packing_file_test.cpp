#include "results/export/packing_file.hpp"

#include <catch2/catch.hpp>
#include <fstream>
#include <random>

#include "results/disk/error.hpp"
#include "tests/results/runs.hpp"
#include "tests/results/temporary_folder.hpp"

using namespace jostle;
using Catch::Matchers::Contains;

namespace {

Packing some_packing(const Container& container) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> uniform(0, 1);
  const double x = width_x(container), y = width_y(container);
  Packing packing{container, {}};
  for (int i = 0; i < 4; ++i)  // one above the other, at numbers of all digits and small ones
    packing.centres.push_back({(0.4 + 0.2 * uniform(random)) * x, (0.4 + 0.2 * uniform(random)) * y,
                               1.2 * i + uniform(random) * 1e-6});
  return packing;
}

Packing read_text(const std::string& text, const PackingSelector& selector = {}) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a.xyz") << text;
  return read_packing(folder / "a.xyz", selector);
}

}  // namespace

TEST_CASE("extended XYZ reads back to the same bits in every container") {
  const Container container = GENERATE(as<Container>{}, PeriodicBox{16, 7.0 / 3}, WalledBox{4, 5},
                                       Cylinder{19.3}, FullyPeriodicBox{3, 4, 5.1}, Plates{5, 4});
  const TemporaryFolder folder;
  const Packing packing = some_packing(container);
  write_extended_xyz(folder / "a.xyz", packing);
  const Packing back = read_packing(folder / "a.xyz");
  CHECK(back.container == container);
  CHECK(back.centres == packing.centres);
}

TEST_CASE("extended XYZ of other programs is read: any columns, several frames") {
  const std::string frames =
      "2\nProperties=id:I:1:pos:R:3:radius:R:1 Lattice=\"4.0 0 0 0 5 0 0 0 6\" Time=0 pbc=\"T T "
      "F\"\n"
      "1 0.5 1 1.5 0.5\n2 2 2.5 3e0 0.5\n"
      "1\nLattice=\"4 0 0 0 5 0 0 0 6\" Properties=species:S:1:pos:R:3 pbc=\"F F F\"\nC 1 2 3\n\n";
  const Packing last = read_text(frames);
  CHECK(last.container == Container(WalledBox{4, 5}));
  CHECK(last.centres == std::vector<Vec3>{{1, 2, 3}});
  const Packing first = read_text(frames, {.tap = 0});
  CHECK(first.container == Container(PeriodicBox{4, 5}));
  CHECK(first.centres == std::vector<Vec3>{{0.5, 1, 1.5}, {2, 2.5, 3}});
  CHECK_THROWS_WITH(read_text(frames, {.tap = 2}), Contains("has no frame 2: it has 2"));
}

TEST_CASE("malformed extended XYZ is refused with its line") {
  const std::string box = "Lattice=\"4 0 0 0 5 0 0 0 6\" pbc=\"T T F\"";
  CHECK_THROWS_WITH(read_text(""), Contains("is empty"));
  CHECK_THROWS_WITH(read_text("many\n"), Contains("line 1: \"many\" is not a count"));
  CHECK_THROWS_WITH(read_text("1\npbc=\"T T F\"\nX 1 2 3\n"), Contains("no Lattice"));
  CHECK_THROWS_WITH(read_text("1\nLattice=\"4 1 0 0 5 0 0 0 6\"\nX 1 2 3\n"),
                    Contains("right-angled"));
  CHECK_THROWS_WITH(read_text("1\nLattice=\"4 0 0 0 5 0 0 0 6\"\nX 1 2 3\n"), Contains("pbc"));
  CHECK_THROWS_WITH(read_text("1\n" + box + " Properties=species:S:1\nX 1 2 3\n"),
                    Contains("no pos:R:3"));
  CHECK_THROWS_WITH(read_text("2\n" + box + "\nX 1 2 3\n"),
                    Contains("the file ends after 1 of 2 spheres"));
  CHECK_THROWS_WITH(read_text("1\n" + box + "\nX 1 2\n"), Contains("line 3: too few columns"));
  CHECK_THROWS_WITH(read_text("1\n" + box + "\nX 1 nan 3\n"), Contains("not a finite number"));
}

TEST_CASE("the corner and the periods of extended XYZ are taken off its positions") {
  const std::string box = "Lattice=\"4 0 0 0 5 0 0 0 6\" container=";
  CHECK(read_text("1\n" + box + "periodic Origin=\"-2 1 3\"\nX -11 12.5 4\n").centres ==
        std::vector<Vec3>{{3, 1.5, 1}});
  CHECK(read_text("1\n" + box + "fully_periodic\nX 4 -0.5 20\n").centres ==
        std::vector<Vec3>{{0, 4.5, 2}});
  CHECK(read_text("1\n" + box + "walls Origin={1,1,1}\nX 2 2 9\n").centres ==
        std::vector<Vec3>{{1, 1, 8}});
}

TEST_CASE("a frame is refused for a fault in another frame, whichever is asked for") {
  const std::string box = "Lattice=\"4 0 0 0 5 0 0 0 6\" pbc=\"T T F\"";
  const std::string good = "1\n" + box + "\nX 1 2 3\n";
  const std::string sized = "1\n" + box + " Properties=pos:R:3:radius:R:1\n1 2 3 0.3\n";
  CHECK_THROWS_WITH(read_text(good + sized, {.tap = 0}), Contains("line 6: radius is 0.3"));
  CHECK_THROWS_WITH(read_text(sized + good), Contains("line 3: radius is 0.3"));
}

TEST_CASE("a packing is read from a snapshot of a results file") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  synthetic::run_to_end(path);
  const ResultsFile file(path);
  CHECK(read_packing(path).centres == file.record({0, 0}).state->centres);
  CHECK(read_packing(path).container == Container(PeriodicBox{4, 5}));
  const Packing packing = read_packing(path, {.point = 1, .realization = 2, .tap = 2});
  CHECK(packing.centres == file.snapshots({1, 2}).at(1).centres);
  CHECK_THROWS_WITH(read_packing(path, {.tap = 3}), Contains("kept taps: 0, 2, 6"));
  CHECK_THROWS_WITH(read_packing(path, {.point = 2}), Contains("no sweep point 2"));
  CHECK_THROWS_WITH(read_packing(path, {.realization = 3}), Contains("no realization 3"));
}
