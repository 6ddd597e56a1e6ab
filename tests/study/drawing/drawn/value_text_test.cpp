#include "study/drawing/drawn/value_text.hpp"

#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>
#include <limits>

#include "config/json/json.hpp"
#include "tests/test_files.hpp"

// The page (tests/report/page_test.py) and the Python package (tests/python/plot_test.py) are
// tested with the same vectors.
using namespace jostle;

namespace {

double number_of(const Json& value) {
  if (!value.is_string()) return value.number();
  if (value.text() == "nan") return std::numeric_limits<double>::quiet_NaN();
  return value.text() == "inf" ? std::numeric_limits<double>::infinity()
                               : -std::numeric_limits<double>::infinity();
}

Json vectors() {
  std::ifstream file(test_data("value_texts.json"));
  return Json::parse(std::string(std::istreambuf_iterator<char>(file), {}));
}

}  // namespace

TEST_CASE("numbers are shown as in the shared vectors") {
  const Json all = vectors();
  REQUIRE(all.at("numbers").size() > 20);
  for (const Json& sample : all.at("numbers").elements()) {
    CAPTURE(sample.dump());
    CHECK(typeset_number(number_of(sample.at(0)), static_cast<int>(sample.at(1).number())) ==
          sample.at(2).text());
  }
  for (const Json& sample : all.at("with_error").elements()) {
    CAPTURE(sample.dump());
    CHECK(typeset_with_error(number_of(sample.at(0)), number_of(sample.at(1))) ==
          sample.at(2).text());
  }
  for (const Json& sample : all.at("counts").elements()) {
    CHECK(typeset_count(sample.at(0).number()) == sample.at(1).text());
  }
  for (const Json& sample : all.at("durations").elements()) {
    CHECK(typeset_duration(sample.at(0).number()) == sample.at(1).text());
  }
}

TEST_CASE("The page rounds no p-value to the level of its test") {
  CHECK(typeset_p(0.0495) == "p = 0.0495");
  CHECK(typeset_p(0.0512) == "p = 0.051");
  CHECK(typeset_p(0.0193) == "p = 0.019");
}
