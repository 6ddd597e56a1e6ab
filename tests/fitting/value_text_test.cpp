#include "fitting/value_text.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace jostle {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
const double nan = std::nan("");

/// The value and the error in a text, read as a person reads it.
std::pair<double, double> read_back(const std::string& text) {
  const auto open = text.find('('), close = text.find(')');
  const std::string mantissa = text.substr(0, open);
  const std::string digits = text.substr(open + 1, close - open - 1);
  const double power = close + 1 < text.size() ? std::stod("1" + text.substr(close + 1)) : 1;
  const auto point = mantissa.find('.');
  const auto decimals = point == std::string::npos ? 0 : mantissa.size() - point - 1;
  const bool has_point = digits.find('.') != std::string::npos;
  const double unit = has_point ? 1 : std::pow(10.0, -static_cast<double>(decimals));
  return {std::stod(mantissa) * power, std::stod(digits) * unit * power};
}

}  // namespace

TEST_CASE("an error refers to the last digits of its value") {
  CHECK(value_with_error(0.59131, 0.0012) == "0.5913(12)");
  CHECK(value_with_error(12.345678, 0.21) == "12.35(21)");
  CHECK(value_with_error(1239.6, 85.2) == "1240(85)");
  CHECK(value_with_error(12.34, 4.51) == "12.3(4.5)");
  CHECK(value_with_error(12345, 1234) == "12300(1200)");
  CHECK(value_with_error(0.5, 0.00996) == "0.500(10)");  // to its second digit as printed
  CHECK(value_with_error(2.0487283e-06, 7.4e-07) == "2.05(74)e-06");
  CHECK(value_with_error(0.593890243, 2.8e-7) == "0.59389024(28)");
  CHECK(value_with_error(0.23, 2.7e-11) == "0.230000000000(27)");
  CHECK(value_with_error(1.25e9, 3e6) == "1.2500(30)e+09");
}

TEST_CASE("a lopsided interval is given by both of its distances") {
  CHECK(value_with_limits(56.04, 45.4, 74.1) == "56(+18/-11)");
  CHECK(value_with_limits(0.5913, 0.5911, 0.5999) == "0.59130(+0.00860/-0.00020)");
  CHECK(value_with_limits(-3, -3.5, 1) == "-3.00(+4.00/-0.50)");
  CHECK(value_with_limits(2e-9, 1e-9, 1e-8) == "2.0(+8.0/-1.0)e-09");
  CHECK(value_with_limits(3e8, 2e8, 9e8) == "3.0(+6.0/-1.0)e+08");
  CHECK(value_with_limits(0.65432294, 0.65431942, 0.65446464) ==
        "0.6543229(+0.0001417/-0.0000035)");
  CHECK(value_with_limits(3.271615e-4, 3.271597e-4, 3.272323e-4) ==
        "3.271615(+0.000708/-0.000018)e-04");
}

// A tenth of the shorter error is the most that a printed value may be off.
TEST_CASE("a value with two limits is printed to its shorter one") {
  for (int power = -200; power <= 200; power += 5) {
    for (const double share : {1e-8, 3e-5, 0.01, 0.7}) {
      const double value = 6.5432294 * std::pow(10.0, power), lower = share * value;
      const std::string text = value_with_limits(value, value - lower, value + 40 * lower);
      const std::size_t power_at = text.find(")e");
      const double unit =
          power_at == std::string::npos ? 1 : std::stod("1" + text.substr(power_at + 1));
      CAPTURE(value, lower, text);
      CHECK(std::abs(std::stod(text) * unit - value) <= 0.1 * lower);
      CHECK(std::stod(text.substr(text.find("/-") + 2)) * unit == Approx(lower).epsilon(0.051));
      CHECK(std::stod(text.substr(text.find("(+") + 2)) * unit ==
            Approx(40 * lower).epsilon(0.051));
    }
  }
}

TEST_CASE("an interval is lopsided where half of it would reach beyond limits or zero") {
  CHECK(is_lopsided(56, 45, 74, 43, 3588));
  CHECK_FALSE(is_lopsided(56, 45, 70, 40, 90));
  // A time of 0.1 to 6.4 is positive, also without a lower limit at 95 %.
  CHECK(is_lopsided(2.2, 0.1, 6.4, nan, 13));
  CHECK(is_lopsided(2.2, 0, 6.4, -infinity, infinity));
  CHECK(is_lopsided(-2.2, -6.4, -0.1, -infinity, infinity));
  CHECK_FALSE(is_lopsided(2.2, -0.1, 6.4, -infinity, infinity));
  CHECK_FALSE(is_lopsided(2.2, 2.2, 2.2, -infinity, infinity));  // fixed
}

TEST_CASE("an error may be larger than its value, which may be negative") {
  CHECK(value_with_error(0.3, 1.2) == "0.3(1.2)");
  CHECK(value_with_error(-0.31, 0.12) == "-0.31(12)");
  CHECK(value_with_error(-0.001, 0.12) == "0.00(12)");
  CHECK(value_with_error(4, 123) == "0(120)");
  CHECK(value_with_error(3.1e-9, 4.2e-7) == "0.0(4.2)e-07");
  CHECK(value_with_error(-0.0000123, 0.000045) == "-0.000012(45)");
}

TEST_CASE("a value without an error is alone, and a missing limit is named") {
  CHECK(value_with_error(0.123456789, nan) == "0.123457");
  CHECK(value_with_error(0.123456789, 0) == "0.123457");
  CHECK(value_with_error(0.123456789, -1) == "0.123457");
  CHECK(value_with_error(0.123456789, infinity) == "no limit");
  CHECK(value_with_error(nan, 0.1) == "-");
  CHECK(value_with_error(infinity, 1) == "infinite");
  CHECK(value_with_error(-infinity, 1) == "-infinite");
  CHECK(number_text(infinity, 3) == "infinite");
  CHECK(number_text(nan, 3) == "-");
}

TEST_CASE("rounding noise is 0 beside the scale of what is measured") {
  CHECK(value_with_error(-8.3e-17, 1.7e-16, 1) == "0");
  CHECK(value_with_error(3e-15, 2e-15, 100) == "0");
  CHECK(value_with_error(3e-15, 2e-12) == "0.0(2.0)e-12");
  CHECK(value_with_error(2.5e-16, 1e-17, 1e-10) == "2.50(10)e-16");
  // Differences of equal numbers have errors of rounding alone.
  CHECK(value_with_error(-0.05000000000000012, 1.3e-17) == "-0.05");
  CHECK(value_with_error(0.6 - 0.65, 3e-15) == "-0.05");
  CHECK(value_with_error(12345.678901234567, 1e-12) == "12345.7");
  CHECK(value_with_error(0.600857966880045, 2.2e-14) == "0.600858");
  CHECK(value_with_error(0.600857966880045, 2.2e-11) == "0.600857966880(22)");
  CHECK(value_with_error(1e-9 / 3, 1e-27, 1e-9) == "3.33333e-10");
}

TEST_CASE("small numbers keep their errors, for every number is relative to itself") {
  CHECK(value_with_error(6.14693e-13, 2.3e-15) == "6.147(23)e-13");
  CHECK(value_with_error(6.1592e-16, 3.4e-18) == "6.159(34)e-16");
  CHECK(value_with_error(1.29414e-12, 3.1e-14) == "1.294(31)e-12");
  CHECK(value_with_error(7e-20, 0) == "7e-20");
  CHECK(value_with_error(-3e-200, 1.5e-200) == "-3.0(1.5)e-200");
}

TEST_CASE("a p-value is never printed as 0") {
  CHECK(p_value_text(0.0193) == "p = 0.019");
  CHECK(p_value_text(4.7e-14) == "p = 4.7e-14");
  CHECK(p_value_text(9.6e-80) == "p < 1e-16");
  CHECK(p_value_text(0) == "p < 1e-16");
  CHECK(p_value_text(1) == "p = 1");
  CHECK(p_value_text(0.0495) == "p = 0.0495");
  CHECK(p_value_text(0.05003) == "p = 0.05003");
  CHECK(p_value_text(0.05) == "p = 0.05");
  CHECK(p_value_text(0.0512) == "p = 0.051");
  CHECK(probability_text(0) == "< 1e-16");
  CHECK(probability_text(nan) == "-");
}

TEST_CASE("over all decades and signs a text has the value and its error to two digits") {
  for (int power = -280; power <= 280; power += 7) {
    for (const double ratio : {1e-9, 3.3e-4, 0.0996, 0.5, 0.995, 1.0, 7.7, 99.6, 1e4}) {
      for (const double mantissa : {1.0, -1.04999, 3.14159, -9.96, 9.99999}) {
        const double value = mantissa * std::pow(10.0, power), error = std::abs(value) * ratio;
        const std::string text = value_with_error(value, error);
        CAPTURE(value, error, text);
        REQUIRE(text.find('(') != std::string::npos);
        const auto [read, read_error] = read_back(text);
        CHECK(std::abs(read_error / error - 1) < 0.051);  // half of the second digit
        CHECK(std::abs(read - value) < 0.0501 * error + 1e-14 * std::abs(value));
        CHECK(text.size() <= 25);
      }
    }
  }
}

TEST_CASE("limits are written in words") {
  CHECK(limits_text(0.57431, 0.61, 5) == "0.57431 to 0.61");
  CHECK(limits_text(0.6093812, 0.6093843, 5) == "0.6093812 to 0.6093843");
  CHECK(limits_text(7.99969, 8.00086, 4) == "7.99969 to 8.00086");
  CHECK(limits_text(-8.00086, -7.99969, 4) == "-8.00086 to -7.99969");
  CHECK(limits_text(-0.0001, 12345.6, 5) == "-0.0001 to 12346");
  CHECK(limits_text(0.58, 0.58, 5) == "0.58 to 0.58");
  CHECK(limits_text(1, 1 + 3e-16, 5) == "1 to 1.0000000000000002");
  CHECK(limits_text(0.57431, infinity, 5) == "> 0.57431");
  CHECK(limits_text(-infinity, 0.61, 5) == "< 0.61");
  CHECK(limits_text(-infinity, infinity, 5) == "no limit");
  CHECK(limits_text(nan, nan, 5) == "no limit");
}

}  // namespace jostle
