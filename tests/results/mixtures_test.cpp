#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>

#include "results/checkpoints/part.hpp"
#include "results/disk/error.hpp"
#include "results/disk/seal.hpp"
#include "results/export/packing_file.hpp"
#include "results/hdf5/read.hpp"
#include "results/hdf5/write.hpp"
#include "results/run/merge.hpp"
#include "runs.hpp"
#include "temporary_folder.hpp"

using namespace jostle;
using namespace jostle::synthetic;
using Catch::Matchers::Contains;

namespace {

const StudySpheres mixtures[] = {StudySpheres::fixed, StudySpheres::drawn};

std::uint32_t layout_of(const std::string& path) {
  return read_number_attribute<std::uint32_t>(open_to_read(path), "jostle_format");
}

/// Changes a file by HDF5 and seals it again.
void forge(const std::string& path, const std::function<void(hid_t)>& change) {
  {
    const Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    change(file);
  }
  seal(path);
}

template <class Number>
void put(hid_t file, const std::string& name, std::uint64_t index, Number value) {
  auto values = read_numbers<Number>(file, name);
  values.at(index) = value;
  const Hdf5Handle dataset = open_dataset(file, name);
  checked(H5Dwrite(dataset, Hdf5Number<Number>::memory(), H5S_ALL, H5S_ALL, H5P_DEFAULT,
                   values.data()));
}

}  // namespace

TEST_CASE("sizes of a mixture are stored and read back, drawn ones of each realization") {
  const TemporaryFolder folder;
  for (const StudySpheres kinds : mixtures) {
    const std::string path = folder / "one.h5";
    const StudySize size{.kinds = kinds};
    run_to_end(path, size);
    const ResultsFile file(path);
    const auto& mixture = file.study().points[1].mixture;
    REQUIRE(mixture);
    CHECK(mixture == file.study().points[0].mixture);  // shared by points that have the same
    CHECK(mixture->kinds == std::vector<SphereKind>{{"small", 1}, {"large", 2.5}});
    CHECK(mixture->kind_of == std::vector<std::uint32_t>{0, 1, 0, 1, 0});
    CHECK(mixture->drawn() == (kinds == StudySpheres::drawn));
    const auto first = file.sizes({0, 0}), second = file.sizes({1, 2});
    REQUIRE(first->size() == 5);
    CHECK(first->kinds()[1].density == 2.5);
    CHECK(second->mass(1) == 2.5 * std::pow(second->diameter(1), 3));
    CHECK((*first == *second) == (kinds == StudySpheres::fixed));
    CHECK(*file.sizes({0, 0}) == *read_packing(path).sizes);
    CHECK(layout_of(path) == 2);
    std::filesystem::remove(path);
  }
}

TEST_CASE("files of equal spheres keep the layout that older versions read") {
  const TemporaryFolder folder;
  run_to_end(folder / "equal.h5");
  CHECK(layout_of(folder / "equal.h5") == 1);
  CHECK(ResultsFile(folder / "equal.h5").sizes({0, 0}) == nullptr);
  CHECK_FALSE(exists(open_to_read(folder / "equal.h5"), "spheres"));
}

TEST_CASE("sizes are part of the digest, and do not depend on stops, kills or shards") {
  const TemporaryFolder folder;
  const std::string equal = run_to_end(folder / "equal.h5");
  for (const StudySpheres kinds : mixtures) {
    const StudySize size{.kinds = kinds};
    const Study whole = study(size);
    const std::string name = kinds == StudySpheres::fixed ? "fixed" : "drawn";
    const std::string expected = run_to_end(folder / (name + ".h5"), size);
    CHECK(expected != equal);
    const std::string stopped = folder / (name + "_stopped.h5");
    {
      const auto store = RunStore::create(stopped, whole, {}, provenance());
      run_pending(*store, whole, {.steps = 7, .leave_without_end = true});
    }
    for (const std::uint64_t steps : {5, 1000}) {
      const auto store = RunStore::resume(stopped, whole, {}, provenance());
      run_pending(*store, whole, {.steps = steps});
      store->finish();
    }
    CHECK(digest_of(stopped) == expected);
    std::vector<std::string> shards;
    for (std::uint32_t i = 1; i <= 3; ++i) {
      shards.push_back(folder / (name + std::to_string(i) + ".h5"));
      run_to_end(shards.back(), size, {i, 3});
    }
    const std::string merged = folder / (name + "_merged.h5");
    merge_files(shards, merged, provenance());
    CHECK(digest_of(merged) == expected);
  }
}

TEST_CASE("realizations that have not begun have no drawn sizes") {
  const TemporaryFolder folder;
  const StudySize size{.kinds = StudySpheres::drawn};
  run_to_end(folder / "share.h5", size, {1, 3});
  const ResultsFile file(folder / "share.h5");
  for (const RealizationSummary& realization : file.realizations()) {
    if (realization.status == RealizationStatus::done)
      CHECK(file.sizes(realization.id)->size() == 5);
    else
      CHECK_THROWS_WITH(file.sizes(realization.id), Contains("has not begun"));
  }
}

TEST_CASE("restart states keep drawn sizes, and those of equal spheres keep their bytes") {
  RealizationState state;
  state.rows = 3;
  state.centres = {{1, 2, 3}};
  ByteWriter equal;
  put(equal, state);
  state.diameters = {1.25};
  ByteWriter mixed;
  put(mixed, state);
  CHECK(mixed.bytes().size() == equal.bytes().size() + 16);
  ByteReader reader(mixed.bytes());
  CHECK(get_realization_state(reader).diameters == state.diameters);
  ByteReader second_reader(equal.bytes());
  CHECK(get_realization_state(second_reader).diameters.empty());
}

TEST_CASE("files with wrong, missing or NaN sizes are refused") {
  const TemporaryFolder folder;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  run_to_end(folder / "fixed.h5", {.kinds = StudySpheres::fixed});
  run_to_end(folder / "drawn.h5", {.kinds = StudySpheres::drawn});
  run_to_end(folder / "equal.h5");
  int n_forged = 0;
  const auto forged = [&](const char* name, const std::function<void(hid_t)>& change) {
    const std::string path = folder / ("forged" + std::to_string(n_forged++) + ".h5");
    std::filesystem::copy_file(folder / name, path,
                               std::filesystem::copy_options::overwrite_existing);
    forge(path, change);
    return path;
  };
  const std::string diameter = "spheres/point_0000/diameter", kind = "spheres/point_0000/kind";
  for (const double bad : {nan, 0.0, -1.0, 0.1, 11.0}) {
    const auto change = [&](hid_t file) { put(file, diameter, 2, bad); };
    CHECK_THROWS_WITH(ResultsFile(forged("fixed.h5", change)), Contains("sphere 2 has the diam"));
    const ResultsFile drawn(forged("drawn.h5", change));
    CHECK_THROWS_WITH(drawn.sizes({0, 0}), Contains("sphere 2 has the diameter"));
    CHECK_THROWS_AS(drawn.restart_state({0, 0}), ResultsError);
    CHECK_NOTHROW(drawn.restart_state({0, 1}));
  }
  // A restart state with other spheres than those stored.
  const ResultsFile forged_file(
      forged("drawn.h5", [&](hid_t file) { put(file, diameter, 2, 1.3); }));
  CHECK_THROWS_WITH(forged_file.restart_state({0, 0}), Contains("spheres of other sizes"));
  const auto refused = [&](const char* name, const std::function<void(hid_t)>& change) {
    CHECK_THROWS_AS(ResultsFile(forged(name, change)), ResultsError);
  };
  refused("fixed.h5", [&](hid_t file) { put<std::uint32_t>(file, kind, 0, 2); });
  refused("fixed.h5", [](hid_t file) { put(file, "spheres/point_0000/density", 0, 0.0); });
  for (const char* name : {"diameter", "kind", "name", "density"}) {
    refused("fixed.h5", [&](hid_t file) {
      checked(H5Ldelete(file, ("spheres/point_0000/" + std::string(name)).c_str(), H5P_DEFAULT));
    });
  }
  // A file whose layout and spheres do not go together would be taken for equal ones.
  const auto remove_spheres = [](hid_t file) { checked(H5Ldelete(file, "spheres", H5P_DEFAULT)); };
  const auto set_layout = [](std::uint32_t layout) {
    return [layout](hid_t file) {
      checked(H5Adelete(file, "jostle_format"));
      write_attribute(file, "jostle_format", layout);
    };
  };
  refused("fixed.h5", remove_spheres);
  refused("fixed.h5", set_layout(1));
  refused("fixed.h5", set_layout(3));
  refused("equal.h5", set_layout(2));
}
