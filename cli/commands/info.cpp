#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "cli/commands/commands.hpp"
#include "cli/files/waiting.hpp"
#include "cli/reports/effects.hpp"
#include "cli/reports/report.hpp"
#include "cli/tables/wrapped.hpp"
#include "cli/terminal/screen.hpp"
#include "cli/terminal/standard_streams.hpp"
#include "results/disk/error.hpp"
#include "results/disk/printable.hpp"
#include "results/file/results_file.hpp"
#include "results/run/live_run.hpp"
#include "study/amounts.hpp"
#include "study/running/stored_scene.hpp"

namespace jostle::inline cli {
namespace {

/// A realization that is begun runs only while its process does.
const char* name(RealizationStatus status, bool alive) {
  switch (status) {
    case RealizationStatus::missing:
      return "missing";
    case RealizationStatus::running:
      return alive ? "running" : "unfinished";
    case RealizationStatus::done:
      return "done";
    case RealizationStatus::failed:
      return "failed";
  }
  return "unknown";
}

bool is_alive(const RunStatus& status) {
  return status.owner && status.owner->alive;
}

/// A file whose run was killed still contains "running", and a file that is resumed its former
/// state: the lock decides.
std::string state_of(const RunStatus& status) {
  if (is_alive(status)) return "running";
  if (status.state != RunState::running) return name_of(status.state);
  return fmt::format("{}; --resume continues it", status.owner ? "killed" : "stopped");
}

Json realization_json(const RealizationSummary& realization, bool alive, std::string unit) {
  std::ranges::replace(unit, ' ', '_');
  Json json{{"point", realization.id.point},
            {"realization", realization.id.realization},
            {"status", name(realization.status, alive)},
            {"taps_recorded", realization.taps()},
            {unit, realization.work.effort.units},
            {"seconds", realization.work.seconds}};
  if (realization.status == RealizationStatus::running && !(realization.work.seconds > 0))
    json[unit] = json["seconds"] = nullptr;  // killed before it recorded a cost
  if (!realization.reason.empty()) json["reason"] = realization.reason;
  return json;
}

/// A text of the scene, empty where it has none.
std::string text_of(const Json& scene, std::string_view key) {
  const Json* member = scene.find(key);
  return member ? member->text() : "";
}

/// A value of the sweep as the scene has it.
Json json_or_text(const std::string& value) {
  try {
    return Json::parse(value);
  } catch (const JsonError&) {
    return value;
  }
}

Json info_json(const ResultsFile& file, const RunStatus& status) {
  const Study& study = file.study();
  Json points = Json::array(), realizations = Json::array();
  for (const auto& point : study.points) {
    Json values = Json::object();
    for (const auto& [pointer, value] : point.sweep_values) values[pointer] = json_or_text(value);
    points.push_back({{"label", point.label},
                      {"values", values},
                      {"spheres", point.n_spheres},
                      {"taps", point.taps},
                      {"seed", point.seed}});
  }
  for (const auto& summary : status.realizations) {
    realizations.push_back(
        realization_json(summary, is_alive(status), study.points[summary.id.point].unit));
  }
  return {{"file", file.path()},
          {"state", name_of(status.state)},
          {"alive", is_alive(status)},
          {"shard", {{"index", file.shard().index}, {"count", file.shard().count}}},
          {"version", file.provenance().front().version},
          {"git_revision", file.provenance().front().git_revision},
          {"scene", stored_scene(file)},
          {"points", points},
          {"realizations", realizations},
          {"tables", file.table_names()},
          {"tables_without_results", file.tables_without_results()},
          {"bytes", {{"file", status.file_bytes}, {"parts", status.parts_bytes}}}};
}

std::string counts(const ResultsFile& file, const RunStatus& status) {
  std::map<RealizationStatus, std::uint64_t> by_status;
  std::uint64_t taps = 0, all_taps = 0;
  for (const auto& summary : status.realizations) {
    if (!in_share(file.shard(), file.study(), summary.id)) continue;
    ++by_status[summary.status];
    taps += summary.taps();
    all_taps += file.study().points[summary.id.point].taps;
  }
  std::string text;
  for (const auto& [status_of_some, n] : by_status) {
    text +=
        fmt::format("{}{} {}", text.empty() ? "" : ", ", n, name(status_of_some, is_alive(status)));
  }
  return text + fmt::format("; {} of {} taps", taps, all_taps);
}

void print_info(const ResultsFile& file, const RunStatus& status, const Layout& layout) {
  const Study& study = file.study();
  const Json scene = stored_scene(file);
  std::string text = fmt::format("{}: {}, {}\n", printable_name(file.path()),
                                 text_of(scene, "name"), state_of(status));
  if (const std::string description = text_of(scene, "description"); !description.empty()) {
    text += description + "\n";
  }
  const auto line = [&](const char* key, const std::string& value) {
    text += fmt::format("  {:<13}{}\n", key, value);
  };
  line("sweep points", fmt::to_string(study.points.size()));
  line("realizations",
       fmt::format("{} per sweep point: {}", study.realizations, counts(file, status)));
  if (file.shard().count > 1) {
    line("shard", fmt::format("{}/{}", file.shard().index, file.shard().count));
  }
  line("seed", fmt::to_string(study.points.front().seed));
  line("size", fmt::format("{} and {} of parts", format_bytes(double(status.file_bytes)),
                           format_bytes(double(status.parts_bytes))));
  const std::vector<std::string> refused = file.tables_without_results();
  for (const std::string& table : file.table_names())
    line("table", fmt::format("/{}{}", table,
                              std::ranges::binary_search(refused, table) ? ": no result" : ""));
  for (const auto& process : file.provenance()) {
    line("made by", fmt::format("jostle {} ({}) on {}, {}, {} thread{}", process.version,
                                process.git_revision, process.host, process.started,
                                process.threads, process.threads == "1" ? "" : "s"));
  }
  std::optional<ResultsFile> live;
  try {
    live.emplace(live_results(file.path(), Content::without_snapshots));
    if (status.parts_bytes > 0) line("curves", "so far, with the last checkpoints");
  } catch (const ResultsError& error) {  // no room for a temporary file, for one
    line("curves", fmt::format("of the last stop, without checkpoints: {}", error.what()));
  }
  const ResultsFile& curves = live ? *live : file;
  print_report(wrapped(text + effects_text(scene), layout.width) + "\n" + report(curves, layout));
  print_curves(curves);
}

struct InfoArguments {
  std::string file;
  bool digest = false, json = false, reseal = false;
  Patience patience;
  Layout layout;
};

void seal_again(const InfoArguments& arguments) {
  const bool done = reseal(arguments.file, arguments.patience);
  print(fmt::format("{}: {}\n", arguments.file,
                    done ? "its contents are the old ones, and it is sealed again"
                         : "is sealed: there is nothing to do"));
}

void info(const InfoArguments& arguments) {
  if (arguments.reseal) return seal_again(arguments);
  if (arguments.digest) {
    print(fmt::format("{}\n", digest_of(arguments.file)));
    return warn_of_lost_seals(std::span(&arguments.file, 1));
  }
  const ResultsFile file(arguments.file);
  warn_of_lost_seals(std::span(&arguments.file, 1));
  const RunStatus status = run_status(arguments.file);
  try {
    if (arguments.json) {
      print_json(info_json(file, status));
    } else {
      print_info(file, status, arguments.layout);
    }
  } catch (const JsonError&) {
    throw ResultsError(arguments.file,
                       "its scene (/scene/resolved) is not as jostle writes it; restore the file "
                       "from a copy");
  }
}

}  // namespace

void add_info(Command& app, int& code) {
  Command command = app.add_command("info", "Summarise a results file, also of a live run");
  auto arguments = std::make_shared<InfoArguments>();
  command.add_option("file", arguments->file, "The results").required().offers_files({"h5"});
  const Option digest =
      command.add_flag("--digest", arguments->digest,
                       "Print the SHA-256 of data and scene: equal for equal results of one scene");
  Option json = command.add_flag("--json", arguments->json, "Print the summary as JSON");
  json.excludes(digest);
  Option reseal = command.add_flag(
      "--reseal", arguments->reseal,
      "Write the checksum at the file's end again, which other programs cut off when they open the "
      "file for writing; contents that were changed are refused");
  reseal.excludes(digest).excludes(json);
  add_wait(command, arguments->patience);
  add_wide(command, arguments->layout);
  command.footer(
      "Examples:\n"
      "  jostle info quickstart.h5            what was run, how far it is, its curves\n"
      "  jostle info quickstart.h5 --digest   equal for equal results\n"
      "  jostle info quickstart.h5 --reseal   after h5py or HDFView had it open for writing");
  command.run([arguments, &code] {
    info(*arguments);
    code = exit_ok;
  });
}

}  // namespace jostle::inline cli
