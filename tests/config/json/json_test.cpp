#include "config/json/json.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

namespace jostle {

TEST_CASE("A value is printed as the library prints it") {
  for (const char* text :
       {"null", "true", "0", "-7", "18446744073709551615", "-9223372036854775808", "0.1", "1e-05",
        "1e300", "12.0", "-0.0", "5e-324", "123456789012345680.0", "\"a\\\"\\\\\\n\\u0001\"",
        R"({"b": [1, {"c": []}], "a": {}, "b c": [[], null]})", R"(["ä", "\ud83d\ude00"])"}) {
    CAPTURE(text);
    const auto expected = nlohmann::ordered_json::parse(text);
    CHECK(Json::parse(text).dump() == expected.dump());
    CHECK(Json::parse(text).dump(2) == expected.dump(2));
  }
  CHECK(Json("\xff").dump() == "\"\xef\xbf\xbd\"");
  CHECK_THROWS_AS(Json::parse("{"), JsonError);
}

TEST_CASE("Values are made as they are written") {
  const Json made = {{"name", "x"},
                     {"count", 3},
                     {"below", -3},
                     {"nested", {{"flag", true}, {"list", Json::array({1, "a", nullptr})}}},
                     {"taps", std::vector<std::uint64_t>{1, 10}}};
  CHECK(made.dump() ==
        R"({"name":"x","count":3,"below":-3,"nested":{"flag":true,"list":[1,"a",null]},)"
        R"("taps":[1,10]})");
  CHECK(made.at("nested").at("list").at(std::size_t{1}).text() == "a");
  CHECK(made == Json::parse(made.dump()));
}

TEST_CASE("Members keep their order, are replaced in their place and erased") {
  Json object;
  object["b"] = 1;
  object["a"] = 2;
  object.update({{"b", 3}, {"c", 4}});
  CHECK(object.dump() == R"({"b":3,"a":2,"c":4})");
  object.erase("a");
  object.erase("none");
  CHECK(object.dump() == R"({"b":3,"c":4})");
}

TEST_CASE("Numbers are equal by value, objects in one order") {
  CHECK(Json::parse("1") == Json::parse("1.0"));
  CHECK(Json(std::int64_t{16}) == Json(std::uint64_t{16}));
  CHECK_FALSE(Json(1) == Json("1"));
  CHECK_FALSE(Json::parse(R"({"a": 1, "b": 2})") == Json::parse(R"({"b": 2, "a": 1})"));
}

TEST_CASE("A pointer leads to a value or nowhere") {
  Json json = Json::parse(R"({"a": [{"b/c": 1}, 2], "~": {"": 3}})");
  const auto kind_at = [&](const char* pointer) {
    const Json* found = json.find_pointer(pointer);
    return found ? found->dump() : "nowhere";
  };
  CHECK(kind_at("") == json.dump());
  CHECK(kind_at("/a/0/b~1c") == "1");
  CHECK(kind_at("/a/1") == "2");
  CHECK(kind_at("/~0/") == "3");
  for (const char* none : {"a", "/b", "/a/2", "/a/-", "/a/01", "/a/ 1", "/a/1/x", "/~", "/~2"}) {
    CAPTURE(none);
    CHECK(kind_at(none) == "nowhere");
  }
  *json.find_pointer("/a/1") = "new";
  CHECK(kind_at("/a") == R"([{"b/c":1},"new"])");
}

TEST_CASE("A value of another kind is named") {
  CHECK_THROWS_WITH(Json(1).text(), "expected a string, found a number");
  CHECK_THROWS_WITH(Json::array().members(), "expected an object, found a list");
  CHECK_THROWS_WITH(Json::object().at("seed"), "the key \"seed\" is missing");
  CHECK_THROWS_WITH(Json::array({1}).at(std::size_t{1}), "a list of 1 has no element 1");
  CHECK_THROWS_AS(Json(-1).whole_number(), JsonError);
  CHECK_THROWS_AS(Json(0x1p64).whole_number(), JsonError);
  CHECK(Json(0x1p53 - 1).whole_number() == 9007199254740991u);
  CHECK(Json::parse("9007199254740993").whole_number() == 9007199254740993u);
  CHECK_THROWS_WITH(Json::parse("9007199254740993.0").whole_number(),
                    inexact_whole_text(9007199254740992));
}

}  // namespace jostle
