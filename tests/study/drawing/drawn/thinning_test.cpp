#include "study/drawing/drawn/thinning.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <string_view>

using namespace jostle;

namespace {

bool is_ascending(const std::vector<std::size_t>& places) {
  return std::ranges::adjacent_find(places, std::greater_equal<>()) == places.end();
}

/// A number that identifies its place.
double value_at(std::size_t tap, std::size_t place) {
  return 1000.0 * static_cast<double>(tap) + std::sin(0.01 * static_cast<double>(place));
}

constexpr std::size_t n_taps = 100, n_places = 2000;

/// phi by tap and height with a peak at one place of one tap, beside what else a table holds.
Table table_of(std::size_t peak_tap, std::size_t peak_place) {
  std::vector<std::uint64_t> taps(n_taps);
  std::iota(taps.begin(), taps.end(), 10u);
  std::vector<double> heights(n_places), phi, errors;
  std::iota(heights.begin(), heights.end(), 0.5);
  std::vector<std::string> words;
  for (std::size_t tap = 0; tap < n_taps; ++tap) {
    words.push_back("tap number " + std::to_string(tap));
    for (std::size_t place = 0; place < n_places; ++place) {
      phi.push_back(value_at(tap, place));
      errors.push_back(static_cast<double>(place));
    }
  }
  phi[peak_tap * n_places + peak_place] = 1e9;
  return {.name = "point_0000/profile",
          .axes = {{.name = "tap", .axes = {"tap"}, .values = taps},
                   {.name = "height", .axes = {"height"}, .values = heights}},
          .quantities = {{.name = "phi", .axes = {"tap", "height"}, .values = phi},
                         {.name = "phi_error", .axes = {"tap", "height"}, .values = errors},
                         {.name = "word", .axes = {"tap"}, .values = words},
                         {.name = "alone", .axes = {}, .values = std::vector<double>{7}},
                         {.name = "damaged", .axes = {"tap"}, .values = std::vector<double>{1}}},
          .notes = {{"verdict", "steady"}}};
}

template <class Value>
const std::vector<Value>& values_of(const std::vector<Quantity>& list, std::string_view name) {
  const auto found = std::ranges::find(list, name, &Quantity::name);
  REQUIRE(found != list.end());
  return std::get<std::vector<Value>>(found->values);
}

}  // namespace

TEST_CASE("evenly spread places keep both ends and their order") {
  for (const std::size_t n : {0u, 1u, 2u, 7u, 23u, 24u, 25u, 1000u, 123457u}) {
    for (const std::size_t most : {1u, 2u, 3u, 24u, 400u}) {
      const std::vector<std::size_t> places = evenly_spread(n, most);
      CAPTURE(n, most);
      REQUIRE(places.size() == std::min(n, most));
      CHECK(is_ascending(places));
      if (n == 0) continue;
      CHECK(places.back() == n - 1);
      if (most == 1) continue;
      CHECK(places.front() == 0);
      std::size_t closest = n, widest = 0;
      for (std::size_t i = 1; i < places.size(); ++i) {
        closest = std::min(closest, places[i] - places[i - 1]);
        widest = std::max(widest, places[i] - places[i - 1]);
      }
      if (places.size() > 1) CHECK(widest - closest <= 1);
    }
  }
}

TEST_CASE("logarithmically spread places keep the ends, every early one and so many per decade") {
  CHECK(logarithmically_spread(1, 40, 2) == std::vector<std::size_t>{0});
  CHECK(logarithmically_spread(2, 40, 2) == std::vector<std::size_t>{0, 1});
  const std::vector<std::size_t> places = logarithmically_spread(1'000'001, 40, 2);
  CHECK(is_ascending(places));
  for (std::size_t i = 0; i <= 16; ++i) CHECK(places[i] == i);
  CHECK(places.back() == 1'000'000);
  for (const double decade : {1e3, 1e4, 1e5}) {
    CHECK(std::ranges::count_if(places, [&](std::size_t place) {
            return double(place) >= decade && double(place) < 10 * decade;
          }) == 40);
  }
  // Where strengths change, late places count as well.
  const std::vector<std::size_t> even = logarithmically_spread(10'000, 5, 100);
  CHECK(is_ascending(even));
  CHECK(std::ranges::count_if(even, [](std::size_t place) { return place >= 5000; }) >= 50);
}

TEST_CASE("extremes are those of finite values") {
  const double nan = std::nan("");
  CHECK(extremes_of(std::vector<double>{}).empty());
  CHECK(extremes_of(std::vector<double>{nan, nan}).empty());
  CHECK(extremes_of(std::vector<double>{nan, 3, -2, INFINITY, 5, 5}) ==
        std::vector<std::size_t>{2, 4});
}

TEST_CASE("a thinned table keeps ends, extremes and order, and its values their places") {
  constexpr std::size_t peak_tap = 99, peak_place = 1234;
  const TableThinning thinning{.most_taps = 8, .most_places = 50, .per_decade = 8};
  const Table whole = table_of(peak_tap, peak_place);
  const Table thin = thinned(whole, thinning);
  const auto& taps = values_of<std::uint64_t>(thin.axes, "tap");
  const auto& heights = values_of<double>(thin.axes, "height");
  const auto& phi = values_of<double>(thin.quantities, "phi");
  REQUIRE(taps.size() == thinning.most_taps);
  CHECK(taps.front() == 10);
  CHECK(taps.back() == 10 + n_taps - 1);
  CHECK(std::ranges::is_sorted(taps));
  CHECK(std::ranges::is_sorted(heights));
  CHECK(heights.front() == 0.5);
  CHECK(heights.back() == double(n_places) - 0.5);
  CHECK(heights.size() >= thinning.most_places);
  CHECK(heights.size() <= thinning.most_places + 2 * thinning.most_taps);
  CHECK(std::ranges::count(phi, 1e9) == 1);
  REQUIRE(phi.size() == taps.size() * heights.size());
  for (std::size_t i = 0; i < taps.size(); ++i) {
    for (std::size_t j = 0; j < heights.size(); ++j) {
      const auto tap = static_cast<std::size_t>(taps[i] - 10);
      const auto place = static_cast<std::size_t>(heights[j] - 0.5);
      const bool is_peak = tap == peak_tap && place == peak_place;
      REQUIRE(phi[i * heights.size() + j] == (is_peak ? 1e9 : value_at(tap, place)));
    }
  }
  CHECK(values_of<double>(thin.quantities, "phi_error").size() == phi.size());
  CHECK(values_of<std::string>(thin.quantities, "word").back() == "tap number 99");
  CHECK(values_of<double>(thin.quantities, "alone") == std::vector<double>{7});
  CHECK(std::ranges::none_of(thin.quantities,
                             [](const Quantity& quantity) { return quantity.name == "damaged"; }));
  CHECK(thin.notes == whole.notes);
  CHECK(n_values(thin) < n_values(whole) / 50);
}

TEST_CASE("a table that is short stays as it is") {
  const Table whole = table_of(0, 5);
  const Table unchanged = thinned(whole, {.most_taps = n_taps, .most_places = n_places});
  CHECK(values_of<double>(unchanged.quantities, "phi") ==
        values_of<double>(whole.quantities, "phi"));
  CHECK(values_of<std::string>(unchanged.quantities, "word") ==
        values_of<std::string>(whole.quantities, "word"));
}
