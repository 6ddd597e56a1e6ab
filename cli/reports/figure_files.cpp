#include "cli/reports/figure_files.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <set>

#include "cli/files/gnuplot.hpp"
#include "cli/files/keep_tables.hpp"
#include "cli/files/output_file.hpp"
#include "ensemble/statistics/counted.hpp"
#include "results/checkpoints/output_path.hpp"
#include "study/figures/figures.hpp"
#include "study/report/study_words.hpp"
#include "study/results_input.hpp"

namespace jostle::inline cli {
namespace {

namespace fs = std::filesystem;

struct FigureOfFile {
  Figure figure;
  std::string origin;  // of which file
};

constexpr const char* kinds[] = {".dat", ".gp", ".svg", ".pdf"};

/// Makes the folder, and refuses what stands there already.
void require_folder_for(const FigureFolder& folder, const std::vector<FigureOfFile>& figures,
                        const std::vector<std::string>& inputs) {
  std::error_code fault;
  if (fs::exists(folder.path, fault) && !fs::is_directory(folder.path, fault)) {
    throw BadInput(fmt::format("--figures {}: it is a file. Name a folder.", folder.path));
  }
  make_folder(folder.path);
  for (const FigureOfFile& one : figures) {
    for (const char* const kind : kinds) {
      const std::string path = (fs::path(folder.path) / (one.figure.name + kind)).string();
      require_no_link(path);
      if (is_stream(path)) {
        throw BadInput(fmt::format(
            "{} is a pipe or a device: name another folder with --figures, or remove it", path));
      }
      require_not_read("--figures", path, inputs);
      if (!folder.force && fs::exists(path, fault)) {
        throw BadInput(fmt::format(
            "{} exists and is kept. Name another folder with --figures, or replace what is there "
            "with --force.",
            path));
      }
      require_text_output("--figures", path, inputs, folder.force);
    }
  }
}

/// Refuses first; then writes data and scripts, and draws.
void write_all(const FigureFolder& folder, const std::vector<FigureOfFile>& figures,
               const std::vector<std::string>& inputs) {
  require_folder_for(folder, figures, inputs);
  std::vector<std::vector<NamedText>> sources;
  for (const FigureOfFile& one : figures) {
    const std::string& name = one.figure.name;
    sources.push_back({{name + ".dat", figure_data(one.figure, one.origin)},
                       {name + ".gp", figure_script(one.figure, folder.columns)}});
    for (const NamedText& source : sources.back()) {
      write_text((fs::path(folder.path) / source.name).string(), source.text);
    }
  }
  for (std::size_t i = 0; i < figures.size(); ++i) {
    const std::string& name = figures[i].figure.name;
    for (const NamedText& one :
         run_gnuplot(name + ".gp", sources[i], {name + ".svg", name + ".pdf"})) {
      write_text((fs::path(folder.path) / one.name).string(), one.text);
    }
  }
}

std::string written_text(const FigureFolder& folder, std::size_t n) {
  return fmt::format("{}: {}, each as SVG and PDF with its data (.dat) and its script (.gp)\n",
                     folder.path, counted(n, "figure"));
}

}  // namespace

std::string write_figures(std::span<const ResultsFile> files, const FigureFolder& folder,
                          const Provenance& by) {
  std::vector<FigureOfFile> figures;
  std::vector<std::string> inputs;
  std::string left_out;
  std::set<std::string> words;  // of files, where there are several
  for (std::size_t i = 0; i < files.size(); ++i) {
    const ResultsFile& file = files[i];
    inputs.push_back(file.path());
    const std::string name = fs::path(file.path()).filename().string();
    const auto points = folder.sweep_point.empty()
                            ? std::vector<std::uint32_t>{}
                            : chosen_points(file.study(), folder.sweep_point);
    DrawnFigures drawn = figures_of(file, points, files.size());
    for (const std::string& one : drawn.left_out) left_out += fmt::format("{}: {}\n", name, one);
    if (drawn.has_other_points) left_out += "--sweep-point draws another one.\n";
    std::string word = file_word(fs::path(name).stem().string());
    if (!words.insert(word).second) word += fmt::format("-file-{}", i + 1);
    for (Figure& figure : drawn.figures) {
      if (files.size() > 1) figure.name = word + "-" + figure.name;
      figures.push_back(
          {std::move(figure), fmt::format("Of {}: {}. Drawn by jostle {} ({})", name,
                                          study_words(file.study()), by.version, by.git_revision)});
    }
  }
  if (figures.empty()) {
    throw BadInput("the results hold nothing that a figure shows: no taps, and no tables");
  }
  write_all(folder, figures, inputs);
  return written_text(folder, figures.size()) + left_out;
}

std::string write_figures(const FittedCurve& measured, const std::string& input,
                          const FigureFolder& folder, const Provenance& by) {
  std::vector<FigureOfFile> figures;
  for (Figure& figure : figures_of(measured).figures) {
    figures.push_back(
        {std::move(figure), fmt::format("Of {}. Drawn by jostle {} ({})", measured.source.title,
                                        by.version, by.git_revision)});
  }
  write_all(folder, figures, {input});
  return written_text(folder, figures.size());
}

}  // namespace jostle::inline cli
