#include "study/drawing/page/sections/blocks.hpp"

#include <catch2/catch.hpp>

#include "study/drawing/figures/table_view.hpp"
#include "study/drawing/page/page_json.hpp"

using namespace jostle;

TEST_CASE("A cell shows a lower bound with its sign, and a value with its error") {
  const DrawnTable drawn{
      "analysis",
      {.name = "point_0000/steady/z",
       .quantities = {{.name = "sigma",
                       .values = std::vector<double>{0.0110162},
                       .units = "diameter",
                       .long_name = "lower bound of the deviation of single taps"},
                      {.name = "value", .values = std::vector<double>{3.25}, .units = "diameter"},
                      {.name = "value_error", .values = std::vector<double>{0.02}},
                      {.name = "value_dof", .values = std::vector<double>{1e9}}}}};
  const TableView table(drawn);
  CHECK(value_cell(table, "sigma") == "≥ 0.011 diameter");
  CHECK(value_cell(table, "value") == "3.250(20) diameter");
}

TEST_CASE("A long text of a page ends with a whole character") {
  const auto shown = [](std::string_view text, std::size_t longest) {
    return page_text(text, longest).text();
  };
  CHECK(shown("a\xce\xb5", 3) == "a\xce\xb5");
  CHECK(shown("a\xce\xb5z", 3) == "a\xce\xb5...");
  CHECK(shown("a\xce\xb5z", 2) == "a...");
  CHECK(shown("\xe2\x89\xa5z", 2) == "...");
  CHECK(shown("\xf0\x9f\x8e\xb2z", 3) == "...");
  CHECK(shown("\x80\x80\x80\x80\x80\x80\x80", 6) == R"(\x80\x80\x80\x80\x80\x80...)");
}
