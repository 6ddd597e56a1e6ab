#include <catch2/catch.hpp>

#include "tests/config/scene_files.hpp"

namespace jostle {

// Every NAME.json of the folder has a NAME.faults beside it: the messages, line by line.
TEST_CASE("Every bad scene is refused with all its faults, pointers and messages") {
  const auto files = json_files(bad_scenes);
  CHECK(files.size() >= 40);
  for (const auto& file : files) {
    INFO(file.filename().string());
    const ParsedScene parsed = parse_scene(text_of(file));
    CHECK_FALSE(parsed.scene.has_value());
    const std::string expected = text_of(std::filesystem::path(file).replace_extension(".faults"));
    CHECK_FALSE(expected.empty());
    CHECK(lines(parsed.faults) == expected);
  }
}

TEST_CASE("Every expected list of faults belongs to a bad scene") {
  for (const auto& entry : std::filesystem::directory_iterator(bad_scenes)) {
    INFO(entry.path().string());
    CHECK(std::filesystem::exists(std::filesystem::path(entry.path()).replace_extension(".json")));
  }
}

TEST_CASE("Nothing is read past a NUL byte") {
  const std::string text = text_of(good_scenes / "every_key.json");
  for (const std::string& bytes : {std::string(1, '\0'), std::string("\0 no JSON", 9)}) {
    const ParsedScene parsed = parse_scene(text + bytes);
    CHECK_FALSE(parsed.scene.has_value());
    REQUIRE(parsed.faults.size() == 1);
    CHECK(parsed.faults[0].message ==
          "byte " + std::to_string(text.size() + 1) + " is NUL: JSON is text without it");
  }
}

TEST_CASE("Faults of an arbitrary text never end the program") {
  const std::string text = text_of(good_scenes / "every_key.json");
  for (std::size_t length = 0; length < text.size() - 2; ++length) {
    const ParsedScene parsed = parse_scene(text.substr(0, length));
    CHECK_FALSE(parsed.scene.has_value());
    CHECK(parsed.faults.size() == 1);
  }
}

}  // namespace jostle
