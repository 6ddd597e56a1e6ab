#include "engine/number_reading.hpp"

#include <catch2/catch.hpp>
#include <cstring>
#include <random>
#include <string>
#include <vector>

using namespace jostle;

namespace {

struct Reading {
  std::ptrdiff_t length;
  std::errc fault;
  std::uint64_t bits;
  bool operator==(const Reading&) const = default;
};

using Reader = std::from_chars_result (*)(const char*, const char*, double&, std::chars_format);

Reading reading(Reader read, const std::string& text, std::chars_format format) {
  double value = -77;  // unchanged by a fault
  const auto result = read(text.data(), text.data() + text.size(), value, format);
  std::uint64_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return {result.ptr - text.data(), result.ec, bits};
}

const std::vector<std::string> texts = {"0",
                                        "-0",
                                        "1",
                                        "-1.5",
                                        "0.1",
                                        ".5",
                                        "5.",
                                        "-.5e1",
                                        "1e",
                                        "1e+",
                                        "1e5x",
                                        "1E-5",
                                        "+1",
                                        " 1",
                                        "1 ",
                                        "",
                                        "-",
                                        ".",
                                        "-.",
                                        "e5",
                                        "1e400",
                                        "-1e400",
                                        "1e-400",
                                        "0e-400",
                                        "4.9e-324",
                                        "1e-310",
                                        "2.2250738585072011e-308",
                                        "1.7976931348623159e308",
                                        "1.7976931348623157e308",
                                        "inf",
                                        "-inf",
                                        "infinity",
                                        "INFI",
                                        "nanx",
                                        "-Infinityx",
                                        "0x10",
                                        "1,5",
                                        "1.2.3",
                                        "--1",
                                        "123456789012345678901234567890",
                                        "9007199254740993",
                                        "0.30000000000000004",
                                        "1e5e5",
                                        "1e-"};

}  // namespace

TEST_CASE("decimal numbers are read as from_chars reads them, with and without it") {
  for (const std::chars_format format : {std::chars_format::general, std::chars_format::fixed}) {
    for (const std::string& text : texts) {
      CAPTURE(text);
      CHECK(reading(portable::read_decimal, text, format) == reading(read_decimal, text, format));
    }
  }
  const auto general = std::chars_format::general;
  CHECK(reading(portable::read_decimal, "0.1x", general) ==
        Reading{3, std::errc(), 0x3fb999999999999a});
  CHECK(reading(portable::read_decimal, "1e400", general).fault == std::errc::result_out_of_range);
  CHECK(reading(portable::read_decimal, "+1", general).fault == std::errc::invalid_argument);
  std::mt19937_64 random(1);
  constexpr char letters[] = "0123456789.e+-";
  for (int i = 0; i < 20'000; ++i) {
    std::string text;
    for (auto n = 1 + random() % 12; n > 0; --n) text += letters[random() % (sizeof letters - 1)];
    CAPTURE(text);
    REQUIRE(reading(portable::read_decimal, text, general) == reading(read_decimal, text, general));
  }
}
