#include "study/drawing/page/page_run.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <limits>

#include "study/drawing/drawn/study_words.hpp"
#include "study/drawing/drawn/thinning.hpp"
#include "study/drawing/page/page_json.hpp"
#include "study/running/stored_scene.hpp"

namespace jostle::inline study {
namespace {

constexpr std::size_t most_listed = 50;          // failures, processes
constexpr std::size_t most_named_points = 2000;  // most points that are named
constexpr std::size_t longest_scene = 60000;     // bytes

Json page_container(const Container& container) {
  return {{"kind", name_of(container)},
          {"width_x", page_number(width_x(container))},
          {"width_y", page_number(width_y(container))}};
}

/// For the realizations of a sweep point, or of all.
struct Tally {
  std::uint64_t done = 0, unfinished = 0, failed = 0, missing = 0, taps = 0;
  Work work;

  void add(const RealizationSummary& realization) {
    work += realization.work;
    taps += realization.taps();
    ++(realization.status == RealizationStatus::done      ? done
       : realization.status == RealizationStatus::failed  ? failed
       : realization.status == RealizationStatus::running ? unfinished
                                                          : missing);
  }
  Json json() const {
    return {{"done", done},
            {"unfinished", unfinished},
            {"failed", failed},
            {"missing", missing},
            {"taps_stored", taps},
            {"units", work.effort.units},
            {"seconds", page_number(work.seconds)}};
  }
};

Json page_provenance(const Provenance& provenance) {
  return {{"version", page_text(provenance.version)},
          {"git_revision", page_text(provenance.git_revision)},
          {"libraries", page_text(provenance.libraries)},
          {"host", page_text(provenance.host)},
          {"cpu", page_text(provenance.cpu)},
          {"instruction_set", page_text(provenance.instruction_set)},
          {"threads", page_text(provenance.threads)},
          {"command_line", page_text(provenance.command_line)},
          {"started", page_text(provenance.started)}};
}

Json page_points(const Study& study, const DrawnFile& drawn, const std::vector<Tally>& tallies) {
  Json points = Json::array();
  for (const std::size_t p : evenly_spread(study.points.size(), most_named_points)) {
    const StudyPoint& point = study.points[p];
    Json values = Json::object();
    for (const auto& [pointer, value] : point.sweep_values) {
      values[page_text(pointer).text()] = page_text(value);
    }
    points.push_back({{"number", p},
                      {"label", page_text(drawn.label(static_cast<std::uint32_t>(p)))},
                      {"values", values},
                      {"spheres", point.n_spheres},
                      {"taps", point.taps},
                      {"seed", fmt::to_string(point.seed)},
                      {"unit", page_text(point.unit)},
                      {"bed", bed_words(point)},
                      {"container", page_container(point.container)},
                      {"realizations", tallies[p].json()}});
  }
  return points;
}

/// A scene that is too long, as of a sweep of thousands of values, is left to jostle info.
Json page_scene(const ResultsFile& file, std::vector<std::string>& left_out) {
  const Json scene = page_value(stored_scene(file));
  if (scene.dump().size() <= longest_scene) return scene;
  left_out.push_back(
      "the scene is longer than a page has room for: its name and description alone");
  Json head = Json::object();
  for (const char* key : {"name", "description"}) {
    if (const Json* const text = scene.find(key)) head[key] = *text;
  }
  return head;
}

}  // namespace

Json page_run(const ResultsFile& file, const DrawnFile& drawn, const std::string& digest,
              std::vector<std::string>& left_out) {
  const Study& study = file.study();
  std::vector<Tally> tallies(study.points.size());
  Tally all;
  Json failures = Json::array(), processes = Json::array();
  for (const RealizationSummary& realization : file.realizations()) {
    tallies[realization.id.point].add(realization);
    all.add(realization);
    if (realization.status != RealizationStatus::failed || failures.size() >= most_listed) continue;
    failures.push_back({{"point", realization.id.point},
                        {"realization", realization.id.realization},
                        {"seed", fmt::to_string(study.points[realization.id.point].seed)},
                        {"reason", page_text(realization.reason)}});
  }
  for (const Provenance& provenance : file.provenance()) {
    if (processes.size() < most_listed) processes.push_back(page_provenance(provenance));
  }
  if (study.points.size() > most_named_points) {
    left_out.push_back(
        fmt::format("{} of {} sweep points are named", most_named_points, study.points.size()));
  }
  return {{"file", page_text(std::filesystem::path(file.path()).filename().string())},
          {"state", name_of(file.state())},
          {"shard", {{"index", file.shard().index}, {"count", file.shard().count}}},
          {"digest", digest},
          {"about", study_words(study)},
          {"realizations_a_point", study.realizations},
          {"realizations", all.json()},
          {"unit", page_text(common_unit(study))},
          {"failures", failures},
          {"processes", processes},
          {"n_points", study.points.size()},
          {"points", page_points(study, drawn, tallies)},
          {"scene", page_scene(file, left_out)}};
}

}  // namespace jostle::inline study
