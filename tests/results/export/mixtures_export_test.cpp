#include <catch2/catch.hpp>
#include <fstream>
#include <sstream>

#include "results/disk/error.hpp"
#include "results/export/extended_xyz.hpp"
#include "results/export/h5md.hpp"
#include "results/export/lammps_dump.hpp"
#include "results/export/packing_file.hpp"
#include "results/export/vtk_points.hpp"
#include "results/hdf5/read.hpp"
#include "tests/results/temporary_folder.hpp"

using namespace jostle;
using Catch::Matchers::Contains;

namespace {

Packing mixture() {
  Packing packing{WalledBox{7, 8}, {{2, 2, 1.0 / 3}, {5, 5, 1.5}, {2, 6, 0.45 + 1e-16}}};
  packing.sizes = std::make_shared<const Sizes>(
      std::vector<double>{2.0 / 3, 3, 0.9}, std::vector<std::uint32_t>{1, 0, 1},
      std::vector<SphereKind>{{"large", 2.5}, {"small", 1}});
  return packing;
}

ExportedFrame frame(std::uint64_t tap = 4) {
  return {tap, mixture(), particle_columns(mixture())};
}

Packing read_text(const std::string& text) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a.xyz") << text;
  return read_packing(folder / "a.xyz");
}

const std::string box = "Lattice=\"7 0 0 0 8 0 0 0 9\" container=walls Properties=";

}  // namespace

TEST_CASE("a mixture written as extended XYZ reads back to the same bits") {
  const TemporaryFolder folder;
  const Packing packing = mixture();
  write_extended_xyz(folder / "plain.xyz", packing);
  const std::vector<ExportedFrame> frames{frame()};
  std::ofstream(folder / "columns.xyz") << extended_xyz_text(frames);
  for (const char* name : {"plain.xyz", "columns.xyz"}) {
    const Packing read = read_packing(folder / name);
    CHECK(read.centres == packing.centres);
    REQUIRE(read.sizes);
    CHECK(*read.sizes == *packing.sizes);
  }
}

TEST_CASE("sizes that are alike are read where kinds are named, else they are another unit") {
  Packing packing = mixture();
  packing.centres.pop_back();
  packing.sizes = std::make_shared<const Sizes>(std::vector<double>{2, 2});
  packing.centres[0].z = 1;
  const TemporaryFolder folder;
  write_extended_xyz(folder / "a.xyz", packing);
  CHECK(*read_packing(folder / "a.xyz").sizes == *packing.sizes);
  const std::string rows = "X 2 2 1 1\nX 5 5 1 1\n";
  CHECK_THROWS_WITH(read_text("2\n" + box + "species:S:1:pos:R:3:radius:R:1\n" + rows),
                    Contains("radius is 1, and the spheres of the model have 0.5"));
}

TEST_CASE("sizes are read of columns named radius or diameter, kinds of species") {
  const std::string rows = "Fe 2 2 1 1.4\nH 5 5 1 1\nFe 2 6 1 1.4\n";
  const Packing read = read_text("3\n" + box + "species:S:1:pos:R:3:diameter:R:1\n" + rows);
  REQUIRE(read.sizes);
  CHECK(diameters_of(*read.sizes) == std::vector<double>{1.4, 1, 1.4});
  CHECK(read.sizes->kinds() == std::vector<SphereKind>{{"Fe", 1}, {"H", 1}});
  CHECK(read.sizes->kind_of() == std::vector<std::uint32_t>{0, 1, 0});
  const Packing bare = read_text("2\n" + box + "pos:R:3:radius:R:1\n2 2 1 0.7\n5 5 1 0.5\n");
  CHECK(bare.sizes->kinds() == std::vector<SphereKind>{{"spheres", 1}});
  CHECK(diameters_of(*bare.sizes) == std::vector<double>{1.4, 1});
  const Packing equal = read_text("2\n" + box + "pos:R:3:radius:R:1\n2 2 1 0.5\n5 5 1 0.5\n");
  CHECK(equal.sizes == nullptr);
}

TEST_CASE("frames with wrong sizes are refused by name") {
  const auto refused = [](const std::string& properties, const std::string& keys,
                          const std::string& rows, const std::string& says) {
    const auto n = std::count(rows.begin(), rows.end(), '\n');
    CHECK_THROWS_WITH(read_text(std::to_string(n) + "\n" + box + properties + keys + "\n" + rows),
                      Contains(says));
  };
  const std::string named = "species:S:1:pos:R:3:radius:R:1";
  refused(named, "", "a 2 2 1 0.5\nb 5 5 1 nan\n", "is not a finite number");
  refused(named, "", "a 2 2 1 0.5\nb 5 5 1 0\n", "sphere 1 has the diameter 0");
  refused(named, "", "a 2 2 1 0.5\nb 5 5 1 -0.5\n", "sphere 1 has the diameter -1");
  refused(named, "", "a 2 2 1 0.5\nb 5 5 1 6\n", "sphere 1 has the diameter 12");
  refused(named, "", "a 2 2 1 0.1\nb 5 5 1 2\n", "ratio must not exceed 10");
  refused(named, " kinds=\"a\"", "a 2 2 1 0.5\nb 5 5 1 0.7\n", "species b is none of the kinds");
  refused(named, " kinds=\"a b\" densities=\"1\"", "a 2 2 1 0.5\nb 5 5 1 0.7\n",
          "names 2 kinds of spheres, and densities has 1");
  refused(named, " kinds=\"a b\" densities=\"1 0\"", "a 2 2 1 0.5\nb 5 5 1 0.7\n", "density 0");
  refused("species:S:1:pos:R:3", " kinds=\"a b\"", "a 2 2 1\nb 5 5 1\n", "no column radius");
  refused("pos:R:3:radius:R:1:diameter:R:1", "", "2 2 1 0.5 1\n5 5 1 0.7 1\n",
          "sphere 1 has the diameter 1.4 by radius and 1 by diameter");
  refused("pos:R:3:sigma:R:1", "", "2 2 1 0.5\n5 5 1 0.7\n",
          "sizes of a mixture are read of columns named radius or diameter alone");
}

TEST_CASE("exports of a mixture carry sizes and kinds") {
  const std::vector<ExportedFrame> frames{frame()};
  const std::string dump = lammps_dump_text(frames);
  CHECK_THAT(dump,
             Contains("ITEM: ATOMS id type x y z radius kind mass coordination voronoi_volume\n"
                      "1 2 2 2 "));
  CHECK_THAT(dump, Contains("\n2 1 5 5 1.5 1.5 0 67.5 0 "));
  const std::string vtk = vtk_points_text(frames.front());
  CHECK_THAT(vtk, Contains("Name=\"radius\"") && Contains("Name=\"kind\""));
  const TemporaryFolder folder;
  write_h5md(folder / "a.h5md", frames);
  const Hdf5Handle file = open_to_read(folder / "a.h5md");
  CHECK(read_numbers<double>(file, "particles/trajectory/radius/value") ==
        mixture().sizes->radii());
  CHECK(read_numbers<std::uint32_t>(file, "particles/trajectory/kind/value") ==
        mixture().sizes->kind_of());
}
