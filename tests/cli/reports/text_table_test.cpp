#include "cli/reports/text_table.hpp"

#include <catch2/catch.hpp>
#include <cmath>

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

TEST_CASE("A value and its error share their decimals or their power of ten") {
  CHECK(value_and_error(0.56831, 0.0021) == "0.5683 +- 0.0021");
  CHECK(value_and_error(12.345678, 0.21) == "12.35 +- 0.21");
  CHECK(value_and_error(1239.6, 85.2) == "1240 +- 85");
  CHECK(value_and_error(0.5, 0.00996) == "0.500 +- 0.010");  // to its second digit as printed
  CHECK(value_and_error(-0.0000123, 0.000045) == "-0.000012 +- 0.000045");
  CHECK(value_and_error(2.0487283e-06, 7.4e-07) == "(2.05 +- 0.74)e-06");
  CHECK(value_and_error(0.593890243, 2.8e-7) == "(5.9389024 +- 0.0000028)e-01");
  CHECK(value_and_error(3.1e-9, 4.2e-7) == "(0.0 +- 4.2)e-07");
  CHECK(value_and_error(1.25e9, 3e6) == "(1.2500 +- 0.0030)e+09");
}

TEST_CASE("Rounding noise is printed as 0, beside the scale of what is measured") {
  CHECK(value_and_error(-8.3e-17, 1.7e-16) == "0");
  CHECK(value_and_error(3e-15, 2e-15, 100) == "0");
  CHECK(value_and_error(3e-15, 2e-12) == "(0.0 +- 2.0)e-12");
  CHECK(value_and_error(2.5e-16, 1e-17, 1e-10) == "(2.50 +- 0.10)e-16");
}

TEST_CASE("A value without an error has six digits") {
  const double nan = std::nan("");
  CHECK(value_and_error(0.123456789, nan) == "0.123457");
  CHECK(value_and_error(0.123456789, 0) == "0.123457");
  CHECK(value_and_error(0.123456789, HUGE_VAL) == "0.123457");
  CHECK(value_and_error(HUGE_VAL, 1) == "inf");
}
