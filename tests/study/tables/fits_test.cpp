#include "study/tables/fits.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "config/scene.hpp"
#include "study/tables/points/derived_value.hpp"
#include "tests/fitting/noise.hpp"

using namespace jostle;

TEST_CASE("Every law that scenes may name is one that can be fitted") {
  for (const std::string& law : relaxation_laws()) {
    CAPTURE(law);
    CHECK(models_named(law).size() == 1);
  }
  CHECK(models_named("no_such_law").empty());
}

TEST_CASE("All laws compete, and no two of them draw the same curves") {
  const auto all = models_named("all");
  const std::vector<std::string> names = competing_laws();
  REQUIRE(all.size() == names.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    REQUIRE(all[i] != nullptr);
    CHECK(all[i]->name() == names[i]);
    const auto equivalent = all[i]->equivalent();
    if (equivalent) CHECK(std::ranges::find(names, equivalent->law->name()) == names.end());
  }
}

TEST_CASE("A kept fit gives the parameters of eqs. 3 and 4, whichever was fitted") {
  Noise noise(7);
  std::vector<double> t, values;
  for (int tap = 1; tap <= 300; ++tap) {
    t.push_back(tap);
    for (int r = 0; r < 4; ++r)
      values.push_back(14.0 + 0.7 / (1 + std::log1p(tap / 4.0)) + 0.01 * noise());
  }
  const Curve curve = mean_curve(std::move(t), std::move(values), 4);
  MadeTables eq_3, eq_4;
  for (auto& [tables, law] : {std::pair{&eq_3, "inverse_log"}, {&eq_4, "inverse_log_height"}}) {
    const FittedCurve fitted{
        {.title = "", .observable = "z", .label = "", .point = 0, .curve = curve},
        fit_models(models_named(law), curve, {})};
    tables->fits = fit_tables(fitted, {});
    REQUIRE(tables->fits.size() == 1);
  }
  for (const char* name : {"inverse_log/X_inf", "inverse_log/dX", "inverse_log/B",
                           "inverse_log/tau", "inverse_log_height/Z_inf", "inverse_log_height/Z_0",
                           "inverse_log_height/B", "inverse_log_height/tau"}) {
    CAPTURE(name);
    const DerivedValue a = derived_value(eq_3, 0, "z", name), b = derived_value(eq_4, 0, "z", name);
    CHECK(a.value == Approx(b.value).epsilon(1e-6));
    CHECK(a.error.error == Approx(b.error.error).epsilon(1e-4));
    CHECK(a.no_value == b.no_value);
  }
}
