#include "cli/text_table.hpp"

#include <catch2/catch.hpp>

using namespace jostle;

TEST_CASE("Columns are flush right and as wide as their longest cell") {
  TextTable table({"tap", "mean_height"});
  table.add({"0", "7.5"});
  table.add({"4000", "-"});
  CHECK(table.text() ==
        " tap  mean_height\n"
        "   0          7.5\n"
        "4000            -\n");
}

TEST_CASE("Errors are shown to two digits") {
  CHECK(decimals_for(0.00051) == 5);
  CHECK(decimals_for(0.001) == 4);
  CHECK(decimals_for(25) == 0);
  CHECK(decimals_for(1e-30) == 12);
}

TEST_CASE("Counts and bytes take a unit") {
  CHECK(format_count(950) == "950");
  CHECK(format_count(4.1e7) == "41.0 M");
  CHECK(format_bytes(512) == "512 B");
  CHECK(format_bytes(3.5 * 1024 * 1024) == "3.5 MiB");
}
