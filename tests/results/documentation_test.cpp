#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <filesystem>

#include "results/checkpoints/part.hpp"
#include "results/content/record.hpp"
#include "results/disk/input_file.hpp"
#include "results/groups/layout.hpp"
#include "tests/test_files.hpp"

using namespace jostle;

TEST_CASE("The page of the format quotes the numbers of its formats as they are") {
  const std::string page = read_text_file(source_file("docs/reference/file-format.md"));
  for (const std::string& quoted : {fmt::format("its format's number ({})", part_format),
                                    fmt::format("**layout {}**", layout_version),
                                    fmt::format("`{}`", keeps_what_point_keeps)}) {
    INFO(quoted);
    CHECK(page.find(quoted) != std::string::npos);
  }
}

TEST_CASE("The page of the format names all that snapshots keep of spheres and by height") {
  const std::string page = read_text_file(source_file("docs/reference/file-format.md"));
  for (const SphereVector& vector : sphere_vectors) {
    INFO(vector.name);
    CHECK(page.find(fmt::format("{}/value`", vector.name)) != std::string::npos);
  }
  for (const HeightProfile& profile : height_profiles) {
    INFO(profile.name);
    CHECK(page.find(profile.name) != std::string::npos);
  }
}
