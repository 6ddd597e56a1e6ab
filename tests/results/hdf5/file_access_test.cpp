#include <fmt/format.h>

#include <catch2/catch.hpp>

#include "results/hdf5/read.hpp"
#include "results/hdf5/writable_file.hpp"
#include "tests/results/temporary_folder.hpp"

using namespace jostle;

// The largest number of realizations of a scene. Where their names, 44 MB, find no room in HDF5's
// cache they are read and written again for each: hours.
TEST_CASE("A group of a million members keeps its names in the cache, written and read", "[slow]") {
  const TemporaryFolder folder;
  const std::string path = folder / "million.h5";
  constexpr int members = 1'000'000;
  const auto hit_rate = [](hid_t file) {
    double rate = 0;
    checked(H5Fget_mdc_hit_rate(file, &rate));
    return rate;
  };
  {
    WritableHdf5File file(path);
    const Hdf5Handle group(H5Gcreate2(file, "group", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                           H5Gclose);
    const Hdf5Handle member(H5Gcreate2(group, "member", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                            H5Gclose);
    for (int i = 0; i < members; ++i) {
      checked(H5Lcreate_hard(group, "member", group, fmt::format("realization_{:06}", i).c_str(),
                             H5P_DEFAULT, H5P_DEFAULT));
    }
    CHECK(hit_rate(file) > 0.99);
    file.close();
  }
  const Hdf5Handle file = open_to_read(path);
  for (int i = 0; i < 10'000; ++i) {
    REQUIRE(H5Lexists(file, fmt::format("group/realization_{:06}", i).c_str(), H5P_DEFAULT) > 0);
  }
  CHECK(hit_rate(file) > 0.95);
}
