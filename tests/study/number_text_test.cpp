#include "study/number_text.hpp"

#include <catch2/catch.hpp>

namespace jostle {

TEST_CASE("a number is decimal digits, with a minus, a point and an exponent") {
  CHECK(read_number("12") == 12.0);
  CHECK(read_number("-0.5") == -0.5);
  CHECK(read_number(".5") == 0.5);
  CHECK(read_number("5.") == 5.0);
  CHECK(read_number("1e-3") == 1e-3);
  CHECK(read_number("1E+05") == 1e5);
  CHECK(read_number("007") == 7.0);
}

TEST_CASE("what C reads beside that, and what it reads in part, is no number") {
  for (const char* text :
       {"",    " ",      " 1",  "1 ",    "0x1", "0x1p-2", "0X1F",  "inf",    "-inf", "infinity",
        "nan", "nan(1)", "NaN", "1e",    "1e+", "1_000",  "1'000", "1,5",    "+1",   "--1",
        "-",   ".",      "e5",  "1.2.3", "1f",  "1d0",    "1e400", "1e-400", "one",  "\u0661"}) {
    CAPTURE(text);
    CHECK_FALSE(read_number(text));
    CHECK_FALSE(read_whole_number(text));
  }
}

TEST_CASE("a whole number is decimal digits alone, up to the largest of 64 bits") {
  CHECK(read_whole_number("0") == 0u);
  CHECK(read_whole_number("010") == 10u);
  CHECK(read_whole_number("18446744073709551615") == 18446744073709551615u);
  for (const char* text : {"18446744073709551616", "-1", "1.0", "1e3"}) {
    CAPTURE(text);
    CHECK_FALSE(read_whole_number(text));
  }
}

}  // namespace jostle
