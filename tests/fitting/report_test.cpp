#include "fitting/report.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/fitting/noise.hpp"

namespace jostle {
namespace {

/// A law given by a function, with names of its parameters, all of them levels but `t0`.
class WrittenLaw final : public Model {
 public:
  using Function = double (*)(double t, const double* p);
  WrittenLaw(Function function, const std::vector<std::string>& names) : function_(function) {
    for (const std::string& name : names) {
      const bool is_time = name == "t0";
      parameters_.push_back({.name = name,
                             .meaning = "",
                             .unit = is_time ? ParameterUnit::time : ParameterUnit::value,
                             .linear = !is_time});
    }
  }
  std::string name() const override { return "written"; }
  const std::vector<Parameter>& parameters() const override { return parameters_; }
  double value(double t, const double* p) const override { return function_(t, p); }

 private:
  Function function_;
  std::vector<Parameter> parameters_;
};

Curve with_noise(double (*truth)(double t), double noise) {
  Noise normal(7);
  Curve curve;
  for (int k = 0; k < 40; ++k) {
    curve.t.push_back(k);
    curve.x.push_back(truth(k) + noise * normal());
  }
  return curve;
}

const std::string* remark_with(const Fit& fit, const std::string& words) {
  const auto found = std::ranges::find_if(fit.remarks, [&](const std::string& remark) {
    return remark.find(words) != std::string::npos;
  });
  return found == fit.remarks.end() ? nullptr : &*found;
}

}  // namespace

TEST_CASE("R2 has as many digits as distinguish it from 1") {
  Fit fit;
  const auto printed = [&](double r2) {
    fit.r2 = r2;
    const std::string text = describe(fit);
    const auto place = text.find("R2 ") + 3;
    return text.substr(place, text.find('\n', place) - place);
  };
  CHECK(printed(0.98765) == "0.9877");
  CHECK(printed(0.99999) == "0.99999");
  CHECK(printed(0.9999967) == "0.999997");
  CHECK(printed(1 - 3e-9) == "0.999999997");
  CHECK(printed(1) == "1");
  CHECK(printed(1 - 1e-15) == "1");
  CHECK(printed(1e-9) == "0");
  CHECK(printed(-3.25) == "-3.25");
}

TEST_CASE("Parameters that compensate each other are named apart from those lost in noise") {
  const WrittenLaw law(
      [](double t, const double* p) {
        const double u = t / 40;
        return p[0] + p[1] * u + p[2] * (u + 1e-3 * u * u) + p[3] * std::sin(2.2 * t);
      },
      {"a", "b", "c", "d"});
  const Fit found = std::get<Fit>(fit(law, with_noise([](double) { return 1.0; }, 0.1)));
  REQUIRE(found.estimates[3].identifiability == Identifiability::wide);
  CHECK(remark_with(found, "The parameters are not unique: b and c can make up for each other"));
  const std::string* noisy = remark_with(found, "The data hardly constrain ");
  REQUIRE(noisy);
  CHECK(noisy->find(" d:") != std::string::npos);
}

TEST_CASE("A parameter that moves the curve in steps has no errors, with the reason") {
  const WrittenLaw law([](double t, const double* p) { return t < p[1] ? p[0] : p[2]; },
                       {"a", "t0", "b"});
  const Curve curve = with_noise([](double t) { return t < 20 ? 1.0 : 2.0; }, 0.05);
  const Fit found =
      std::get<Fit>(fit(law, curve, {.start = ParameterValues{1, 19.5, 2}, .multi_start = false}));
  CHECK(remark_with(found,
                    "The curve does not change with small changes of t0: errors and "
                    "limits of t0 cannot be computed."));
  CHECK_FALSE(remark_with(found, "not unique"));
  CHECK(found.estimates[0].identifiability == Identifiability::identified);
  CHECK(found.estimates[2].identifiability == Identifiability::identified);
}

TEST_CASE("A law that meets every point is not examined, with the reason") {
  const WrittenLaw law([](double t, const double* p) { return p[0] * t; }, {"r"});
  const Fit found = std::get<Fit>(fit(law, with_noise([](double t) { return 2 * t; }, 0),
                                      {.start = ParameterValues{2}, .multi_start = false}));
  REQUIRE(found.residual_sum == 0);
  REQUIRE(found.estimates[0].identifiability == Identifiability::not_examined);
  CHECK(remark_with(found, "The law meets every point exactly"));
}

}  // namespace jostle
