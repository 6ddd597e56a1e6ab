#include "results/export/export.hpp"

#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>
#include <sstream>

#include "results/export/h5md.hpp"
#include "results/export/packing_file.hpp"
#include "tests/results/runs.hpp"
#include "tests/results/temporary_folder.hpp"

using namespace jostle;
using Catch::Matchers::Contains;

namespace {

std::array<std::uint64_t, 3> bits(Vec3 r) {
  return {std::bit_cast<std::uint64_t>(r.x), std::bit_cast<std::uint64_t>(r.y),
          std::bit_cast<std::uint64_t>(r.z)};
}

void require_same_bits(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) CHECK(bits(a[i]) == bits(b[i]));
}

/// Numbers that careless text loses: denormals, -0, neighbours of 1, all 17 digits.
Packing hard_to_write() {
  using Limits = std::numeric_limits<double>;
  return {FullyPeriodicBox{4, 1 / 0.3, 5.1},
          {{Limits::denorm_min(), -0.0, Limits::min()},
           {2.5, 123 * Limits::denorm_min(), 1e-300},
           {1 + Limits::epsilon(), 1 - Limits::epsilon() / 2, 0.1 + 0.2},
           {2.0 / 3, 3.3, std::nextafter(5.1, 0.0)}}};
}

void write(const std::vector<ExportedFile>& files) {
  for (const ExportedFile& file : files) std::ofstream(file.path, std::ios::binary) << file.text;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// One sphere in the middle of a 3 d cube: its Voronoi cell is the cube.
ExportedFrame one_sphere(std::uint64_t tap) {
  Packing packing{FullyPeriodicBox{3, 3, 3}, {{1.5, 1.5, 1.5}}};
  auto columns = particle_columns(packing);
  return {tap, std::move(packing), std::move(columns)};
}

}  // namespace

TEST_CASE("an exported extended XYZ is a start with the same bits") {
  const TemporaryFolder folder;
  const Packing packing = hard_to_write();
  const ExportedFrame frame{7, packing, particle_columns(packing)};
  const std::string path = folder / "a.xyz";
  const std::vector<ExportedFrame> two = {one_sphere(0), frame};
  write(exported_files(ExportFormat::extended_xyz, path, two));
  CHECK(read_packing(path).container == packing.container);
  require_same_bits(read_packing(path).centres, packing.centres);
  require_same_bits(read_packing(path, {.tap = 0}).centres, two[0].packing.centres);
  write_extended_xyz(path, packing);
  require_same_bits(read_packing(path).centres, packing.centres);
}

TEST_CASE("columns are those of the C++ library") {
  const Packing packing = hard_to_write();
  const auto columns = particle_columns(packing);
  REQUIRE(columns.size() == 5);
  CHECK(columns[0].name == "radius");
  CHECK(std::get<std::vector<double>>(columns[0].values) == std::vector<double>(4, 0.5));
  CHECK(columns[1].name == "coordination");
  CHECK(columns[2].name == "voronoi_volume");
  double volume = 0;
  for (const double v : std::get<std::vector<double>>(columns[2].values)) volume += v;
  CHECK(volume == Approx(4 / 0.3 * 5.1).epsilon(1e-10));
  CHECK(columns[3].name == "q6");
  CHECK(columns[4].name == "structure_type");
  const auto line =
      lines_of(exported_files(ExportFormat::extended_xyz, "a", std::vector{one_sphere(3)})[0].text);
  CHECK(
      line[1] ==
      "Lattice=\"3 0 0 0 3 0 0 0 3\" Properties=species:S:1:pos:R:3:radius:R:1:coordination:I:1:"
      "voronoi_volume:R:1:q6:R:1:structure_type:I:1 pbc=\"T T T\" container=fully_periodic tap=3");
  CHECK_THAT(line[2], Catch::Matchers::StartsWith("X 1.5 1.5 1.5 0.5 0 2"));
}

TEST_CASE("columns identify the spheres of a crystal") {
  Packing fcc{
      FullyPeriodicBox{4 * std::numbers::sqrt2, 4 * std::numbers::sqrt2, 4 * std::numbers::sqrt2},
      {}};
  for (int i = 0; i < 8 * 8 * 8; ++i) {
    const int x = i % 8, y = i / 8 % 8, z = i / 64;
    const double step = 0.5 * std::numbers::sqrt2;
    if ((x + y + z) % 2 == 0) fcc.centres.push_back({x * step, y * step, z * step});
  }
  const auto columns = particle_columns(fcc);
  for (const double q6 : std::get<std::vector<double>>(columns[3].values))
    CHECK(q6 == Approx(0.57452426).epsilon(1e-6));
  CHECK(std::get<std::vector<std::uint32_t>>(columns[4].values) ==
        std::vector<std::uint32_t>(256, 1));
  CHECK(std::get<std::vector<std::uint32_t>>(columns[1].values) ==
        std::vector<std::uint32_t>(256, 12));
}

TEST_CASE("centres a period away are counted where they are, and written as they were") {
  const Packing packing{PeriodicBox{3, 3}, {{-0.5, 1, 0.5}, {0.5, 1, 0.5}}};
  const auto columns = particle_columns(packing);
  CHECK(std::get<std::vector<std::uint32_t>>(columns[1].values) ==
        std::vector<std::uint32_t>{1, 1});
  CHECK_THROWS_WITH(particle_columns({WalledBox{3, 3}, {{1, 1, 1}, {-0.5, 1, 0.5}}}),
                    Contains("sphere 1 lies outside the container"));
}

TEST_CASE("a centre outside a tube is refused where the square around the tube holds it") {
  const Cylinder tube{4};
  CHECK_NOTHROW(wrapped_inside({tube, {{2, 2, 0.5}, {3.41, 3.41, 0.5}, {0, 2, 0.5}}}));
  CHECK_THROWS_WITH(wrapped_inside({tube, {{2, 2, 0.5}, {3.42, 3.42, 0.5}}}),
                    Contains("sphere 1 lies outside the container"));
  CHECK_THROWS_WITH(particle_columns({tube, {{0.1, 3.9, 0.5}, {2, 2, 0.5}}}),
                    Contains("sphere 0 lies outside the container"));
}

TEST_CASE("H5MD keeps frames of one kind of container") {
  const TemporaryFolder folder;
  const std::vector<ExportedFrame> frames = {one_sphere(0),
                                             {1, {WalledBox{3, 3}, {{1.5, 1.5, 1.5}}}, {}}};
  CHECK_THROWS_WITH(write_h5md(folder / "a.h5md", frames),
                    Contains("frame 1 has another than the first"));
}

TEST_CASE("H5MD keeps frames of the same columns") {
  const TemporaryFolder folder;
  std::vector<ExportedFrame> frames = {one_sphere(0), one_sphere(1)};
  frames[0].columns = {{"mass", std::vector<double>{1}}};
  frames[1].columns = {{"mass", std::vector<std::uint32_t>{1}}};
  CHECK_THROWS_WITH(write_h5md(folder / "a.h5md", frames),
                    Contains("frame 1 has others than the first"));
  frames[1].columns.clear();
  CHECK_THROWS_WITH(write_h5md(folder / "a.h5md", frames),
                    Contains("frame 1 has others than the first"));
}

TEST_CASE("a LAMMPS dump holds a frame a tap, to the last bit") {
  const Packing packing = hard_to_write();
  const std::vector<ExportedFrame> frames = {one_sphere(0),
                                             {7, packing, particle_columns(packing)}};
  const auto lines = lines_of(exported_files(ExportFormat::lammps, "a", frames)[0].text);
  REQUIRE(lines.size() == 9 + 1 + 9 + 4);
  CHECK(lines[0] == "ITEM: TIMESTEP");
  CHECK(lines[4] == "ITEM: BOX BOUNDS pp pp pp");
  CHECK(lines[5] == "0 3");
  CHECK(lines[8] ==
        "ITEM: ATOMS id type x y z radius coordination voronoi_volume q6 structure_type");
  CHECK(lines[11] == "7");
  CHECK(lines[13] == "4");
  for (std::size_t i = 0; i < 4; ++i) {
    std::istringstream words(lines[19 + i]);
    std::string id, type, x, y, z;
    words >> id >> type >> x >> y >> z;
    CHECK(id == std::to_string(i + 1));
    const Vec3 back{std::strtod(x.c_str(), nullptr), std::strtod(y.c_str(), nullptr),
                    std::strtod(z.c_str(), nullptr)};
    CHECK(bits(back) == bits(packing.centres[i]));
  }
  const ExportedFrame open{1, {WalledBox{4, 5}, {{1, 1, 2}}}, {}};
  const auto bounds =
      lines_of(exported_files(ExportFormat::lammps, "a", std::span(&open, 1))[0].text);
  CHECK(bounds[4] == "ITEM: BOX BOUNDS ff ff ff");
  CHECK(bounds[7] == "0 2.5");
}

TEST_CASE("VTK's format keeps a frame a file and lists several") {
  const std::vector<ExportedFrame> frames = {one_sphere(0), one_sphere(10)};
  const auto files = exported_files(ExportFormat::vtk, "b/a.vtp", std::span(frames).first(1));
  REQUIRE(files.size() == 1);
  CHECK(files[0].path == "b/a.vtp");
  // The byte count 24 in 8 bytes, then 1.5 three times.
  CHECK_THAT(files[0].text, Contains("GAAAAAAAAAAAAAAAAAD4PwAAAAAAAPg/AAAAAAAA+D8=\n"));
  // The byte count 4, then 0.
  CHECK_THAT(files[0].text, Contains("BAAAAAAAAAAAAAAA\n"));
  const auto several = exported_files(ExportFormat::vtk, "b/a&b.vtp", frames);
  REQUIRE(several.size() == 3);
  CHECK(several[0].path == "b/a&b_tap0.vtp");
  CHECK(several[1].path == "b/a&b_tap10.vtp");
  CHECK(several[2].path == "b/a&b.pvd");
  CHECK_THAT(several[2].text,
             Contains("<DataSet timestep=\"10\" part=\"0\" file=\"a&amp;b_tap10.vtp\"/>"));
  // A name that XML cannot hold cannot be listed.
  for (const char* name : {"a\x1b.vtp", "a\xff.vtp"}) {
    CHECK_THROWS_WITH(exported_files(ExportFormat::vtk, name, frames), Contains("XML cannot hold"));
    CHECK_NOTHROW(exported_files(ExportFormat::vtk, name, std::span(frames).first(1)));
  }
}

TEST_CASE("kept packings are chosen by tap, and what there is is listed") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  synthetic::run_to_end(path);
  const ResultsFile file(path);
  const auto records = file.snapshots({1, 2});
  const auto all = kept_frames(file, {1, 2}, {.all = true});
  REQUIRE(all.size() == 3);
  for (std::size_t f = 0; f < 3; ++f) {
    CHECK(all[f].tap == records[f].tap);
    require_same_bits(all[f].packing.centres, records[f].centres);
    CHECK(all[f].packing.container == Container(PeriodicBox{4, 5}));
    CHECK(all[f].columns.size() == 5);
  }
  const auto two = kept_frames(file, {1, 2}, {.taps = {6, 0}});
  REQUIRE(two.size() == 2);
  CHECK(two[0].tap == 0);
  CHECK(two[1].tap == 6);
  const auto last = kept_frames(file, {1, 2}, {});
  REQUIRE(last.size() == 1);
  CHECK(last[0].tap == 6);
  CHECK_THROWS_WITH(kept_frames(file, {0, 0}, {.taps = {0, 3}}),
                    Contains("holds no positions of tap 3; kept: 0, 2, 6"));
  CHECK_THROWS_WITH(kept_frames(file, {0, 3}, {}),
                    Contains("no positions of sweep point 0, realization 3; the file keeps\n"
                             "  sweep point 0, realization 0: taps 0, 2, 6"));
}
