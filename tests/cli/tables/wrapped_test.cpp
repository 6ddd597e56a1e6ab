#include "cli/tables/wrapped.hpp"

#include <catch2/catch.hpp>
#include <sstream>

using namespace jostle;

TEST_CASE("Long lines go on below at a word, two further in") {
  CHECK(wrapped("one two three four\nfive\n", 9) == "one two\n  three\n  four\nfive\n");
  CHECK(wrapped("  ! one two three", 11) == "  ! one two\n    three");
  CHECK(wrapped("short", 80) == "short");
  CHECK(wrapped("", 80) == "");
  CHECK(wrapped("\n\n", 20) == "\n\n");
}

TEST_CASE("The second of two columns continues below itself") {
  CHECK(wrapped("  seed   a b c d e f g", 20) == "  seed   a b c d e f\n         g");
}

TEST_CASE("A word that has no room is not broken, a list is behind its commas") {
  CHECK(wrapped("see /a/very/long/path now", 10) == "see\n  /a/very/long/path\n  now");
  CHECK(wrapped("{\"a\":1,\"b\":2,\"c\":3}", 12) == "{\"a\":1,\n  \"b\":2,\n  \"c\":3}");
}

TEST_CASE("No line is longer than asked for, and no word is lost") {
  std::string text = "start";
  for (int i = 0; i < 200; ++i)
    text += (i % 17 == 3 ? "\n    key  " : " ") + std::string(i % 9 + 1, 'x');
  for (const std::size_t width : {30u, 40u, 79u, 200u}) {
    std::istringstream lines(wrapped(text, width)), words(wrapped(text, width)), all(text);
    for (std::string line; std::getline(lines, line);) CHECK(width_of(line) <= width);
    for (std::string word, expected; all >> word;) CHECK((words >> expected && expected == word));
  }
}

TEST_CASE("Width is in characters") {
  CHECK(width_of("\xce\xb5 = 0.1") == 7);
  CHECK(first_characters("\xce\xb5\xce\xb5 = 0.1", 2) == "\xce\xb5\xce\xb5");
  CHECK(first_characters("\xce\xb5", 2) == "\xce\xb5");
  CHECK(first_characters("\xce\xb5", 0).empty());
}
