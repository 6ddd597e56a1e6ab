#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "cli/commands/arguments.hpp"
#include "cli/commands/commands.hpp"
#include "cli/terminal/keep_tables.hpp"
#include "cli/terminal/live_input.hpp"
#include "cli/terminal/output_file.hpp"
#include "cli/terminal/standard_streams.hpp"
#include "cli/terminal/table_output.hpp"
#include "config/json/json_text.hpp"
#include "config/json/suggestion.hpp"
#include "results/error.hpp"
#include "results/export/input_file.hpp"
#include "study/available_cpus.hpp"
#include "study/provenance.hpp"
#include "study/scene_file.hpp"
#include "study/tables/analyse.hpp"
#include "study/tables/structure.hpp"

namespace jostle {

namespace {

struct StructureArguments {
  std::vector<std::string> inputs, parts;
  std::vector<std::uint64_t> taps;
  std::string point, settings, csv;
  bool json = false, not_stored = false, force = false;
  Live live = Live::no;
  int threads = 0;
};

/// A JSON object, or the file that holds it.
StructureSettings read_settings(const std::string& given) {
  std::string text = given;
  if (!given.starts_with('{')) {
    try {
      text = read_text_file(given, Pipes::allowed);
    } catch (const ResultsError& error) {
      throw BadInput(
          fmt::format("--settings {}; nor is it a JSON object, as "
                      "'{{\"pores\": {{\"bin_width\": 0.01}}}}'",
                      error.what()));
    }
  }
  const ParsedStructure parsed = parse_structure(text);
  if (!parsed.settings) throw BadInput("--settings:\n" + fault_lines(parsed.faults));
  return *parsed.settings;
}

void require_parts(const std::vector<std::string>& named) {
  const std::vector<std::string> known = parts_of(all_structure());
  for (const std::string& part : named) {
    if (std::ranges::find(known, part) == known.end()) {
      throw BadInput(fmt::format("--part {}: there is no such part; there are {}.{}", part,
                                 joined(known, ", "), did_you_mean(part, known)));
    }
  }
}

/// By the given settings, or else those of the scene: the named parts, or else those that they
/// have, or else every part.
StructureSettings wanted(const StructureArguments& arguments, StructureSettings settings) {
  require_parts(arguments.parts);
  if (!arguments.settings.empty()) settings = read_settings(arguments.settings);
  std::vector<std::string> parts = arguments.parts;
  if (parts.empty()) parts = parts_of(settings);
  if (parts.empty()) parts = parts_of(all_structure());
  return with_parts(std::move(settings), parts);
}

/// Prints, and writes what is asked for. Returns whether any part was measured.
bool show(const StructureArguments& arguments, const std::vector<Table>& tables,
          const Provenance& by) {
  Json listed = Json::array();
  std::string csv;
  bool any = false;
  for (const Table& table : tables) {
    any = any || is_made(table);
    if (arguments.json) {
      listed.push_back(table_json(table));
    } else {
      print(fmt::format("{}\n", table_text(table, Detail::brief)));
    }
    csv += table_csv(table);
  }
  if (arguments.json) {
    const Json object = {{"tables", listed}, {"provenance", provenance_json(by)}};
    print_json(object);
  }
  if (!arguments.csv.empty()) write_text(arguments.csv, csv);
  return any;
}

/// What is read stays.
void require_output(const StructureArguments& arguments) {
  std::vector<std::string> read = arguments.inputs;
  if (!arguments.settings.empty()) read.push_back(arguments.settings);
  require_text_output("--csv", arguments.csv, read, arguments.force);
}

int measure_structure(const StructureArguments& arguments) {
  require_output(arguments);
  const Provenance by = provenance_of_this_run("");
  const int threads = arguments.threads > 0 ? arguments.threads : available_cpus();
  const bool results = is_results_file(arguments.inputs.front());
  for (const std::string& input : arguments.inputs) {
    if (is_results_file(input) != results || (results && arguments.inputs.size() > 1)) {
      throw BadInput(
          "one results file, or extended XYZ files that are realizations of one ensemble");
    }
    if (!results && !input.ends_with(".xyz") && !input.ends_with(".extxyz")) {
      throw BadInput(
          fmt::format("{}: neither a results file nor extended XYZ (.xyz, .extxyz)", input));
    }
  }
  require_different(arguments.inputs);
  std::vector<Table> tables;
  if (results) {
    const ResultsFile file = open_to_read(arguments.inputs.front(), arguments.live);
    tables = structure_of(file, chosen_points(file.study(), arguments.point),
                          wanted(arguments, structure_asked_for(file)), arguments.taps, threads);
  } else {
    if (!arguments.point.empty()) {
      throw BadInput("--sweep-point: extended XYZ files have no sweep points");
    }
    tables = structure_of(arguments.inputs, wanted(arguments, {}), arguments.taps, threads);
  }
  const bool any = show(arguments, tables, by);
  if (results && !arguments.not_stored && arguments.live == Live::no) {
    keep_tables(arguments.inputs.front(), "structure", tables, by);
  }
  return any ? exit_ok : exit_bad_input;
}

}  // namespace

void add_structure(CLI::App& app, int& code) {
  auto* command = app.add_subcommand(
      "structure", "Profiles, order, Voronoi cells, pores and holes of kept packings");
  auto arguments = std::make_shared<StructureArguments>();
  StructureArguments& a = *arguments;
  command->add_option("input", a.inputs, "Results, or packings in extended XYZ, one a realization")
      ->required()
      ->check(CLI::ExistingFile);
  command
      ->add_option(
          "--part", a.parts,
          "What to measure, separated by commas (default: what the scene names, else all): "
          "profile, sides, layers, coordination, pair_correlation, order, voronoi, pores, "
          "void_probability, holes")
      ->delimiter(',');
  command->add_option("--settings", a.settings,
                      "As the scene's \"structure\": a JSON file, or the object itself");
  command
      ->add_option("--tap", a.taps,
                   "Taps with a packing (frames of extended XYZ, from 0), separated by commas "
                   "(default: all)")
      ->delimiter(',');
  command->add_option("--sweep-point", a.point,
                      "Its number, or POINTER=VALUE of the sweep (default: every point)");
  command->add_flag("--json", a.json, "Print JSON, for programs");
  command->add_option("--csv", a.csv, "Also write the tables to this file")->check(file_to_write());
  command->add_flag("--force", a.force, "Replace the file of --csv if it exists");
  command->add_flag("--no-store", a.not_stored, "Leave the results file as it is");
  add_live(*command, a.live);
  command->add_option("--threads", a.threads, "Threads (default: the CPUs this process may use)")
      ->check(CLI::Range(1, 4096))
      ->envname("JOSTLE_THREADS");
  command->footer(
      "Examples:\n"
      "  jostle structure quickstart.h5                             every part, every kept tap\n"
      "  jostle structure fig10.h5 --part pores --tap 0,99 --csv pores.csv\n"
      "  jostle structure a.xyz b.xyz c.xyz --json                  three packings, their mean\n"
      "  jostle structure fig9.h5 --settings '{\"pores\": {\"bin_width\": 0.01}}'\n"
      "\n"
      "Tables are kept in the results file, under /structure; what they mean:\n"
      "docs/structure.md. Exit code 2 where nothing could be measured.");
  command->callback([arguments, &code] { code = measure_structure(*arguments); });
}

}  // namespace jostle
