#include "config/json/json_text.hpp"

#include <catch2/catch.hpp>

namespace jostle {

TEST_CASE("JSON text is read with its order of keys") {
  std::vector<Fault> faults;
  const auto json = read_json(R"({"b": 1, "a": [true, null]})", faults);
  REQUIRE(json.has_value());
  CHECK(faults.empty());
  CHECK(json->dump() == R"({"b":1,"a":[true,null]})");
}

TEST_CASE("Duplicate keys are faults at their pointers, in lists too") {
  std::vector<Fault> faults;
  const auto json = read_json(R"({"x": [0, {"a/b": 1, "a/b": {"c": 1, "c": 2}}], "x": 1})", faults);
  CHECK(json.has_value());
  REQUIRE(faults.size() == 3);
  CHECK(faults[0].pointer == "/x/1/a~1b");
  CHECK(faults[1].pointer == "/x/1/a~1b/c");
  CHECK(faults[2].pointer == "/x");
}

TEST_CASE("Equal keys of different objects are no duplicates") {
  std::vector<Fault> faults;
  read_json(R"([{"a": {"a": 1}}, {"a": 2}, {"b": {"a": 3}, "a": 4}])", faults);
  CHECK(faults.empty());
}

TEST_CASE("Comments and trailing commas are named, with their place") {
  const auto fault = [](const char* text) {
    std::vector<Fault> faults;
    CHECK_FALSE(read_json(text, faults).has_value());
    return faults.size() == 1 ? faults.front().message : "not one fault";
  };
  const std::string comment = "a comment: JSON has neither comments nor trailing commas";
  CHECK(fault("{\n  // the name\n  \"name\": 1}") == "not JSON: line 2, column 3: " + comment);
  CHECK(fault("{\"a\": 1, /* one */ \"b\": 2}") == "not JSON: line 1, column 10: " + comment);
  CHECK(fault("# scene\n{}") == "not JSON: line 1, column 1: " + comment);
  const std::string comma =
      "a comma before the end of a list or an object: JSON has neither comments nor trailing "
      "commas";
  CHECK(fault("{\"a\": [1, 2,]}") == "not JSON: line 1, column 13: " + comma);
  CHECK(fault("{\n  \"a\": 1,\n}\n") == "not JSON: line 3, column 1: " + comma);
  CHECK(fault("{\"a\": 1 2}").find("comma") == std::string::npos);
  CHECK(fault("{]}").find("trailing") == std::string::npos);
}

TEST_CASE("Text that is not UTF-8 is not JSON") {
  std::vector<Fault> faults;
  CHECK_FALSE(read_json("{\"name\": \"\xff\"}", faults).has_value());
  CHECK(faults.size() == 1);
}

TEST_CASE("Canonical text is one for all ways to write a value") {
  const auto canonical = [](const char* text) { return canonical_text(Json::parse(text)); };
  CHECK(canonical("8") == "8");
  CHECK(canonical("8.0") == "8");
  CHECK(canonical("80e-1") == "8");
  CHECK(canonical("-0.0") == "0");
  CHECK(canonical("0.020") == "0.02");
  CHECK(canonical("1e-5") == "1e-05");
  CHECK(canonical("18446744073709551615") == "18446744073709551615");
  CHECK(canonical("0.1") == "0.1");
  CHECK(canonical(R"({"b": [1.0, "x"], "a": true})") == R"({"a":true,"b":[1,"x"]})");
}

TEST_CASE("A pointer is within itself and its ancestors only") {
  CHECK(is_within("/a/b", "/a"));
  CHECK(is_within("/a", "/a"));
  CHECK(is_within("/a", ""));
  CHECK_FALSE(is_within("/ab", "/a"));
  CHECK_FALSE(is_within("/a", "/a/b"));
}

}  // namespace jostle
