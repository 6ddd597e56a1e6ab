#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <map>
#include <memory>

#include "cli/arguments.hpp"
#include "cli/commands.hpp"
#include "cli/output_file.hpp"
#include "cli/results_input.hpp"
#include "cli/scene_file.hpp"
#include "results/export.hpp"
#include "results/publish.hpp"
#include "results/results_file.hpp"

namespace jostle {
namespace {

const std::map<std::string, ExportFormat> formats = {{"extxyz", ExportFormat::extended_xyz},
                                                     {"lammps", ExportFormat::lammps},
                                                     {"vtp", ExportFormat::vtk}};

struct ExportArguments {
  std::string input, output, format, point;
  std::vector<std::string> taps;
  std::uint32_t realization = 0;
  bool realization_given = false, force = false;
};

KeptTaps tap_choice(const std::vector<std::string>& words) {
  KeptTaps choice;
  for (const std::string& word : words) {
    std::uint64_t tap = 0;
    const char* const end = word.data() + word.size();
    const auto read = std::from_chars(word.data(), end, tap);
    if (word == "all") {
      choice.all = true;
    } else if (read.ec == std::errc() && read.ptr == end) {
      choice.taps.push_back(tap);
    } else {
      throw BadInput(
          fmt::format("--tap {}: neither a number nor \"all\"; several: --tap 0,10,100", word));
    }
  }
  return choice;
}

RealizationId wanted(const ExportArguments& arguments) {
  if (!is_results_file(arguments.input)) {
    if (!arguments.point.empty() || arguments.realization_given) {
      throw BadInput(fmt::format(
          "{}: not a results file: --sweep-point and --realization mean nothing", arguments.input));
    }
    if (!arguments.input.ends_with(".xyz") && !arguments.input.ends_with(".extxyz")) {
      throw BadInput(fmt::format("{}: neither a results file nor extended XYZ (.xyz, .extxyz)",
                                 arguments.input));
    }
    return {};
  }
  const ResultsFile file = open_results(arguments.input);
  if (arguments.point.empty()) return {0, arguments.realization};
  return {chosen_points(file.study(), arguments.point).front(), arguments.realization};
}

int export_packings(const ExportArguments& arguments) {
  const ExportFormat format = formats.at(arguments.format);
  const std::string output =
      !arguments.output.empty()
          ? arguments.output
          : std::filesystem::path(arguments.input).stem().string() + "." + extension(format);
  const RealizationId id = wanted(arguments);
  const auto frames = kept_frames(arguments.input, id, tap_choice(arguments.taps));
  const auto files = exported_files(format, output, frames);
  // Nothing is written where one of the files may not be.
  for (const ExportedFile& file : files) {
    require_replaceable(file.path, fmt::format("packing.{}", extension(format)));
    require_text_output("-o", file.path, std::span(&arguments.input, 1), arguments.force);
  }
  std::vector<std::uint64_t> taps;
  for (const ExportedFrame& frame : frames) taps.push_back(frame.tap);
  for (const ExportedFile& file : files) publish(file.path, std::as_bytes(std::span(file.text)));
  const std::string source =
      is_results_file(arguments.input)
          ? fmt::format("sweep point {}, realization {}, tap", id.point, id.realization)
          : fmt::format("{}, frame", arguments.input);
  fmt::print("{}: {} {}, {} spheres\n", files.back().path, source, list_of(taps),
             frames.front().packing.centres.size());
  return exit_ok;
}

}  // namespace

void add_export(CLI::App& app, int& code) {
  auto* command = app.add_subcommand("export", "Write packings for OVITO, ParaView and others");
  auto arguments = std::make_shared<ExportArguments>();
  ExportArguments& a = *arguments;
  command->add_option("file", a.input, "Results, or a packing in extended XYZ")
      ->required()
      ->check(CLI::ExistingFile);
  command->add_option("--format", a.format, "extxyz, lammps (text dump), vtp (VTK points)")
      ->required()
      ->check(CLI::IsMember({"extxyz", "lammps", "vtp"}));
  command
      ->add_option("-o,--output", a.output,
                   "The file to write (default: the input's name with .xyz, .dump or .vtp, in "
                   "the current folder)")
      ->check(file_to_write());
  command->add_option("--sweep-point", a.point,
                      "Its number, or POINTER=VALUE of the sweep (default: the first)");
  auto* realization =
      command->add_option("--realization", a.realization, "Its number (default: 0)");
  command
      ->add_option("--tap", a.taps,
                   "Taps with a snapshot (frames of extended XYZ, from 0), separated by "
                   "commas, or all (default: the last)")
      ->delimiter(',');
  command->add_flag("--force", a.force, "Replace files that exist");
  command->footer(
      "Examples:\n"
      "  jostle export quickstart.h5 --format extxyz            writes quickstart.xyz\n"
      "  jostle export quickstart.h5 --format lammps --tap all  every snapshot, a frame each\n"
      "  jostle export quickstart.h5 --format vtp --tap 0,100   two .vtp files, and a .pvd of "
      "both\n"
      "  jostle export packing.xyz --format vtp -o packing.vtp\n"
      "\n"
      "Every sphere with its radius, coordination (centres within 1.05 diameters), the volume of\n"
      "its Voronoi cell, q6 and crystal structure. A scene can start from the extended XYZ: the\n"
      "same bits.");
  command->callback([arguments, realization, &code] {
    arguments->realization_given = realization->count() > 0;
    code = export_packings(*arguments);
  });
}

}  // namespace jostle
