#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>

#include "cli/commands/commands.hpp"
#include "cli/files/keep_tables.hpp"
#include "cli/files/live_input.hpp"
#include "cli/files/output_file.hpp"
#include "cli/files/waiting.hpp"
#include "cli/options/fit_arguments.hpp"
#include "cli/options/values.hpp"
#include "cli/reports/fit_output.hpp"
#include "cli/terminal/screen.hpp"
#include "cli/terminal/standard_streams.hpp"
#include "config/json/json_text.hpp"
#include "config/json/suggestion.hpp"
#include "fitting/models/models.hpp"
#include "study/available_cpus.hpp"
#include "study/provenance.hpp"
#include "study/tables/fit_source.hpp"
#include "study/tables/fits.hpp"
#include "study/tables/laws/law_formula.hpp"
#include "study/tables/laws/own_law.hpp"
#include "study/tables/measured/curve_file.hpp"

namespace jostle::inline cli {

namespace {

std::vector<std::string> model_names() {
  std::vector<std::string> names{"all"};
  for (const auto& model : all_models()) names.push_back(model->name());
  return names;
}

std::vector<std::unique_ptr<Model>> models_of_name(const std::string& name) {
  auto models = models_named(name);
  if (!models.empty()) return models;
  const std::vector<std::string> names = model_names();
  throw BadInput(fmt::format("--model {}: there is none; there are {}.{}", name,
                             joined(names, ", "), did_you_mean(name, names)));
}

std::map<std::string, double> fixed_parameters(const std::vector<std::string>& texts) {
  std::map<std::string, double> fixed;
  for (const auto& [name, number] : named_numbers("--fix", texts)) {
    if (!fixed.emplace(name, number).second) {
      throw BadInput(fmt::format("--fix {}={}: {} is fixed already", name, number, name));
    }
  }
  return fixed;
}

std::map<std::string, ParameterBounds> parameter_bounds(const std::vector<std::string>& texts) {
  std::map<std::string, ParameterBounds> bounds;
  for (const std::string& text : texts) {
    const auto equals = text.find('=');
    if (equals == std::string::npos) {
      throw BadInput(fmt::format("--bounds {}: not NAME=LOWER:UPPER, as tau=0:", text));
    }
    const FitRange range =
        read_range("--bounds", text.substr(equals + 1), text.substr(0, equals + 1));
    if (!bounds.emplace(text.substr(0, equals), ParameterBounds{range.first, range.last}).second) {
      throw BadInput(fmt::format("--bounds {}: it has bounds already", text));
    }
  }
  return bounds;
}

/// Start values of --law; a fixed parameter keeps its value.
std::unique_ptr<Model> own_law(const FitArguments& arguments) {
  OwnLaw law = arguments.law;
  law.start = named_numbers("--start", arguments.start);
  law.bounds = parameter_bounds(arguments.bounds);
  const std::vector<FormulaName> words = names_in(law.formula);
  for (const auto& [name, value] : fixed_parameters(arguments.fixed)) {
    const auto started = std::ranges::find(law.start, name, &NamedNumber::first);
    if (started != law.start.end()) {
      started->second = value;
    } else if (std::ranges::find(words, name, &FormulaName::text) != words.end()) {
      law.start.emplace_back(name, value);
    }
  }
  return make_own_law(law);
}

std::vector<std::unique_ptr<Model>> chosen_models(const FitArguments& arguments) {
  const bool own = !arguments.law.formula.empty();
  std::vector<std::unique_ptr<Model>> models;
  if (own) models.push_back(own_law(arguments));
  if (own && arguments.models.empty()) return models;
  auto names = arguments.models;
  if (names.empty()) names = {"all"};
  for (const std::string& name : names)
    for (auto& model : models_of_name(name))
      if (std::ranges::find(models, model->name(), &Model::name) == models.end())
        models.push_back(std::move(model));
  return models;
}

FitSource measured_source(const FitArguments& arguments) {
  refuse_options_of_results(arguments);
  const FitRange range = read_range("--range", arguments.range.empty() ? ":" : arguments.range);
  MeasuredCurve measured = read_curve(
      arguments.input,
      {.columns = arguments.realizations ? CurveColumns::realizations : CurveColumns::errors,
       .gaps = arguments.gaps == "drop-row" ? Gaps::drop_row : Gaps::use_others,
       .first = range.first,
       .last = range.last});
  FitSource source;
  source.curve = std::move(measured.curve);
  source.notes = std::move(measured.notes);
  source.units = measured.units;
  source.title = arguments.input;
  if (!arguments.realizations && !arguments.independent) {
    source.notes.emplace_back(
        source.curve.sigma.empty()
            ? "One curve: its errors do not contain the scatter between experiments."
            : "One curve: its errors contain the scatter between experiments only if sigma does.");
  }
  if (arguments.realizations) {
    const std::size_t n = std::max<std::size_t>(source.curve.n_realizations, 1);
    source.title += fmt::format(", {} realization{}", n, n == 1 ? "" : "s");
  }
  return source;
}

/// `made`: set for a results file.
std::vector<FitSource> read_sources(const FitArguments& arguments, DataVersion& made) {
  const std::string& input = arguments.input;
  if (!is_results_file(input)) {
    if (input.ends_with(".h5") || std::filesystem::is_directory(input))
      reject_input(input, "not a results file");
    return {measured_source(arguments)};
  }
  refuse_options_of_text(arguments);
  if (arguments.observable.empty()) {
    throw BadInput(
        "a results file has several curves: name one with --observable NAME; jostle info lists "
        "them");
  }
  if (arguments.observable.find(',') != std::string::npos) {
    throw BadInput(fmt::format("--observable {}: a command fits one observable; run it for each",
                               arguments.observable));
  }
  // Tap 0 is the start: a law of taps begins with the first.
  const FitRange range = read_range("--range", arguments.range.empty() ? "1:" : arguments.range);
  const ResultsFile file = open_to_read(arguments.input, arguments.live);
  made = file.data_version();
  return results_curves(file, chosen_points(file.study(), arguments.point), arguments.observable,
                        range);
}

FitManner manner_of(const FitArguments& arguments) {
  return {.fixed = fixed_parameters(arguments.fixed),
          .memory = !arguments.independent,
          .resampled = arguments.resample != "none",
          .resampling = {.kind = arguments.resample == "bootstrap" ? Resampling::bootstrap
                                                                   : Resampling::jackknife,
                         .count = arguments.count,
                         .seed = arguments.seed,
                         .threads = arguments.threads > 0 ? arguments.threads : available_cpus()}};
}

Json source_json(const FittedCurve& fitted) {
  const auto& [source, outcomes, comparison] = fitted;
  Json object = {{"title", source.title}, {"fits", Json::array()}};
  if (!source.point || !source.notes.empty()) object["notes"] = source.notes;
  if (source.point) {
    object["observable"] = source.observable;
    object["sweep_point"] = *source.point;
    object["label"] = source.label;
    object["realizations"] = std::max<std::size_t>(source.curve.n_realizations, 1);
  }
  if (!source.curve.t.empty()) {
    object["range"] = Json::array({source.curve.t.front(), source.curve.t.back()});
  }
  for (const FitOutcome& outcome : outcomes) object["fits"].push_back(fit_json(outcome));
  if (outcomes.size() > 1) object["comparison"] = comparison_json(comparison);
  return object;
}

/// The option that helps where every law was refused, on a line of its own; or nothing.
std::string remedy(const FittedCurve& fitted) {
  const bool gaps = std::ranges::any_of(fitted.outcomes, [](const FitOutcome& outcome) {
    const auto* refusal = std::get_if<Refusal>(&outcome.result);
    return refusal != nullptr && refusal->kind == RefusalKind::gaps;
  });
  return gaps ? "\n  --gaps drop-row leaves them out" : "";
}

int run_fits(const FitArguments& arguments) {
  require_text_output("--csv", arguments.csv, std::span(&arguments.input, 1), arguments.force);
  require_measured_output(arguments.measured, arguments.input, arguments.force);
  const auto models = chosen_models(arguments);
  DataVersion made;
  const std::vector<FitSource> sources = read_sources(arguments, made);
  if (!arguments.csv.empty() && sources.size() > 1) {
    throw BadInput("--csv holds one curve: choose it with --sweep-point");
  }
  const FitManner manner = manner_of(arguments);
  const Provenance provenance = provenance_of_this_run("");
  std::vector<Table> tables;
  std::string csv, refusals;  // refusals of curves without a fit
  bool any = false;
  std::optional<FittedCurve> drawn;  // the measured curve
  Json curves = Json::array();
  for (const FitSource& source : sources) {
    const FittedCurve fitted = fit_curve(models, source, manner);
    const std::string refusal = refusal_of_all(fitted);
    any = any || refusal.empty();
    if (!refusal.empty()) refusals += (refusals.empty() ? "" : "\n") + refusal + remedy(fitted);
    if (arguments.json) {
      curves.push_back(source_json(fitted));
    } else if (refusal.empty()) {
      print_report(fits_text(fitted, arguments.layout) + memory_hint(fitted));
    }
    if (source.point) {
      const auto fits = fit_tables(fitted, manner);
      tables.insert(tables.end(), fits.begin(), fits.end());
    }
    if (!arguments.csv.empty()) csv = fit_csv(source.curve, fitted.outcomes);
    if (refusal.empty() && arguments.measured.is_wanted()) drawn = fitted;
  }
  if (arguments.json) {
    const Json object = {{"input", arguments.input},
                         {"curves", curves},
                         {"provenance", provenance_json(provenance)}};
    print_json(object);
  }
  if (any && !arguments.csv.empty())
    write_text(arguments.csv, csv, existing_files(arguments.force));
  if (drawn) {
    const std::string written =
        write_measured(arguments.measured, *drawn, arguments.input, arguments.force, provenance);
    if (!arguments.json) print(written);
  }
  const bool to_store = !tables.empty() && !arguments.not_stored && arguments.live == Live::no;
  const bool lost = to_store && !keep_tables(arguments.input, "fits", tables, provenance,
                                             arguments.patience, made);
  if (!any) throw BadInput(refusals);
  if (!refusals.empty()) print_to_standard_error(fmt::format("jostle: {}\n", refusals));
  return lost ? exit_io_error : exit_ok;
}

/// A law of one's own, and the options that have no sense without it.
void add_law_options(const Command& app, FitArguments& a) {
  Command command = app;
  const auto fault = [](const std::string& formula) -> std::string {
    return formula.empty() ? "an empty formula is no law" : "";
  };
  const Option law = command
                         .add_option("--law", a.law.formula,
                                     "A law of your own, a formula of t: \"X0 + a*log(1 + t/tau)\"")
                         .check(fault, "");
  command.add_option("--start", a.start, "Start values of the law's parameters, NAME=NUMBER,...")
      .separated_by(',')
      .needs(law);
  command
      .add_option("--bounds", a.bounds,
                  "Bounds of the law's parameters, NAME=LOWER:UPPER,...; tau=0: for a positive tau")
      .separated_by(',')
      .needs(law);
  command
      .add_option("--law-name", a.law.name,
                  "Name of the law in tables and in the file (default: own)")
      .needs(law);
}

}  // namespace

void add_fit(Command& app, int& code) {
  Command command = app.add_command("fit", "Fit the papers' laws to results or a measured curve");
  auto arguments = std::make_shared<FitArguments>();
  FitArguments& a = *arguments;
  command
      .add_option(
          "input", a.input,
          "Results, or a text file with columns t, X and optionally sigma (or --realizations)")
      .required()
      .file_name()
      .offers_files({"h5", "csv", "txt"});
  command.add_option("--observable", a.observable, "Observable of the results to fit");
  command.add_option("--sweep-point", a.point,
                     "Sweep point: its number, VALUE or NAME=VALUE (default: every point)");
  command
      .add_option(
          "--model", a.models,
          "Laws to fit, NAME,... (docs/reference/laws.md), or all: inverse_log, two_exponentials "
          "and kww (default without --law)")
      .separated_by(',')
      .offers(model_names());
  add_law_options(command, a);
  command.add_option(
      "--range", a.range,
      "Range of t to fit, FIRST:LAST; either may be omitted (default: results from tap 1)");
  command.add_option("--fix", a.fixed, "Fixed values of parameters, NAME=NUMBER,...")
      .separated_by(',');
  command.add_flag("--realizations", a.realizations,
                   "The text file has a column t and one column of X per realization, two or more");
  const Option gaps =
      command
          .add_option("--gaps", a.gaps,
                      "Treatment of a realization without a value: use-others (default), drop-row")
          .one_of({"use-others", "drop-row"});
  command.add_flag(
      "--independent", a.independent,
      "Take the text file's rows as independent: residuals are not tested for correlation");
  const Option resample = command
                              .add_option("--resample", a.resample,
                                          "Additional errors, from resampled realizations: "
                                          "jackknife, bootstrap, none (default)")
                              .one_of({"jackknife", "bootstrap", "none"});
  const Option count =
      command.add_option("--resamples", a.count, "Number of bootstrap samples (default: 1000)")
          .limit(2, 1000000);
  const Option seed = command.add_option("--seed", a.seed, "Seed of the bootstrap (default: 1)");
  command.add_threads(a.threads);
  a.layout.width = screen().width;
  command.add_flag(
      "--wide,--verbose", [arguments] { arguments->layout.columns = Columns::all; },
      "All columns: also linear errors, meanings and the statistics of each fit");
  command.add_flag("--json", a.json, "Print JSON, for programs");
  command.add_option("--csv", a.csv, "File to which the curve and its fits are also written")
      .file_to_write();
  add_measured_output(command, a.measured);
  command.add_flag("--no-store", a.not_stored, "Leave the results file as it is");
  add_wait(command, a.patience);
  add_live(command, a.live);
  command.add_flag("--force", a.force, "Replace files of --csv, --figures and --page that exist");
  command.footer(
      "Examples:\n"
      "  jostle fit quickstart.h5 --observable bottom_fraction     all laws\n"
      "  jostle fit bell.h5 --observable bulk_fraction --model kww,inverse_log\n"
      "  jostle fit measured.csv --model kww --fix rho_0=0.567 --csv fitted.csv\n"
      "  jostle fit measured.csv --law \"X0 + a*log(1 + t/b)\" --start X0=1,a=0.1,b=9\n"
      "  jostle fit experiments.csv --realizations       one column per experiment\n"
      "  jostle fit measured.csv --model kww --independent --page measured.html\n"
      "\n"
      "Fits of results are kept in their file, under /fits. docs/reference/laws.md explains the\n"
      "report. Exit code 2 means that no law could be fitted.");
  command.run([=, &code] {
    if (arguments->resample != "bootstrap" && (count.count() > 0 || seed.count() > 0))
      throw BadInput("--resamples and --seed apply only to --resample bootstrap: add it");
    arguments->resampling_asked_for = resample.count() > 0 && arguments->resample != "none";
    arguments->gaps_asked_for = gaps.count() > 0;
    code = run_fits(*arguments);
  });
}

}  // namespace jostle::inline cli
