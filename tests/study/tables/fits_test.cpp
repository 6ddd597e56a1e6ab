#include "study/tables/fits.hpp"

#include <catch2/catch.hpp>

#include "config/scene.hpp"

using namespace jostle;

TEST_CASE("Every law that scenes may name is one that can be fitted") {
  const auto all = models_named("all");
  const std::vector<std::string> laws = relaxation_laws();
  REQUIRE(all.size() == laws.size());
  for (std::size_t i = 0; i < laws.size(); ++i) {
    CAPTURE(laws[i]);
    REQUIRE(all[i] != nullptr);
    CHECK(models_named(laws[i]).size() == 1);
  }
  CHECK(models_named("no_such_law").empty());
}
