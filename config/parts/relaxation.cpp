#include <fmt/format.h>

#include <cmath>

#include "config/names.hpp"
#include "config/parts/kinds.hpp"
#include "config/parts/parts.hpp"

namespace jostle::inline config {

namespace {

// A longer step could go round the narrowest periodic box.
constexpr Range steps = between(1e-9, least_periodic_width);

Move read_polar(const Reader& in) {
  PolarMove move;
  if (!in.is_object_of({"max_step", "theta0", "law"})) return move;
  in.read("max_step", move.max_step, steps);
  in.read("theta0", move.theta0, between(least_theta0, most_theta0));
  in.read_name("law", move.law, theta_laws);
  return move;
}

std::optional<StepAdaptation> read_adaptation(const Reader& in) {
  if (in.value() == "never") return std::nullopt;
  StepAdaptation adaptation;
  if (in.value().is_string()) {
    in.one_of({"never"});
    return adaptation;
  }
  if (!in.is_object_of({"factor", "every_trials", "threshold", "of", "reset_each_tap"})) {
    return adaptation;
  }
  in.read("factor", adaptation.factor, strictly_between(0, 1));
  in.read_whole("every_trials", adaptation.every_trials, 1, most_trials);
  in.read("threshold", adaptation.threshold, above(0, 1));
  in.read_name("of", adaptation.base, acceptance_bases);
  in.read_flag("reset_each_tap", adaptation.reset_each_tap);
  return adaptation;
}

Move read_metropolis(const Reader& in) {
  MetropolisMove move;
  if (!in.is_object_of({"max_step", "beta", "adapt"})) return move;
  in.read("max_step", move.max_step, steps);
  if (const auto beta = in.find("beta"); beta && beta->value() != "infinity") {
    if (beta->value().is_number()) {
      move.beta = beta->number(above(0, 1e300)).value_or(move.beta);
    } else {
      beta->fault("expected a number above 0 and at most 1e+300, or \"infinity\", found " +
                  described(beta->value()));
    }
  }
  if (const auto adapt = in.find("adapt")) move.adaptation = read_adaptation(*adapt);
  return move;
}

StopRule read_mean_height_stop(const Reader& in) {
  MeanHeightStop relative;
  if (!in.is_object_of({"eta", "change", "every_sweeps"})) return relative;
  const auto eta = in.find("eta"), change = in.find("change");
  if (eta) relative.eta = eta->number(strictly_between(0, 1)).value_or(relative.eta);
  in.read_whole("every_sweeps", relative.every_sweeps, 1, most_sweeps);
  if (!change) return relative;
  if (eta) in.fault("expected only one of the keys eta (relative), change (in diameters)");
  HeightChangeStop absolute{.every_sweeps = relative.every_sweeps};
  absolute.change = change->number(above(0, 1)).value_or(absolute.change);
  return absolute;
}

StopRule read_bulk_fraction_stop(const Reader& in) {
  BulkFractionStop stop;
  if (!in.is_object_of({"change", "every_trials", "times", "measure_start", "window"})) return stop;
  in.read("change", stop.change, between(0, 1));
  in.read_whole("every_trials", stop.every_trials, 1, most_trials);
  in.read_whole("times", stop.times, 1, 1000);
  in.read_flag("measure_start", stop.measure_start);
  if (const auto window = in.find("window")) stop.window = read_window(*window);
  return stop;
}

StopRule read_sweeps_stop(const Reader& in) {
  return SweepsStop{in.whole_number(1, most_sweeps).value_or(1)};
}

Json written_bulk_fraction_stop(const BulkFractionStop& stop) {
  return {{"change", plain_number(stop.change)},
          {"every_trials", stop.every_trials},
          {"times", stop.times},
          {"measure_start", stop.measure_start},
          {"window", written(stop.window)}};
}

constexpr Kinds<StopRule> stops{
    {"mean_height", read_mean_height_stop,
     [](const MeanHeightStop& stop) -> Json {
       return {{"eta", plain_number(stop.eta)}, {"every_sweeps", stop.every_sweeps}};
     }},
    {"bulk_fraction", read_bulk_fraction_stop, written_bulk_fraction_stop},
    {"sweeps", read_sweeps_stop, [](const SweepsStop& stop) { return Json(stop.sweeps); }},
    {"mean_height", read_mean_height_stop, [](const HeightChangeStop& stop) -> Json {
       return {{"change", plain_number(stop.change)}, {"every_sweeps", stop.every_sweeps}};
     }}};

StopRule read_stop(const Reader& in) {
  const auto rule = in.choice(names_of(stops));
  if (!rule) return MeanHeightStop{};
  return read_kind(stops, *rule);
}

Json written_polar(const PolarMove& move) {
  return {{"max_step", plain_number(move.max_step)},
          {"theta0", plain_number(move.theta0)},
          {"law", name_in(theta_laws, move.law)}};
}

Json written_metropolis(const MetropolisMove& move) {
  Json metropolis = {{"max_step", plain_number(move.max_step)}};
  metropolis["beta"] = std::isinf(move.beta) ? Json("infinity") : plain_number(move.beta);
  metropolis["adapt"] = "never";
  if (!move.adaptation) return metropolis;
  const StepAdaptation& adaptation = *move.adaptation;
  metropolis["adapt"] = {{"factor", plain_number(adaptation.factor)},
                         {"every_trials", adaptation.every_trials},
                         {"threshold", plain_number(adaptation.threshold)},
                         {"of", name_in(acceptance_bases, adaptation.base)},
                         {"reset_each_tap", adaptation.reset_each_tap}};
  return metropolis;
}

constexpr Kinds<Move> move_kinds{{"polar", read_polar, written_polar},
                                 {"metropolis", read_metropolis, written_metropolis}};

}  // namespace

Relaxation read_relaxation(const Reader& in) {
  Relaxation relaxation;
  std::vector<std::string> keys = names_of(move_kinds);
  keys.insert(keys.end(), {"stop", "max_sweeps", "sampler"});
  if (!in.is_object_of(keys)) return relaxation;
  std::size_t n_moves = 0;
  for (const std::string& name : names_of(move_kinds)) {
    const auto move = in.find(name);
    if (!move) continue;
    relaxation.move = read_kind(move_kinds, Choice{name, *move});
    ++n_moves;
  }
  if (n_moves > 1) in.fault("expected only one of the keys " + listed(names_of(move_kinds)));
  if (const auto stop = in.find("stop")) relaxation.stop.rule = read_stop(*stop);
  in.read_whole("max_sweeps", relaxation.stop.max_sweeps, 1, most_sweeps);
  in.read_name("sampler", relaxation.sampler, samplers);
  return relaxation;
}

Json written(const Relaxation& relaxation) {
  Json out = written_kind(move_kinds, relaxation.move);
  out["stop"] = written_kind(stops, relaxation.stop.rule);
  out["max_sweeps"] = relaxation.stop.max_sweeps;
  out["sampler"] = name_in(samplers, relaxation.sampler);
  return out;
}

}  // namespace jostle::inline config
