#include "cli/tables/durations.hpp"

#include <catch2/catch.hpp>
#include <limits>

using namespace jostle;

TEST_CASE("Durations are read with units, summed, seconds by default") {
  CHECK(parse_duration("90") == Seconds(90));
  CHECK(parse_duration("0") == Seconds(0));
  CHECK(parse_duration("1.5h") == Seconds(5400));
  CHECK(parse_duration("1h30m") == Seconds(5400));
  CHECK(parse_duration("2d1s") == Seconds(172801));
  CHECK(parse_duration("1m30s500ms") == Seconds(90.5));
  CHECK(parse_duration("1000000000") == Seconds(1e9));
  CHECK(parse_duration("250ms").value().count() == Approx(0.25));
}

TEST_CASE("A text that is not a duration is refused") {
  for (const char* text :
       {"", "h", "-5s", "5 s", "5x", "1h-2m", "inf", "nan", "1e400", "s5", "1h30", "2d0", "1m1",
        "30m1h", "1h1h", "1m1m", "11574d12h", "9999999999999999999999"}) {
    INFO(text);
    CHECK_FALSE(parse_duration(text));
  }
}

TEST_CASE("Why a text is no duration names it and the rule") {
  CHECK(duration_fault("1h30").starts_with("\"1h30\" is not a duration"));
  CHECK(duration_fault("1h30").find("1h30m") != std::string::npos);
}

TEST_CASE("Durations are shown in the two largest units") {
  CHECK(format_duration(Seconds(0.05)) == "50 ms");
  CHECK(format_duration(Seconds(5.25)) == "5.2 s");
  CHECK(format_duration(Seconds(59.6)) == "1 min 0 s");
  CHECK(format_duration(Seconds(3725)) == "1 h 2 min");
  CHECK(format_duration(Seconds(180000)) == "2 d 2 h");
  CHECK(format_duration(Seconds(1e30)) == "1.16e+25 d");
  CHECK(format_duration(Seconds(std::numeric_limits<double>::infinity())) == "unknown");
}
