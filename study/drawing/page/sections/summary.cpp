#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "ensemble/statistics/student_tests.hpp"
#include "fitting/comparison/held_out.hpp"
#include "study/drawing/drawn/study_words.hpp"
#include "study/drawing/drawn/thinning.hpp"
#include "study/drawing/drawn/value_text.hpp"
#include "study/drawing/figures/builders.hpp"
#include "study/drawing/page/sections/sections.hpp"

// A file in five lines: run, packing fraction at the end, law, steady state, ageing.
namespace jostle::inline study {
namespace {

constexpr std::size_t most_named = 8;  // sweep points in a line

std::string linked(const std::vector<std::string>& parts, const std::string& separator = ", ") {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : separator) + part;
  return text;
}

/// A label that a line does not break.
std::string unbroken(const DrawnFile& file, std::uint32_t point) {
  std::string label;
  for (const char c : file.label(point))
    label += c == ' ' ? std::string("\u00a0") : std::string(1, c);
  return label;
}

/// Answers of sweep points, grouped by answer.
class Answers {
 public:
  explicit Answers(const DrawnFile& file) : file_(file) {}

  void add(std::uint32_t point, const std::string& answer) {
    auto known = std::ranges::find(answers_, answer, &Answer::text);
    if (known == answers_.end()) known = answers_.insert(answers_.end(), {answer, {}});
    known->points.push_back(point);
  }

  /// "reached at ε = 0.02, ε = 0.1; cannot decide at ε = 0.3"; without points where all agree.
  std::string text() const {
    if (answers_.size() == 1 && (file_.n_points() == 1 || answers_[0].points.size() > 1)) {
      return answers_[0].text + (file_.n_points() > 1 ? ", at all sweep points" : "");
    }
    std::vector<std::string> parts;
    for (const Answer& answer : answers_) parts.push_back(answer.text + " at " + names(answer));
    return linked(parts, "; ");
  }

 private:
  struct Answer {
    std::string text;
    std::vector<std::uint32_t> points;
  };

  std::string names(const Answer& answer) const {
    if (answer.points.size() > most_named) {
      return fmt::format("{} of {} sweep points", answer.points.size(), file_.n_points());
    }
    std::vector<std::string> labels;
    for (const std::uint32_t point : answer.points) labels.push_back(unbroken(file_, point));
    return linked(labels);
  }

  const DrawnFile& file_;
  std::vector<Answer> answers_;
};

/// The packing fraction where one is observed, else the first observable.
const DrawnColumn* described_column(const DrawnFile& file) {
  for (const char* const name : {"bulk_fraction", "bottom_fraction", "corrected_fraction"}) {
    if (const DrawnColumn* const column = file.column(name)) {
      const bool has_value = std::ranges::any_of(column->mean, [](double x) { return x == x; });
      if (has_value) return column;
    }
  }
  for (const DrawnCurve& curve : file.curves()) {
    for (const DrawnColumn& column : curve.columns) {
      if (column.is_observable) return &column;
    }
  }
  return nullptr;
}

/// The last mean of every sweep point.
std::string at_the_end(const DrawnFile& file) {
  const DrawnColumn* const wanted = described_column(file);
  if (wanted == nullptr) return "";
  std::vector<std::string> parts;
  std::vector<std::size_t> taps;
  for (const std::size_t i : evenly_spread(file.curves().size(), most_named)) {
    const DrawnCurve& curve = file.curves()[i];
    const auto column = std::ranges::find_if(curve.columns, [&](const DrawnColumn& drawn_column) {
      return drawn_column.label.name == wanted->label.name;
    });
    if (column == curve.columns.end()) continue;
    for (std::size_t t = curve.taps.size(); t-- > 0;) {
      if (!std::isfinite(column->mean[t])) continue;
      std::string part = typeset_with_error(column->mean[t], column->half_width[t]);
      if (file.n_points() > 1) part += " at " + unbroken(file, curve.point);
      if (!taps.empty() && taps.front() != curve.taps[t]) {
        part += fmt::format(" (after {} taps)", curve.taps[t]);
      }
      taps.push_back(curve.taps[t]);
      parts.push_back(std::move(part));
      break;
    }
  }
  if (parts.empty()) return "";
  return fmt::format("{} after {} taps: {}", axis_label(wanted->label.name, wanted->label.units),
                     taps.front(), linked(parts));
}

/// The laws that held-out realizations do not reject.
std::string law_answer(const FittedLaws& fitted) {
  std::vector<std::string> kept, uncompared;
  std::size_t n_rejected = 0;
  for (const TableView& law : fitted.laws) {
    const double p = law.value("held_out_p");
    if (p < LawComparison::level)
      ++n_rejected;
    else
      (std::isnan(p) ? uncompared : kept).push_back(law_name(law));
  }
  if (fitted.laws.size() == 1)
    return linked(uncompared.empty() ? kept : uncompared, "") + " (no other law fitted)";
  if (kept.empty()) return linked(uncompared, " or ") + " (not compared)";
  std::string rejected = "none rejected";
  if (n_rejected > 0)
    rejected = kept.size() == 1 ? "all others rejected" : fmt::format("{} rejected", n_rejected);
  if (!uncompared.empty())
    rejected += "; " + linked(uncompared, " and ") + " not compared with them";
  return fmt::format("{} ({})", linked(kept, " or "), rejected);
}

std::string law_line(const DrawnFile& file) {
  std::vector<TableView> made;
  for (const TableView& table : file.made_of("fits")) {
    if (table.has("fitted")) made.push_back(table);
  }
  if (made.empty()) return "";
  Answers answers(file);
  std::string observable;
  for (const std::uint32_t point : numbers_of(made)) {
    const std::vector<FittedLaws> fitted = fitted_laws(made, point);
    if (observable.empty()) observable = fitted.front().observable;
    for (const FittedLaws& laws : fitted) {
      if (laws.observable == observable) answers.add(point, law_answer(laws));
    }
  }
  return words(observable) + ": " + answers.text();
}

/// The verdict on the observable that the summary describes. If it has no such analysis, that on
/// another fraction or the mean height, else on the first observable that has one.
std::string verdict_line(const DrawnFile& file, const std::string& kind,
                         const std::function<std::string(const TableView&)>& answer_of) {
  const std::vector<TableView> made = file.made_of("analysis", kind);
  if (made.empty()) return "";
  std::vector<std::string> wanted = {"bottom_fraction", "corrected_fraction", "mean_height"};
  if (const DrawnColumn* const described = described_column(file)) {
    wanted.insert(wanted.begin(), described->label.name);
  }
  const auto found = std::ranges::find_if(wanted, [&](const std::string& name) {
    return std::ranges::find(made, name, &TableView::observable) != made.end();
  });
  const std::string observable = found == wanted.end() ? made.front().observable() : *found;
  Answers answers(file);
  for (const TableView& table : made) {
    if (!table.point() || table.observable() != observable) continue;
    answers.add(*table.point(), answer_of(table));
  }
  return words(observable) + ": " + answers.text();
}

std::string steady_answer(const TableView& table) {
  const std::string verdict = table.note("verdict");
  if (verdict.starts_with("reached")) return "no drift found";
  if (verdict.starts_with("not reached")) return "still drifts";
  return "cannot decide";
}

std::string ageing_answer(const TableView& table) {
  const std::string verdict = table.note("ageing_verdict");
  if (verdict.empty() || verdict.starts_with("cannot decide")) return "cannot decide";
  return table.value("ageing_p") < significance_level ? "A(t, t_W) changes with age"
                                                      : "no change with age found";
}

std::string or_hint(const std::string& line, const std::string& command) {
  return line.empty() ? "not analysed; command: " + command : line;
}

/// A file's name without its folders: a page does not show where it was made.
std::string file_name(const std::string& path) {
  return path.substr(path.find_last_of('/') + 1);
}

}  // namespace

Json summary_section(const DrawnFile& file, const std::string& run, const std::string& path) {
  const DrawnColumn* const column = described_column(file);
  const std::string option = column == nullptr ? "" : ", observable " + column->label.name;
  const std::string name = file_name(path);
  return page_section(
      "summary", "Summary", "",
      {definitions_block("summary",
                         {{"run", run},
                          {"end", at_the_end(file)},
                          {"law", or_hint(law_line(file), "jostle fit " + name + option)},
                          {"steady?", or_hint(verdict_line(file, "steady", steady_answer),
                                              "jostle analyse " + name + " steady" + option)},
                          {"ageing?", or_hint(verdict_line(file, "ageing", ageing_answer),
                                              "jostle analyse " + name + " ageing" + option)}})});
}

}  // namespace jostle::inline study
