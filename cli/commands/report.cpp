#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "cli/commands/commands.hpp"
#include "cli/files/figure_files.hpp"
#include "cli/files/keep_tables.hpp"
#include "cli/files/live_input.hpp"
#include "cli/files/output_file.hpp"
#include "cli/terminal/standard_streams.hpp"
#include "results/file/results_file.hpp"
#include "study/amounts.hpp"
#include "study/available_cpus.hpp"
#include "study/drawing/page/page.hpp"
#include "study/provenance.hpp"

namespace jostle::inline cli {
namespace {

struct ReportArguments {
  std::vector<std::string> inputs;
  std::string output, catalogue;
  FigureFolder figures;
  int columns = 1;
  bool force = false;
  Live live = Live::no;
  int threads = 0;
};

std::vector<ResultsFile> opened(const ReportArguments& arguments) {
  require_different(arguments.inputs);
  std::vector<ResultsFile> files;
  for (const std::string& input : arguments.inputs) {
    files.push_back(open_to_read(input, arguments.live));
  }
  require_different_runs(files);
  return files;
}

void write_figure_folder(const ReportArguments& arguments) {
  FigureFolder folder = arguments.figures;
  folder.columns = arguments.columns == 2 ? JournalColumns::two : JournalColumns::single;
  folder.force = arguments.force;
  print(write_figures(opened(arguments), folder, provenance_of_this_run("")));
}

void write_catalogue(const ReportArguments& arguments) {
  require_text_output("--catalogue", arguments.catalogue, arguments.inputs, arguments.force);
  const std::string catalogue = figure_catalogue(opened(arguments), arguments.figures.sweep_point,
                                                 provenance_of_this_run(""));
  write_text(arguments.catalogue, catalogue, existing_files(arguments.force));
}

void write_page(const ReportArguments& arguments) {
  const std::string output =
      !arguments.output.empty()
          ? arguments.output
          : std::filesystem::path(arguments.inputs.front()).stem().string() + ".html";
  if (output != arguments.output) {
    require_no_link(output);
    require_replaceable(output, "page.html");
  }
  require_text_output("-o", output, arguments.inputs, arguments.force);
  const std::vector<ResultsFile> files = opened(arguments);
  std::vector<PageSource> sources;
  for (const ResultsFile& file : files) {
    sources.push_back({file, arguments.live == Live::yes ? "" : digest_of(file.path())});
  }
  const int threads = arguments.threads > 0 ? arguments.threads : available_cpus();
  const std::string page = report_page(sources, provenance_of_this_run(""), threads);
  write_text(output, page, existing_files(arguments.force));
  if (!is_stream(output)) {
    print(fmt::format("{}: {}; open it in a browser\n", output, format_bytes(double(page.size()))));
  }
}

}  // namespace

void add_report(Command& app, int& code) {
  Command command = app.add_command("report", "Write one page that shows results, for a browser");
  auto arguments = std::make_shared<ReportArguments>();
  ReportArguments& a = *arguments;
  command.add_option("file", a.inputs, "Results; several are shown one after another")
      .required()
      .file_name()
      .offers_files({"h5"});
  Option output = command.add_option(
      "-o,--output", a.output,
      "The page to write (default: the first input's name with .html, in the current folder)");
  output.file_to_write().offers_files({"html"});
  Option figures =
      command.add_option("--figures", a.figures.path,
                         "Write no page but its figures into this folder: SVG and PDF, with their "
                         "data and Python scripts");
  figures.file_to_write().excludes(output);
  command
      .add_option("--columns", a.columns,
                  "Width of the figures: one column of a journal, 86 mm, or two, 178 mm (default: "
                  "1)")
      .limit(1, 2)
      .needs(figures);
  command.add_option("--sweep-point", a.figures.sweep_point,
                     "Figures of these sweep points alone: number, VALUE or NAME=VALUE");
  command
      .add_option(
          "--catalogue", a.catalogue,
          "Write no page but a description of its figures as JSON, all digits, to this file")
      .file_to_write()
      .offers_files({"json"})
      .excludes(output)
      .excludes(figures);
  add_live(command, a.live);
  command.add_flag("--force", a.force, "Replace files that exist");
  command.add_threads(a.threads);
  command.footer(
      "Examples:\n"
      "  jostle report quickstart.h5                      writes quickstart.html\n"
      "  jostle report low.h5 high.h5 -o both.html         two runs on one page\n"
      "  jostle report quickstart.h5 --figures figures     its figures, for a paper\n"
      "  jostle report quickstart.h5 --catalogue fig.json  its figures, for another program\n"
      "\n"
      "The page needs nothing but a browser: no network, no other file. It shows what the files\n"
      "hold: curves, and the tables that fit, analyse, structure and cost have stored; make those\n"
      "first. Kept packings can be turned and sliced. docs/reference/report.md lists the "
      "sections.");
  command.run([arguments, &code] {
    if (!arguments->figures.sweep_point.empty() && arguments->figures.path.empty() &&
        arguments->catalogue.empty()) {
      throw BadInput("--sweep-point needs --figures or --catalogue: a page shows all sweep points");
    }
    if (!arguments->catalogue.empty()) {
      write_catalogue(*arguments);
    } else if (!arguments->figures.path.empty()) {
      write_figure_folder(*arguments);
    } else {
      write_page(*arguments);
    }
    code = exit_ok;
  });
}

}  // namespace jostle::inline cli
