#include "cli/reports/curves.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <sstream>
#include <vector>

#include "cli/tables/wrapped.hpp"
#include "results/run/live_run.hpp"
#include "results/run/run_store.hpp"
#include "tests/results/synthetic.hpp"
#include "tests/results/temporary_folder.hpp"

using namespace jostle;

namespace {

/// Grows by as much in every decade.
std::vector<double> logarithm(std::size_t taps) {
  std::vector<double> values{0};
  for (std::size_t tap = 1; tap <= taps; ++tap)
    values.push_back(std::log10(static_cast<double>(tap)));
  return values;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

}  // namespace

TEST_CASE("A logarithm is a straight line on an axis of decades, and tap 0 is apart") {
  const auto lines = lines_of(curve_text("X", logarithm(1000), 40, Glyphs::ascii));
  REQUIRE(lines.size() == 10);
  CHECK(lines[0] == "X over taps");
  CHECK(lines[1].starts_with("3 "));
  CHECK(lines[8].starts_with("0 *  *"));
  CHECK(lines[9].starts_with("  0  1 "));
  CHECK(lines[9].ends_with(" 100      1000"));
  // Eight lines over 35 columns: each begins about five columns further than the one below.
  for (std::size_t line = 1; line < 8; ++line) {
    const auto upper = lines[line].find('*', 3), lower = lines[line + 1].find('*', 3);
    CAPTURE(lines[line], lines[line + 1]);
    CHECK((upper - lower >= 3 && upper - lower <= 6));
  }
}

TEST_CASE(
    "A curve has no line that is too wide, and none where there is no room or nothing to draw") {
  for (const std::size_t width : {30u, 50u, 72u, 200u}) {
    for (const Glyphs glyphs : {Glyphs::ascii, Glyphs::unicode}) {
      for (const std::string& line : lines_of(curve_text("X", logarithm(7), width, glyphs)))
        CHECK(width_of(line) <= std::min<std::size_t>(width, 72));
    }
  }
  CHECK(curve_text("X", logarithm(1000), 20, Glyphs::ascii).empty());
  CHECK(curve_text("X", logarithm(1), 80, Glyphs::ascii).empty());
  CHECK(curve_text("X", std::vector(9, std::nan("")), 80, Glyphs::ascii).empty());
}

TEST_CASE("A curve may be flat, or have taps without a value") {
  const std::vector<double> flat(20, 0.5);
  CHECK(lines_of(curve_text("X", flat, 40, Glyphs::ascii))[8].find("**********") !=
        std::string::npos);
  std::vector<double> values = logarithm(100);
  for (std::size_t tap = 0; tap < 50; ++tap) values[tap] = std::nan("");
  CHECK(lines_of(curve_text("X", values, 40, Glyphs::ascii)).size() == 10);
}

TEST_CASE("Braille has eight dots a character") {
  const std::string text = curve_text("X", logarithm(1000), 40, Glyphs::unicode);
  CHECK(text.find("\xe2\xa1\x80") != std::string::npos);  // tap 0 in the last of four dots
  CHECK(text.find('*') == std::string::npos);
}

TEST_CASE("A line of a sweep point has a character a place on the axis") {
  CHECK(sparkline(logarithm(10'000'000), 0, 7, 8, Glyphs::ascii) == "_.-=+*#%");
  CHECK(sparkline(logarithm(1000), 0, 3, 4, Glyphs::unicode) == "▁▃▆█");
  const double nan = std::nan("");
  CHECK(sparkline(std::vector{0.0, nan, 7.0}, 0, 7, 3, Glyphs::ascii) == "_ %");
  CHECK(sparkline({}, 0, 1, 9, Glyphs::ascii).empty());
}

TEST_CASE("A long label of a sweep point is cut after a whole character") {
  const TemporaryFolder folder;
  Study study = synthetic::study({.points = 2, .realizations = 1});
  std::string letters;
  for (int i = 0; i < 30; ++i) letters += "\xce\xb5";
  study.points[0].label = letters;
  study.points[1].label = "x" + letters;
  const auto store = RunStore::create(folder / "a.h5", study, {}, synthetic::provenance());
  for (const std::uint32_t point : {0u, 1u}) synthetic::run(*store, study, {point, 0});
  const std::string shown =
      compaction_curves(live_results(folder / "a.h5", Content::everything), 40, Glyphs::ascii);
  CHECK(shown.find("  " + letters.substr(0, 40) + "  ") != std::string::npos);
  CHECK(shown.find("  x" + letters.substr(0, 38) + "  ") != std::string::npos);
}
