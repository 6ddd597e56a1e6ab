#include "cli/files/figure_files.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <set>

#include "cli/files/keep_tables.hpp"
#include "cli/files/output_file.hpp"
#include "cli/files/python_plot.hpp"
#include "ensemble/statistics/counted.hpp"
#include "results/disk/error.hpp"
#include "results/disk/output_path.hpp"
#include "results/disk/printable.hpp"
#include "study/drawing/drawn/study_words.hpp"
#include "study/drawing/figures/figures.hpp"
#include "study/results_input.hpp"

namespace jostle::inline cli {
namespace {

namespace fs = std::filesystem;

struct FigureOfFile {
  Figure figure;
  std::string origin;  // the file that it comes from
};

constexpr const char* kinds[] = {".csv", ".json", ".py", ".svg", ".pdf"};

/// The folder of the figures and its new files. New files are removed again unless they are kept: a
/// full disk leaves neither an empty folder nor some of the data.
class WrittenFigures {
 public:
  WrittenFigures(const std::string& folder, bool force)
      : folder_(folder), existing_(existing_files(force)) {
    std::error_code fault;
    if (fs::exists(folder_, fault) && !fs::is_directory(folder_, fault)) {
      throw BadInput(fmt::format("--figures {}: it is a file. Name a folder.", folder));
    }
    made_ = !fs::is_directory(folder_, fault);
    make_folder(folder);
  }
  WrittenFigures(const WrittenFigures&) = delete;
  WrittenFigures& operator=(const WrittenFigures&) = delete;
  ~WrittenFigures() {
    if (kept_) return;
    std::error_code fault;  // the earlier failure is reported
    for (const fs::path& file : files_) fs::remove(file, fault);
    if (made_) fs::remove(folder_, fault);
  }
  void write(const std::string& name, const std::string& text) {
    const fs::path path = folder_ / name;
    std::error_code fault;
    const bool is_new = !fs::exists(path, fault);
    write_text(path.string(), text, existing_);
    if (is_new) files_.push_back(path);
  }
  void keep() { kept_ = true; }

 private:
  fs::path folder_;
  ExistingFile existing_;
  std::vector<fs::path> files_;
  bool made_ = false, kept_ = false;
};

/// Rejects existing files.
void require_room_for(const FigureFolder& folder, const std::vector<FigureOfFile>& figures,
                      const std::vector<std::string>& inputs) {
  std::error_code fault;
  for (const FigureOfFile& figure : figures) {
    for (const char* const kind : kinds) {
      const std::string path = (fs::path(folder.path) / (figure.figure.name + kind)).string();
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

/// Refuses first; then writes data, JSON and scripts, and draws.
void write_all(const FigureFolder& folder, const std::vector<FigureOfFile>& figures,
               const std::vector<std::string>& inputs) {
  WrittenFigures written(folder.path, folder.force);
  require_room_for(folder, figures, inputs);
  std::vector<Json> described;
  for (const FigureOfFile& figure : figures) {
    const std::string& name = figure.figure.name;
    described.push_back(figure_json(figure.figure, figure.origin, Digits::all));
    written.write(name + ".csv", figure_csv(figure.figure));
    written.write(name + ".json", described.back().dump() + "\n");
    written.write(name + ".py", figure_script(name, folder.columns));
  }
  written.keep();  // data and scripts are useful without matplotlib
  const std::vector<PaperFigure> drawn = draw_with_python(described, folder.columns);
  for (std::size_t i = 0; i < figures.size(); ++i) {
    written.write(figures[i].figure.name + ".svg", drawn[i].svg);
    written.write(figures[i].figure.name + ".pdf", drawn[i].pdf);
  }
}

std::string written_text(const FigureFolder& folder, std::size_t n) {
  return fmt::format(
      "{}: {}, each as SVG and PDF with its data (.csv), its description (.json) and its script "
      "(.py)\n",
      printable_name(folder.path), counted(n, "figure"));
}

}  // namespace

namespace {

struct FiguresOfFiles {
  std::vector<FigureOfFile> figures;
  std::vector<std::string> inputs, left_out;  // left_out: one sentence each
  bool has_other_points = false;
};

FiguresOfFiles figures_of_files(std::span<const ResultsFile> files, const std::string& sweep_point,
                                const Provenance& provenance) {
  FiguresOfFiles all;
  std::set<std::string> words;  // names of files, where there are several
  for (std::size_t i = 0; i < files.size(); ++i) {
    const ResultsFile& file = files[i];
    all.inputs.push_back(file.path());
    const std::string name = fs::path(file.path()).filename().string();
    const auto points = sweep_point.empty() ? std::vector<std::uint32_t>{}
                                            : chosen_points(file.study(), sweep_point);
    DrawnFigures drawn = figures_of(file, points, files.size());
    for (const std::string& name_left_out : drawn.left_out)
      all.left_out.push_back(name + ": " + name_left_out);
    all.has_other_points = all.has_other_points || drawn.has_other_points;
    std::string word = file_word(fs::path(name).stem().string());
    if (!words.insert(word).second) word += fmt::format("-file-{}", i + 1);
    for (Figure& figure : drawn.figures) {
      if (files.size() > 1) figure.name = word + "-" + figure.name;
      all.figures.push_back(
          {std::move(figure),
           fmt::format("Data: {}: {}. Drawn by jostle {} ({})", name, study_words(file.study()),
                       provenance.version, provenance.git_revision)});
    }
  }
  if (all.figures.empty()) {
    throw BadInput("the results hold nothing that a figure shows: no taps, and no tables");
  }
  return all;
}

}  // namespace

std::string write_figures(std::span<const ResultsFile> files, const FigureFolder& folder,
                          const Provenance& provenance) {
  const FiguresOfFiles all = figures_of_files(files, folder.sweep_point, provenance);
  write_all(folder, all.figures, all.inputs);
  std::string text = written_text(folder, all.figures.size());
  for (const std::string& line : all.left_out) text += line + "\n";
  if (all.has_other_points) text += "--sweep-point draws others.\n";
  return text;
}

std::string figure_catalogue(std::span<const ResultsFile> files, const std::string& sweep_point,
                             const Provenance& provenance) {
  const FiguresOfFiles all = figures_of_files(files, sweep_point, provenance);
  std::vector<Json> figures;
  for (const FigureOfFile& figure : all.figures) {
    figures.push_back(figure_json(figure.figure, figure.origin, Digits::all));
  }
  return catalogue_json(figures, all.left_out).dump() + "\n";
}

std::string write_figures(const FittedCurve& measured, const std::string& input,
                          const FigureFolder& folder, const Provenance& provenance) {
  std::vector<FigureOfFile> figures;
  for (Figure& figure : figures_of(measured).figures) {
    figures.push_back(
        {std::move(figure), fmt::format("Data: {}. Drawn by jostle {} ({})", measured.source.title,
                                        provenance.version, provenance.git_revision)});
  }
  write_all(folder, figures, {input});
  return written_text(folder, figures.size());
}

}  // namespace jostle::inline cli
