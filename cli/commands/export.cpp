#include <fmt/format.h>

#include <filesystem>
#include <functional>
#include <map>
#include <memory>

#include "cli/commands/commands.hpp"
#include "cli/files/keep_tables.hpp"
#include "cli/files/live_input.hpp"
#include "cli/files/output_file.hpp"
#include "cli/files/waiting.hpp"
#include "cli/options/values.hpp"
#include "cli/tables/text_table.hpp"
#include "cli/terminal/standard_streams.hpp"
#include "ensemble/statistics/counted.hpp"
#include "results/disk/printable.hpp"
#include "results/export/export.hpp"
#include "results/export/h5md.hpp"
#include "results/file/results_file.hpp"
#include "results/run/live_run.hpp"
#include "study/bad_input.hpp"

namespace jostle::inline cli {
namespace {

const std::map<std::string, ExportFormat> formats = {{"extxyz", ExportFormat::extended_xyz},
                                                     {"lammps", ExportFormat::lammps},
                                                     {"vtp", ExportFormat::vtk},
                                                     {"h5md", ExportFormat::h5md}};

struct ExportArguments {
  std::string input, output, format, point;
  std::vector<std::string> taps;
  std::uint32_t realization = 0;
  bool realization_given = false, force = false;
  Live live = Live::no;
  Patience patience;  // with who works on the file that is written
};

/// Packings, and what they are called.
struct Wanted {
  std::vector<ExportedFrame> frames;
  std::string source;  // for people
  std::string suffix;  // distinguishes the default name from those of other packings of the file
};

Wanted wanted(const ExportArguments& arguments) {
  const KeptTaps taps = kept_taps("--tap", arguments.taps);
  const std::string& input = arguments.input;
  if (is_results_file(input)) {
    const ResultsFile file = open_to_read(input, arguments.live);
    const RealizationId id{chosen_point(file.study(), arguments.point), arguments.realization};
    const std::string& label = file.study().points.at(id.point).label;
    Wanted found{kept_frames(file, id, taps),
                 fmt::format("sweep point {}{}, realization {}, tap", id.point,
                             label.empty() ? "" : fmt::format(" ({})", label), id.realization),
                 ""};
    if (file.study().points.size() > 1) found.suffix += fmt::format("_point{}", id.point);
    if (arguments.realization_given) found.suffix += fmt::format("_realization{}", id.realization);
    return found;
  }
  if (!input.ends_with(".xyz") && !input.ends_with(".extxyz")) {
    reject_input(input, "neither a results file nor extended XYZ (.xyz, .extxyz)");
  }
  if (!arguments.point.empty() || arguments.realization_given || arguments.live == Live::yes) {
    throw BadInput(fmt::format(
        "{}: --sweep-point, --realization and --live apply only to results files", input));
  }
  return {kept_frames(input, taps), fmt::format("{}, frame", input), ""};
}

/// How a frame a file, or all in one, are written.
struct Writing {
  std::vector<std::string> paths;
  std::function<void()> write;
};

Writing writing(ExportFormat format, const std::string& output,
                const std::vector<ExportedFrame>& frames, ExistingFile existing) {
  if (format == ExportFormat::h5md)
    return {{output}, [&, existing] { write_h5md(output, frames, existing); }};
  Writing found;
  auto files = exported_files(format, output, frames);
  for (const ExportedFile& file : files) found.paths.push_back(file.path);
  found.write = [files = std::move(files), existing] { write_together(files, existing); };
  return found;
}

int export_packings(const ExportArguments& arguments) {
  const ExportFormat format = formats.at(arguments.format);
  const Wanted found = wanted(arguments);
  const std::string output = !arguments.output.empty()
                                 ? arguments.output
                                 : std::filesystem::path(arguments.input).stem().string() +
                                       found.suffix + "." + extension(format);
  const Writing files = writing(format, output, found.frames, existing_files(arguments.force));
  // Nothing is written where one of the files may not be.
  for (const std::string& path : files.paths) {
    require_replaceable(path, fmt::format("packing.{}", extension(format)));
    if (path != arguments.output) require_no_link(path);
    require_text_output("-o", path, std::span(&arguments.input, 1), arguments.force);
  }
  std::vector<std::uint64_t> taps;
  for (const ExportedFrame& frame : found.frames) taps.push_back(frame.tap);
  files.write();
  print(fmt::format("{}: {} {}, {}\n", files.paths.back(), found.source, list_of(taps),
                    counted(found.frames.front().packing.centres.size(), "sphere")));
  return exit_ok;
}

/// The results themselves, with the checkpoints of a run in progress: a file for other programs.
int export_results(const ExportArguments& arguments) {
  const std::string& input = arguments.input;
  if (!is_results_file(input)) reject_input(input, "not a results file");
  if (arguments.output.empty()) {
    throw BadInput("--format results: -o FILE: name the file to write");
  }
  if (!arguments.point.empty() || arguments.realization_given || !arguments.taps.empty()) {
    throw BadInput(
        "--format results: --sweep-point, --realization and --tap mean nothing: all of "
        "the run is written");
  }
  require_replaceable(arguments.output, "copy.h5");
  require_text_output("-o", arguments.output, std::span(&input, 1), arguments.force);
  if (arguments.force) require_results_or_empty(arguments.output);
  write_copy(input, arguments.output, arguments.live == Live::yes, existing_files(arguments.force),
             arguments.patience);
  warn_of_lost_seals(std::span(&input, 1));
  print(fmt::format("{}: {} of {}\n", printable_name(arguments.output),
                    arguments.live == Live::yes ? "results and last checkpoints" : "results",
                    input));
  return exit_ok;
}

}  // namespace

void add_export(Command& app, int& code) {
  Command command = app.add_command("export", "Write packings for OVITO, ParaView and others");
  auto arguments = std::make_shared<ExportArguments>();
  ExportArguments& a = *arguments;
  command.add_option("file", a.input, "Results, or a packing in extended XYZ")
      .required()
      .file_name()
      .offers_files({"h5", "xyz", "extxyz"});
  command
      .add_option("--format", a.format,
                  "extxyz, lammps (text dump), vtp (VTK points), h5md; results: all of the run")
      .required()
      .one_of({"extxyz", "lammps", "vtp", "h5md", "results"});
  command
      .add_option("-o,--output", a.output,
                  "The file to write (default: the input's name, of a sweep with _pointP, with "
                  ".xyz, .dump, .vtp or .h5md, in the current folder)")
      .file_to_write();
  command.add_option("--sweep-point", a.point,
                     "Sweep point: its number, VALUE or NAME=VALUE (default: the first)");
  const Option realization =
      command.add_option("--realization", a.realization, "Realization, by its number (default: 0)");
  command
      .add_option("--tap", a.taps,
                  "Taps with a snapshot (frames of extended XYZ, from 0), separated by "
                  "commas, or all (default: the last)")
      .separated_by(',');
  add_wait(command, a.patience);
  add_live(command, a.live);
  command.add_flag("--force", a.force, "Replace files that exist");
  command.footer(
      "Examples:\n"
      "  jostle export quickstart.h5 --format extxyz            into quickstart.xyz\n"
      "  jostle export quickstart.h5 --format lammps --tap all  one frame per snapshot\n"
      "  jostle export quickstart.h5 --format vtp --tap 0,100   two .vtp, and a .pvd\n"
      "  jostle export packing.xyz --format vtp -o packing.vtp\n"
      "  jostle export quickstart.h5 --format h5md --tap all    for MDAnalysis\n"
      "  jostle export quickstart.h5 --format results --live -o so_far.h5\n"
      "\n"
      "Every sphere with its radius, coordination (centres within 1.05 times the sum of the\n"
      "two radii) and the volume of its Voronoi cell, radical in a mixture. Equal spheres\n"
      "also have q6 and crystal structure, spheres of a mixture their kind and mass. A scene\n"
      "can start from the extended XYZ, which keeps every bit.");
  command.run([arguments, realization, &code] {
    arguments->realization_given = realization.count() > 0;
    code =
        arguments->format == "results" ? export_results(*arguments) : export_packings(*arguments);
  });
}

}  // namespace jostle::inline cli
