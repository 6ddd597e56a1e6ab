#include "study/tables/measured/curve_file.hpp"

#include <catch2/catch.hpp>
#include <fstream>

#include "study/bad_input.hpp"
#include "tests/results/temporary_folder.hpp"

namespace jostle {
namespace {

const std::vector<double> x_of_three = {0.5, 0.6, 0.7};

std::string written(const TemporaryFolder& folder, const std::string& text) {
  const std::string path = folder / "curve.csv";
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

MeasuredCurve curve_of(const std::string& text, const CurveReading& reading = {}) {
  const TemporaryFolder folder;
  return read_curve(written(folder, text), reading);
}

/// A message for the reader; empty where the text is read.
std::string fault_of(const std::string& text, const CurveReading& reading = {}) {
  const TemporaryFolder folder;
  const std::string path = written(folder, text);
  try {
    read_curve(path, reading);
    return "";
  } catch (const BadInput& fault) {
    return std::string(fault.what()).substr(path.size() + 2);
  }
}

constexpr CurveReading several = {.columns = CurveColumns::realizations};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("columns go by their names, in any order") {
  for (const char* text :
       {"t,X,sigma\n1,0.5,0.01\n2,0.6,0.02\n3,0.7,0.03\n",
        "t,sigma,X\n1,0.01,0.5\n2,0.02,0.6\n3,0.03,0.7\n",
        "X,sigma,t\n0.5,0.01,1\n0.6,0.02,2\n0.7,0.03,3\n",
        ",t,X,sigma\n0,1,0.5,0.01\n1,2,0.6,0.02\n2,3,0.7,0.03\n",
        "Unnamed: 0,t,X,sigma\n0,1,0.5,0.01\n1,2,0.6,0.02\n2,3,0.7,0.03\n",
        "index,tap,mean,se\n0,1,0.5,0.01\n1,2,0.6,0.02\n2,3,0.7,0.03\n",
        "Time [s];standard_error;Value\n1;0.01;0.5\n2;0.02;0.6\n3;0.03;0.7\n",
        "\"t\",\"error\",\"X\"\n\"1\",\"0.01\",\"0.5\"\n2,0.02,0.6\n3,0.03,0.7\n",
        "t\tX\tsigma\n1\t0.5\t0.01\n2\t0.6\t0.02\n3\t0.7\t0.03\n",
        "taps   mean sigma\n 1 0.5  0.01\n2 0.6 0.02\n3 0.7 0.03\n",
        "# t sigma X\n1 0.01 0.5\n2 0.02 0.6\n3 0.03 0.7\n",
        "t,X,sigma,inverse_log,kww,own\n1,0.5,0.01,9,9,9\n2,0.6,0.02,9,9,9\n3,0.7,0.03,9,9,9\n",
        "1,0.5,0.01\n2,0.6,0.02\n3,0.7,0.03\n"}) {
    CAPTURE(text);
    const Curve curve = curve_of(text).curve;
    CHECK(curve.t == std::vector<double>{1, 2, 3});
    CHECK(curve.x == x_of_three);
    CHECK(curve.sigma == std::vector<double>{0.01, 0.02, 0.03});
  }
}

TEST_CASE("realizations are all other columns, whatever their names") {
  for (const char* text :
       {"t,r0,r1\n1,2,4\n2,3,5\n", ",t,a,b\n0,1,2,4\n1,2,3,5\n", "a,t,b\n2,1,4\n3,2,5\n",
        "t,1,2\n1,2,4\n2,3,5\n", "t,X,X\n1,2,4\n2,3,5\n", "1,2,4\n2,3,5\n"}) {
    CAPTURE(text);
    const Curve curve = curve_of(text, several).curve;
    CHECK(curve.t == std::vector<double>{1, 2});
    CHECK(curve.x == std::vector<double>{3, 4});
    CHECK(curve.n_realizations == 2);
  }
}

TEST_CASE("units are read in brackets behind the names of t and X") {
  const auto units = [](const char* text, const CurveReading& reading) {
    const CurveUnits found = curve_of(text, reading).units;
    return found.t + ";" + found.x;
  };
  CHECK(units("Time [s],X (mm)\n1,2\n2,3\n", {}) == "s;mm");
  CHECK(units("t,X\n1,2\n2,3\n", {}) == ";");
  CHECK(units("1,2\n2,3\n", {}) == ";");
  CHECK(units("t [min],a [mm],b [mm]\n1,2,4\n2,3,5\n", several) == "min;mm");
  CHECK(units("t,run (1),run (2)\n1,2,4\n2,3,5\n", several) == ";");
  CHECK(units("t (as read off the figure),X\n1,2\n2,3\n", {}) == ";");
}

TEST_CASE("errors, counts, weights and means are no realizations") {
  for (const char* name :
       {"std", "sem", "count", "sd", "stderr", "n", "weight", "average", "std.dev", "SIGMA_X",
        "r0_error", "StdErr", "meanPhi", "sigma1", "Standard error [mm]", "value", "median"}) {
    CAPTURE(name);
    const std::string fault =
        fault_of(std::string("t,a,b,") + name + "\n1,2,3,4\n2,3,4,5\n", several);
    CHECK(contains(fault, std::string(name) + " names an error, a count, a weight or a mean"));
  }
  CHECK(contains(fault_of("t,X,mean\n1,2,3\n", several), "mean names an error"));
  CHECK(contains(fault_of("t,X,mean,value\n1,2,3,4\n", several), "names an error"));
  for (const char* name : {"n1", "sediment", "counter", "run_7", "east", "weighted"}) {
    CAPTURE(name);
    CHECK(fault_of(std::string("t,a,b,") + name + "\n1,2,3,4\n2,3,4,6\n", several).empty());
  }
}

TEST_CASE("numbered columns of one mean are realizations") {
  CHECK(fault_of("t,mean_height_9,mean_height_10\n1,2,4\n2,3,5\n", several).empty());
  CHECK(
      contains(fault_of("t,mean_height_0,mean_phi_1\n1,2,4\n2,3,5\n", several), "names an error"));
  CHECK(contains(fault_of("t,std_0,std_1\n1,2,4\n2,3,5\n", several), "names an error"));
  CHECK(contains(fault_of("t,mean_a,mean\n1,2,4\n2,3,5\n", several), "names an error"));
}

TEST_CASE("columns of different units are not averaged, nor is an error of another unit used") {
  CHECK(contains(fault_of("t,a [mm],b [cm],c [mm]\n1,2,4,5\n2,3,5,7\n", several),
                 "the realizations have several units (cm, mm)"));
  CHECK(contains(fault_of("t,a [mm],b,c [mm]\n1,2,4,5\n2,3,5,7\n", several),
                 "several units (mm, none)"));
  CHECK(fault_of("t,run (a),run (b)\n1,2,4\n2,3,5\n", several).empty());
  for (const char* text :
       {"t,X [mm],sigma [cm]\n1,2,3\n", "t,X [mm],sigma [%]\n1,2,3\n", "t,X,sigma [mm]\n1,2,3\n"}) {
    CAPTURE(text);
    CHECK(contains(fault_of(text), "an error has the unit of its value"));
  }
  CHECK(fault_of("t,X [mm],sigma\n1,2,3\n").empty());
  CHECK(fault_of("t,X [mm],sigma (mm)\n1,2,3\n").empty());
  CHECK(fault_of("t,X [1],sigma [-]\n1,2,3\n").empty());
}

TEST_CASE("realizations that are copies count once") {
  const MeasuredCurve partly = curve_of("t,a,b,c,d\n1,2,4,2,3\n2,3,5,3,5\n3,4,5,4,6\n", several);
  CHECK(partly.curve.n_realizations == 3);
  CHECK(partly.curve.x == std::vector<double>{3, 13.0 / 3, 5});
  REQUIRE(partly.notes.size() == 1);
  CHECK(partly.notes[0] ==
        "1 of the 4 realizations repeats the series of another, so 3 realizations are used.");
  const MeasuredCurve repeated = curve_of("t,a,b,c\n1,2,2,2\n2,3,3,3\n3,5,5,5\n", several);
  CHECK(repeated.curve.n_realizations == 0);
  CHECK(repeated.curve.x == std::vector<double>{2, 3, 5});
  CHECK(repeated.notes.at(0) ==
        "2 of the 3 realizations repeat the series of another, so 1 realization is used.");
  // Rows that a copy alone shares with its original have one value.
  const MeasuredCurve ends =
      curve_of("t,a,b,c\n1,2,2,5\n2,3,3,4\n3,5,5,7\n4,6,6,\n5,7,7,\n", several);
  CHECK(ends.curve.n_realizations == 2);
  CHECK(ends.curve.t == std::vector<double>{1, 2, 3});
  CHECK(ends.curve.x == std::vector<double>{3.5, 3.5, 6});
  REQUIRE(ends.notes.size() == 2);
  CHECK(contains(ends.notes[1], "2 rows with a value of one realization alone"));
  // Constant columns may agree by chance.
  CHECK(curve_of("t,a,b,c\n1,2,2,1\n2,2,2,3\n", several).curve.n_realizations == 3);
}

TEST_CASE("headings that are unknown or ambiguous are refused with what was found") {
  for (const char* text :
       {"t,phi\n1,2\n2,3\n", "a,b\n1,2\n", "t,X,std\n1,2,3\n", "t,X,value\n1,2,3\n",
        "t,tap,X\n1,2,3\n", "t,X,sigma,error\n1,2,3,4\n", "X,sigma\n1,2\n", "t,sigma\n1,2\n",
        ",X\n1,2\n", "t,,X\n1,2,3\n", "# t, phi\nX, sigma\n1,2\n", "t,r0,r1\n1,2,3\n",
        "height,count\n1,2\n"}) {
    CAPTURE(text);
    const std::string fault = fault_of(text);
    CHECK(contains(fault, "Columns found: "));
    CHECK(contains(fault, "Allowed names: t, tap, taps or time"));
  }
  for (const char* text : {"t,X,r1,r2\n1,2,3,4\n", "t,mean,sigma\n1,2,3\n", "t,a,a\n1,2,3\n",
                           "t,a\n1,2\n", "a,b,c\n1,2,3\n", "t,a,b,sigma\n1,2,3,4\n"}) {
    CAPTURE(text);
    CHECK(contains(fault_of(text, several), "Columns found: "));
  }
}

TEST_CASE("any line end and a byte-order mark change nothing") {
  for (const char* end : {"\n", "\r\n", "\r"}) {
    for (const char* mark : {"", "\xEF\xBB\xBF"}) {
      std::string text = mark;
      for (const char* line : {"t,X", "# note", "1,0.5", "", "2,0.6", "3,0.7"}) {
        text += std::string(line) + end;
      }
      CAPTURE(text);
      CHECK(curve_of(text).curve.x == x_of_three);
    }
  }
  CHECK(curve_of("t,X\r1,0.5\n2,0.6\r\n3,0.7").curve.x == x_of_three);
  CHECK(contains(fault_of("t,X\r1,0.5\r2,?\r"), "line 3, column 2 (X)"));
  CHECK(contains(fault_of(std::string("\xFF\xFEt\0,\0", 6)), "UTF-16"));
}

TEST_CASE("faults name line, column and name") {
  for (const char* number : {"0x1", "inf", "-inf", "1e", "+0.6", "1_000", "0.6x", "two", "1e999"}) {
    CAPTURE(number);
    const std::string fault = fault_of(std::string("X,t\n0.5,1\n") + number + ",2\n");
    CHECK(contains(fault, "line 3, column 1 (X): \"" + std::string(number) + "\" is not a number"));
  }
  CHECK(contains(fault_of("t;X\n1;0,5\n"), "Write decimal points, not commas"));
  CHECK(contains(fault_of("t\tX\n1\t0,5\n"), "Write decimal points, not commas"));
  CHECK(contains(fault_of("t,X\n1,0,5\n"), "line 2 has 3 fields, the heading 2 columns (t, X)"));
  CHECK(contains(fault_of("t,X\n1,0,5\n"), "If its commas are decimal, write points"));
  CHECK(contains(fault_of("t,X\n1,\"0,5\"\n"), "Write decimal points, not commas"));
  CHECK(contains(fault_of("t,X\n1\n"), "line 2 has 1 field"));
  CHECK(contains(fault_of("t,X\n,0.5\n"), "line 2, column 1 (t): t has no value"));
  CHECK(contains(fault_of("t,X,sigma\n1,0.5,\n"), "column 3 (sigma): X has a value and sigma"));
  CHECK(contains(fault_of("t,X,sigma\n1,0.5,0\n"), "column 3 (sigma): sigma is 0"));
  CHECK(contains(fault_of("t,r0,r1\n1,2,3\n2,3,?\n", several), "line 3, column 3 (r1)"));
  CHECK(contains(fault_of("t,X\n\"1,0.5\n"), "line 2 has a quote that is not closed"));
  CHECK(contains(fault_of("t,X\n"), "no row has a t in the range and a value"));
  CHECK(contains(fault_of(""), "no rows of numbers"));
  CHECK(contains(fault_of("1,2,3,4\n"), "line 1 has 4 columns and no heading"));
}

TEST_CASE("a row without X is left out, and reported") {
  for (const char* gap : {"", "NaN", "nan", "NA", "null"}) {
    const MeasuredCurve measured =
        curve_of("t,X\n1,0.5\n2,0.6\n2.5," + std::string(gap) + "\n3,0.7\n,\n");
    CHECK(measured.curve.x == x_of_three);
    REQUIRE(measured.notes.size() == 1);
    CHECK(measured.notes[0] == "1 row without a value: left out.");
  }
}

TEST_CASE("gaps of realizations: the others are used, or the row is dropped") {
  const std::string text = "t,a,b,c\n1,1,2,3\n2,2,,4\n3,3,4,5\n4,,,6\n5,NaN,6,7\n";
  const MeasuredCurve curve = curve_of(text, several);
  CHECK(curve.curve.t == std::vector<double>{1, 2, 3, 5});
  for (std::size_t i = 0; i < 4; ++i) {  // X = t + offset, of which the mean is 1
    CHECK(curve.curve.x[i] == Approx(curve.curve.t[i] + 1));
  }
  CHECK(curve.curve.n_realizations == 3);
  CHECK(curve.notes.size() == 2);  // a row of one value; two values missing
  const MeasuredCurve dropped =
      curve_of(text, {.columns = CurveColumns::realizations, .gaps = Gaps::drop_row});
  CHECK(dropped.curve.t == std::vector<double>{1, 3});
  CHECK(dropped.curve.present.empty());
  CHECK(curve_of(text, {.columns = CurveColumns::realizations, .last = 3}).curve.t.back() == 3);
  CHECK(contains(fault_of("t,a,b,c,d\n1,1,2,,\n2,1,2,,\n3,,,1,2\n", several),
                 "the realizations a, b have no row in common with c, d"));
  CHECK(contains(fault_of("t,a,b\n1,1,\n2,,2\n", several), "0 of 2 realizations have values in"));
  CHECK(curve_of("t,a,b,c\n1,1,2,\n2,2,3,\n", several).curve.n_realizations == 2);
}

}  // namespace jostle
