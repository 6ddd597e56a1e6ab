#include "cli/tables/table_output.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "cli/tables/table_text.hpp"

using namespace jostle;

namespace {

constexpr double error_is_known = std::numeric_limits<double>::infinity();
constexpr Layout all_columns{.width = 80, .columns = Columns::all};

Table example() {
  const std::vector<std::string> axes = {"age", "lag"};
  return {
      .name = "point_0000/ageing",
      .axes = {{"age", {"age"}, std::vector<std::uint64_t>{1, 10}, "taps", "waiting time", ""},
               {"lag", {"lag"}, std::vector<std::uint64_t>{2, 4, 8}, "taps", "lag", ""}},
      .quantities = {{"tau", {}, std::vector{12.345678}, "taps", "memory", "eq. 6"},
                     {"tau_error", {}, std::vector{0.21}, "taps", "", ""},
                     {"a", axes, std::vector{1.0, 2.0, 3.0, 4.0, 5.0, std::nan("")}, "1", "", ""},
                     {"kind", {"age"}, std::vector<std::string>{"x", "y, z"}, "", "", ""}},
      .notes = {{"verdict", "it ages"}}};
}

}  // namespace

TEST_CASE("A table for people has values with their errors, then columns") {
  Table table = example();
  table.quantities.push_back({"tau_dof", {}, std::vector{error_is_known}, "1", "", ""});
  const std::string text = table_text(table, all_columns);
  CHECK(text.find("  verdict                it ages\n") != std::string::npos);
  CHECK(text.find("  tau                    12.35(21) taps   (memory)\n") != std::string::npos);
  CHECK(text.find("tau_error") == std::string::npos);
  CHECK(text.find("age  lag  a\n  1    2  1\n") != std::string::npos);
  CHECK(text.find(" 10    8  -\n") != std::string::npos);
  CHECK(text.find("  in taps                age, lag\n") != std::string::npos);
}

TEST_CASE("A standard error without degrees of freedom is a row of its own") {
  const std::string text = table_text(example(), all_columns);
  CHECK(text.find("  tau                    12.35 taps   (memory)\n") != std::string::npos);
  CHECK(text.find("  tau_error              0.21 taps\n") != std::string::npos);
  CHECK(text.find("tau_error: standard errors") != std::string::npos);
}

TEST_CASE("A table for people has values with their 95 % intervals") {
  Table table = example();
  for (const auto& [ending, value] : {std::pair{"_low_68", 12.1}, std::pair{"_high_68", 12.6},
                                      std::pair{"_low_95", 11.8}, std::pair{"_high_95", 12.9}}) {
    table.quantities.push_back(
        {std::string("tau").append(ending), {}, std::vector{value}, "taps", "", ""});
  }
  const std::string text = table_text(table, all_columns);
  CHECK(text.find("  tau                    12.35 (11.8 to 12.9) taps   (memory)\n") !=
        std::string::npos);
  CHECK(text.find("tau_") == std::string::npos);
  std::get<std::vector<double>>(table.quantities.back().values)[0] = std::nan("");
  CHECK(table_text(table, all_columns).find("12.35 (> 11.8) taps") != std::string::npos);
}

TEST_CASE("A brief table leaves long columns out") {
  Table table = example();
  table.axes[1].values = std::vector<std::uint64_t>(20, 1);
  table.quantities[2].values = std::vector<double>(40, 0.5);
  const std::string text = table_text(table, {});
  CHECK(text.find("12.35") != std::string::npos);
  CHECK(text.find("y, z") != std::string::npos);
  CHECK(text.find("0.5") == std::string::npos);
  CHECK(text.find("  40 rows of age, lag    in --wide, --csv FILE and --json: a\n") !=
        std::string::npos);
}

TEST_CASE("A table without rows has a note") {
  Table table = example();
  table.axes[1].values = std::vector<std::uint64_t>();
  table.quantities[2].values = std::vector<double>();
  for (const Columns columns : {Columns::few, Columns::all}) {
    CHECK(table_text(table, {.columns = columns}).find("  0 rows of age, lag     none: a\n") !=
          std::string::npos);
  }
}

TEST_CASE("Results come first") {
  Table table = example();
  table.notes = {{"law", "a logarithm"}, {"verdict", "it ages"}};
  CHECK(table_text(table, {}).starts_with(
      "point_0000/ageing\n  verdict                it ages\n  law "));
}

TEST_CASE("Sentences precede the numbers, once for all rows with equal text") {
  Table table = example();
  const std::string said = "the data set no limit on either side of it";
  table.quantities.push_back(
      {"tau_verdict", {"age"}, std::vector<std::string>{said, said}, "", "", ""});
  CHECK(table_text(table, {}).find("  tau_verdict by age\n    1, 10: " + said +
                                   "\n\nage  kind\n") != std::string::npos);
}

TEST_CASE("Few columns are those that have room, and the others are named") {
  Table table = example();
  table.quantities.clear();
  const std::vector<double> ten(22, 10.0);
  table.axes = {{"n", {"n"}, std::vector<std::uint64_t>(22, 1), "", "", ""}};
  for (const char* name : {"a_long_name_of_a_column", "another_long_name", "the_last_of_them"})
    table.quantities.push_back({name, {"n"}, ten, "1", "", ""});
  const std::string few = table_text(table, {.width = 50}), all = table_text(table, all_columns);
  CAPTURE(few, all);
  CHECK(few.find("\nn  a_long_name_of_a_column  another_long_name\n") != std::string::npos);
  CHECK(few.find("  --wide shows also      the_last_of_them\n") != std::string::npos);
  CHECK(all.find("another_long_name  the_last_of_them\n") != std::string::npos);
  CHECK(all.find("--wide") == std::string::npos);
}

TEST_CASE("A narrow table has no empty column, and no test beside its verdict") {
  Table table = example();
  const double none = std::nan("");
  table.notes = {{"ageing_verdict", "it ages (p = 0.02)"}};
  table.quantities = {{"b", {"age"}, std::vector{none, none}, "1", "", ""},
                      {"misfit", {"age"}, std::vector{0.1, none}, "1", "", ""},
                      {"mu", {}, std::vector{none}, "1", "", ""},
                      {"ageing_factor", {}, std::vector{0.5}, "1", "", ""},
                      {"ageing_p", {}, std::vector{0.02}, "1", "", ""},
                      {"ageing_detectable", {}, std::vector{1.5}, "1", "", ""}};
  const std::string few = table_text(table, {}), all = table_text(table, all_columns);
  CAPTURE(few, all);
  CHECK(few.find("age  misfit\n") != std::string::npos);
  CHECK(few.find("  without a value        b\n") != std::string::npos);
  CHECK(few.find("  without a value        mu\n") != std::string::npos);
  CHECK(few.find("  ageing_factor          0.5\n") != std::string::npos);
  CHECK(few.find("  --wide shows also      ageing_p, ageing_detectable\n") != std::string::npos);
  CHECK(all.find("age  b  misfit\n") != std::string::npos);
  CHECK(all.find("  mu                     -\n") != std::string::npos);
  CHECK(all.find("  ageing_p               0.02\n") != std::string::npos);

  table.notes.clear();
  CHECK(table_text(table, {}).find("  ageing_p               0.02\n") != std::string::npos);
}

TEST_CASE("A value with one limit has this limit beside it") {
  const double none = std::nan("");
  Table table = example();
  table.notes.clear();
  table.quantities.clear();
  const auto add = [&](const std::string& name, double value, double low, double high) {
    table.quantities.push_back({name, {}, std::vector{value}, "1", "", ""});
    table.quantities.push_back({name + "_low_95", {}, std::vector{low}, "1", "", ""});
    table.quantities.push_back({name + "_high_95", {}, std::vector{high}, "1", "", ""});
  };
  add("v_mu", 0.5, none, 1.25);
  add("mu", 0.5, 0.25, none);
  add("open", 0.5, none, none);
  const std::string text = table_text(table, {});
  CAPTURE(text);
  CHECK(text.find("  v_mu                   0.5 (< 1.25)\n") != std::string::npos);
  CHECK(text.find("  mu                     0.5 (> 0.25)\n") != std::string::npos);
  CHECK(text.find("  open                   0.5\n") != std::string::npos);
}

TEST_CASE("Rounding noise is seen beside the column it is in") {
  Table table = {.name = "t",
                 .axes = {{"n", {"n"}, std::vector<std::uint64_t>{1, 2}, "", "", ""}},
                 .quantities = {{"x", {"n"}, std::vector{5000.0, 1e-12}, "1", "", ""},
                                {"x_error", {"n"}, std::vector{2.5, 1e-12}, "1", "", ""},
                                {"x_dof", {}, std::vector{error_is_known}, "1", "", ""}},
                 .notes = {}};
  const std::string text = table_text(table, all_columns);
  CHECK(text.find("5000.0(2.5)\n") != std::string::npos);
  CHECK(text.find(" 0\n") != std::string::npos);
}

TEST_CASE("A table for programs nests its axes, and has null for what is no number") {
  const Json json = table_json(example());
  CHECK(json.at("quantities").at("a").at("values").dump() == "[[1.0,2.0,3.0],[4.0,5.0,null]]");
  CHECK(json.at("quantities").at("tau").at("values") == 12.345678);
  CHECK(json.at("axes").at("lag").at("values").dump() == "[2,4,8]");
  CHECK(json.at("notes").at("verdict") == "it ages");
}

TEST_CASE("A table as CSV has a block a set of axes") {
  CHECK(table_csv(example()) ==
        "# point_0000/ageing\n# verdict: it ages\n"
        "tau,tau_error\n12.345678,0.21\n\n"
        "age,lag,a\n1,2,1\n1,4,2\n1,8,3\n10,2,4\n10,4,5\n10,8,\n\n"
        "age,kind\n1,x\n10,\"y, z\"\n\n");
}

TEST_CASE("A value that is not there is an empty field of a CSV") {
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double value : {std::nan(""), -std::nan(""), infinity, -infinity})
    CHECK(csv_number(value).empty());
  CHECK(csv_number(0.1) == "0.1");
  CHECK(csv_number(-1e-300) == "-1e-300");
  const Table table = {
      .name = "t",
      .axes = {{"n", {"n"}, std::vector<std::uint64_t>{1, 2}, "", "", ""}},
      .quantities = {{"x", {"n"}, std::vector{infinity, 1.0}, "1", "", ""},
                     {"y", {"n"}, std::vector{-infinity, std::nan("")}, "1", "", ""}},
      .notes = {}};
  CHECK(table_csv(table) == "# t\nn,x,y\n1,,\n2,1,\n\n");
  // No field is lost where the first ones are empty, and a lone one is no empty line.
  const Table first = {.name = "t",
                       .axes = {{"n", {"n"}, std::vector<std::uint64_t>{1}, "", "", ""}},
                       .quantities = {{"x", {}, std::vector{infinity}, "1", "", ""},
                                      {"y", {}, std::vector{2.5}, "1", "", ""}},
                       .notes = {}};
  CHECK(table_csv(first) == "# t\nx,y\n,2.5\n\n");
  const Table lone = {.name = "t",
                      .axes = {},
                      .quantities = {{"x", {}, std::vector{infinity}, "1", "", ""}},
                      .notes = {}};
  CHECK(table_csv(lone) == "# t\nx\n\"\"\n\n");
}
