#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "cli/commands/commands.hpp"
#include "cli/files/keep_tables.hpp"
#include "cli/files/live_input.hpp"
#include "cli/files/output_file.hpp"
#include "cli/options/values.hpp"
#include "cli/terminal/shown_tables.hpp"
#include "config/json/json_text.hpp"
#include "config/json/suggestion.hpp"
#include "results/disk/error.hpp"
#include "results/disk/input_file.hpp"
#include "study/available_cpus.hpp"
#include "study/provenance.hpp"
#include "study/running/scene_file.hpp"
#include "study/tables/analyse.hpp"
#include "study/tables/structure.hpp"

namespace jostle::inline cli {

namespace {

struct StructureArguments {
  std::vector<std::string> inputs, parts, taps;
  std::string point, settings;
  TableOutput output;
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

/// None for all of them.
std::vector<std::uint64_t> chosen_taps(const StructureArguments& arguments) {
  KeptTaps taps = kept_taps("--tap", arguments.taps);
  return taps.all ? std::vector<std::uint64_t>{} : std::move(taps.taps);
}

/// Inputs are kept.
void require_output(const StructureArguments& arguments) {
  std::vector<std::string> read = arguments.inputs;
  if (!arguments.settings.empty()) read.push_back(arguments.settings);
  require_text_output("--csv", arguments.output.csv, read, arguments.output.force);
}

int measure_structure(const StructureArguments& arguments) {
  require_output(arguments);
  const std::vector<std::uint64_t> taps = chosen_taps(arguments);
  const Provenance provenance = provenance_of_this_run("");
  const int threads = arguments.threads > 0 ? arguments.threads : available_cpus();
  const bool results = is_results_file(arguments.inputs.front());
  for (const std::string& input : arguments.inputs) {
    if (is_results_file(input) != results || (results && arguments.inputs.size() > 1)) {
      throw BadInput(
          "one results file, or extended XYZ files that are realizations of one ensemble");
    }
    if (!results && !input.ends_with(".xyz") && !input.ends_with(".extxyz")) {
      reject_input(input, "neither a results file nor extended XYZ (.xyz, .extxyz)");
    }
  }
  if (!results && arguments.output.live == Live::yes)
    throw BadInput(
        fmt::format("{}: --live applies only to results files", arguments.inputs.front()));
  require_different(arguments.inputs);
  std::vector<Table> tables;
  DataVersion made;
  if (results) {
    const ResultsFile file = open_to_read(arguments.inputs.front(), arguments.output.live);
    made = file.data_version();
    tables = structure_of(file, chosen_points(file.study(), arguments.point),
                          wanted(arguments, structure_asked_for(file)), taps, threads);
  } else {
    if (!arguments.point.empty()) {
      throw BadInput("--sweep-point: extended XYZ files have no sweep points");
    }
    tables = structure_of(arguments.inputs, wanted(arguments, {}), taps, threads);
  }
  ShownTables shown(arguments.output);
  shown.show(tables, "");
  if (results) shown.keep(arguments.inputs.front(), "structure", tables, provenance, made);
  return shown.end(provenance);
}

}  // namespace

void add_structure(Command& app, int& code) {
  Command command = app.add_command(
      "structure", "Profiles, order, Voronoi cells, pores and holes of kept packings");
  auto arguments = std::make_shared<StructureArguments>();
  StructureArguments& a = *arguments;
  command
      .add_option("input", a.inputs,
                  "Results, or packings in extended XYZ, one file per realization")
      .required()
      .file_name()
      .offers_files({"h5", "xyz", "extxyz"});
  command
      .add_option("--part", a.parts,
                  "Parts to measure, separated by commas (default: those in the scene, else all): "
                  "profile, sides, layers, coordination, pair_correlation, order, gaps, "
                  "structure_factor, voronoi, clusters, pores, "
                  "void_probability, holes")
      .separated_by(',')
      .offers(parts_of(all_structure()));
  command.add_option(
      "--settings", a.settings,
      "Settings in the form of a scene's \"structure\": a JSON file, or the object itself");
  command
      .add_option("--tap", a.taps,
                  "Taps with a packing (frames of extended XYZ, from 0), separated by commas, or "
                  "all (default)")
      .separated_by(',');
  command.add_option("--sweep-point", a.point,
                     "Sweep point: its number, VALUE or NAME=VALUE (default: every point)");
  add_table_output(command, a.output);
  command.add_threads(a.threads);
  command.footer(
      "Examples:\n"
      "  jostle structure quickstart.h5                 every part, every kept tap\n"
      "  jostle structure fig10.h5 --part pores --tap 0,99 --csv pores.csv\n"
      "  jostle structure a.xyz b.xyz c.xyz --json      three packings, their mean\n"
      "  jostle structure fig9.h5 --settings '{\"pores\": {\"bin_width\": 0.01}}'\n"
      "\n"
      "Tables are kept in the results file, under /structure; docs/reference/structure.md\n"
      "explains them. Exit code 2 means that nothing could be measured.");
  command.run([arguments, &code] { code = measure_structure(*arguments); });
}

}  // namespace jostle::inline cli
