#include "cli/reports/next_commands.hpp"

#include <catch2/catch.hpp>

#include "study/provenance.hpp"

using namespace jostle;

namespace {

/// The names of the commands after a study of so many points and taps, whose scene is so.
std::string proposed(const std::string& scene, std::size_t points = 1, std::uint64_t taps = 1000,
                     std::vector<std::uint64_t> kept = {}) {
  Study study;
  study.realizations = 8;
  StudyPoint point;
  point.taps = taps;
  for (const char* name : {"mean_height", "bulk_fraction"})
    point.observables.push_back({name, "1", "", "", Shown::spread});
  point.snapshots.taps = std::move(kept);
  study.points.assign(points, point);
  std::string text;
  for (const auto& words : next_commands(study, Json::parse(scene), "a.h5"))
    text += (text.empty() ? "" : ", ") + words[0] + (words[0] == "analyse" ? " " + words[2] : "");
  return text;
}

}  // namespace

TEST_CASE("The next commands are those that make sense for a scene") {
  const std::string protocol = R"("protocol": [{"tap": {"dilate": 0.05}, "count": 9}])";
  const std::string nothing =
      R"(, "fits": [], "analyse": {"ageing": [], "sweep": []}, "structure": {})";
  CHECK(proposed("{" + protocol + nothing + "}") == "fit, analyse ageing");
  CHECK(proposed("{" + protocol + nothing + "}", 1, 100, {0, 9}) == "fit, structure");
  CHECK(proposed("{" + protocol + nothing + "}", 1, 10, {0}) == "structure, export");
  CHECK(proposed("{" + protocol + nothing + "}", 1, 10) == "info");
  CHECK(proposed("{" + protocol + nothing + "}", 4, 100, {0}) == "analyse sweep, fit");
  CHECK(proposed(R"({"protocol": [{"ramp": {}}, {"ramp": {}}]})", 1, 100, {0}) ==
        "analyse hysteresis, structure");
}

TEST_CASE("Steps that a scene does itself are not proposed again, except its page") {
  const std::string protocol = R"({"protocol": [{"tap": {"dilate": 0.05}, "count": 9}], )";
  CHECK(proposed(protocol + R"("fits": [{"observable": "mean_height"}]})") ==
        "analyse ageing, report");
  CHECK(proposed(protocol + R"("analyse": {"ageing": [{"observable": "mean_height"}]}})") ==
        "fit, report");
  CHECK(proposed(protocol + R"("structure": {"order": {"bin_width": 1}}})", 1, 10, {0}) ==
        "report, export");
}

TEST_CASE("A command that resumes names its scene, whatever characters the name has") {
  for (const std::string scene :
       {"plain.json", "two words.json", "it's.json", "tab\tand ' and \\.json", "\xce\xb5\\x41.json",
        "\xff\n\\\\x41 $'b'.json", "a$'b'.json"}) {
    CAPTURE(scene);
    const std::string stored = shell_words({"jostle", "run", scene, "--threads", "2"});
    CHECK(redo_command("jostle", stored, 0, 1, "a.h5") ==
          shell_words({"jostle", "run", scene, "--threads=2", "--resume", "-o", "a.h5"}));
  }
}
