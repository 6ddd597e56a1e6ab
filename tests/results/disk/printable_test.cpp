#include "results/disk/printable.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using namespace jostle;

namespace {

// ESC, DEL, a C1 control, and characters that turn the direction or begin a line.
const char* const hidden[] = {"\x1b",         "\x7f",         "\xc2\x9b",     "\xd8\x9c",
                              "\xe2\x80\x8f", "\xe2\x80\xa8", "\xe2\x80\xa9", "\xe2\x80\xae",
                              "\xe2\x81\xa6", "\xe2\x81\xa9"};

std::string escaped(const std::string& bytes) {
  std::string text;
  for (const char c : bytes) {
    char digits[8];
    std::snprintf(digits, sizeof digits, "\\x%02x", static_cast<unsigned char>(c));
    text += digits;
  }
  return text;
}

}  // namespace

TEST_CASE("Characters that a terminal would not show are escaped in texts and names") {
  for (const std::string character : hidden) {
    CHECK(printable("a" + character + "b") == "a" + escaped(character) + "b");
    CHECK(printable_name("a" + character + "b") == "a" + escaped(character) + "b");
  }
  CHECK(printable("two\nlines, \tand \xc3\xa9") == "two\nlines, \tand \xc3\xa9");
  CHECK(printable_name("two\nlines, \tand \xc3\xa9") == "two\\x0alines, \\x09and \xc3\xa9");
}

TEST_CASE("JSON is shown without what turns or controls a terminal, and reads the same") {
  for (const std::string character : hidden) {
    const nlohmann::json json = {{"name", "a" + character + "b"},
                                 {"\xc3\xa9 \xf0\x9f\x98\x80", 1.5}};
    const std::string shown = printable_json(json.dump(2));
    CHECK(shown.find(character) == std::string::npos);
    CHECK(printable(shown) == shown);
    CHECK(nlohmann::json::parse(shown) == json);
  }
}
