#include "study/amounts.hpp"

#include <catch2/catch.hpp>

using namespace jostle;

TEST_CASE("Counts and bytes take a unit") {
  CHECK(format_count(950) == "950");
  CHECK(format_count(4.1e7) == "41.0 M");
  CHECK(format_bytes(512) == "512 B");
  CHECK(format_bytes(3.5 * 1024 * 1024) == "3.5 MiB");
}
