#include "cli/tables/text_table.hpp"

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

TEST_CASE("Columns without room follow below, after the keys again") {
  TextTable table({"tap", "M", "mean_height", "bulk_fraction"}, 2);
  table.add({"0", "3", "7.5", "0.58"});
  table.add({"400", "2", "7.25", "0.6"});
  CHECK(table.text(23) ==
        "tap  M  mean_height\n"
        "  0  3          7.5\n"
        "400  2         7.25\n"
        "\n"
        "tap  M  bulk_fraction\n"
        "  0  3           0.58\n"
        "400  2            0.6\n");
  CHECK(table.text(34) == table.text());
  CHECK(table.text(33) == table.text(23));
  CHECK(table.text(5) == table.text(23));  // one column at least
}

TEST_CASE("Columns are as wide as their characters, not their bytes") {
  TextTable table({"\xce\xb5", "x"});
  table.add({"10", "1"});
  CHECK(table.text() == " \xce\xb5  x\n10  1\n");
}
