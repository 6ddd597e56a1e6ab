#include <fmt/format.h>

#include "config/grids.hpp"
#include "config/names.hpp"
#include "config/parts/parts.hpp"
#include "ensemble/statistics/finite_text.hpp"

namespace jostle::inline config {

namespace {

constexpr std::uint64_t shortest_segment = 16;

constexpr NameTable<Taper, 2> windows{{{"hann", Taper::hann}, {"boxcar", Taper::boxcar}}};
constexpr NameTable<Detrending, 3> detrendings{
    {{"mean", Detrending::mean}, {"linear", Detrending::linear}, {"none", Detrending::none}}};

void read_optional(const Reader& in, const char* key, std::uint64_t least,
                   std::optional<std::uint64_t>& into) {
  if (const auto member = in.find(key)) into = member->whole_number(least, most_taps);
}

void read_settings(const Reader& in, SteadySettings& settings) {
  read_optional(in, "last", SteadyStateTest::fewest_taps, settings.last);
}

void read_settings(const Reader& in, SpectrumSettings& settings) {
  read_optional(in, "last", fewest_spectrum_taps, settings.last);
  read_optional(in, "segment", shortest_segment, settings.segment);
  in.read_name("window", settings.window, windows);
  in.read_name("detrend", settings.detrending, detrendings);
  const auto band = in.find("band");
  if (!band || !band->is_list(2, 2, "frequencies, lowest and highest, in 1/taps")) return;
  const auto lowest = band->element(0).number({0, 0.5, true, false});
  const auto highest = band->element(1).number({0, 0.5, false, true});
  if (!lowest || !highest) return;
  if (*highest <= *lowest) {
    band->fault(finite_text("the band from {} to {} is empty: the lowest frequency comes first",
                            *lowest, *highest));
  }
  settings.band = Band{*lowest, *highest};
}

void read_settings(const Reader& in, AgeingSettings& settings) {
  if (const auto taps = in.find("waiting_times"))
    settings.waiting_times = chosen_taps(read_taps(*taps));
  if (const auto taps = in.find("lags")) settings.lags = chosen_taps(read_taps(*taps));
}

void read_settings(const Reader& in, HysteresisSettings& settings) {
  read_optional(in, "last", 1, settings.last);
}

void read_settings(const Reader& in, OrderingSettings& settings) {
  constexpr double any = 1e9;
  if (const auto threshold = in.find("threshold")) {
    settings.threshold = threshold->number(between(-any, any)).value_or(0);
  } else {
    in.missing("threshold", "the value of the observable at which a packing counts as ordered");
  }
  in.read_whole("hold", settings.hold, 1, most_taps);
  if (const auto name = in.find("equilibrium")) settings.equilibrium = name->text().value_or("");
  read_optional(in, "last", 1, settings.last);
}

void read_settings(const Reader& in, SweepSettings& settings) {
  if (const auto quantity = in.find("quantity")) settings.quantity = quantity->text().value_or("");
  read_optional(in, "last", 1, settings.last);
  if (const auto against = in.find("against")) settings.against = against->text().value_or("");
  if (const auto reference = in.find("reference"))
    settings.reference = reference->number(between(-1e9, 1e9));
}

void read_settings(const Reader& in, VolumesSettings& settings) {
  read_optional(in, "last", SteadyStateTest::fewest_taps, settings.last);
  if (const auto against = in.find("against")) settings.against = against->text().value_or("");
  if (const auto spheres = in.find("spheres")) settings.spheres = spheres->number(above(0, 1e9));
}

void read_settings(const Reader& in, MemorySettings& settings) {
  if (const auto taps = in.find("lags")) settings.lags = chosen_taps(read_taps(*taps));
}

const std::vector<std::string>& keys(const VolumesSettings&) {
  static const std::vector<std::string> names = {"observable", "last", "against", "spheres"};
  return names;
}

const std::vector<std::string>& keys(const MemorySettings&) {
  static const std::vector<std::string> names = {"observable", "lags"};
  return names;
}

const std::vector<std::string>& keys(const AgeingSettings&) {
  static const std::vector<std::string> names = {"observable", "waiting_times", "lags"};
  return names;
}

const std::vector<std::string>& keys(const HysteresisSettings&) {
  static const std::vector<std::string> names = {"observable", "last"};
  return names;
}

const std::vector<std::string>& keys(const OrderingSettings&) {
  static const std::vector<std::string> names = {"observable", "threshold", "hold", "equilibrium",
                                                 "last"};
  return names;
}

const std::vector<std::string>& keys(const SweepSettings&) {
  static const std::vector<std::string> names = {"observable", "quantity", "last", "against",
                                                 "reference"};
  return names;
}

const std::vector<std::string>& keys(const SteadySettings&) {
  static const std::vector<std::string> names = {"observable", "last"};
  return names;
}

const std::vector<std::string>& keys(const SpectrumSettings&) {
  static const std::vector<std::string> names = {"observable", "last",    "segment",
                                                 "window",     "detrend", "band"};
  return names;
}

template <class Settings>
void read_requests(const Reader& in, const std::string& kind,
                   std::vector<AnalysisRequest<Settings>>& requests) {
  const auto list = in.find(kind);
  if (!list || !list->is_list(0, 100, "analyses")) return;
  for (std::size_t i = 0; i < list->value().size(); ++i) {
    const Reader element = list->element(i);
    AnalysisRequest<Settings> request{};
    if (element.is_object_of(keys(request.settings))) {
      if (const auto observable = element.find("observable")) {
        request.observable = observable->text().value_or("");
      } else {
        element.missing("observable", "the name of an observable of this scene");
      }
      read_settings(element, request.settings);
    }
    requests.push_back(request);
  }
}

Json written(const SteadySettings& settings) {
  Json out = Json::object();
  if (settings.last) out["last"] = *settings.last;
  return out;
}

Json written(const SpectrumSettings& settings) {
  Json out = Json::object();
  if (settings.last) out["last"] = *settings.last;
  if (settings.segment) out["segment"] = *settings.segment;
  out["window"] = name_in(windows, settings.window);
  out["detrend"] = name_in(detrendings, settings.detrending);
  if (settings.band) {
    out["band"] = written_bounds(settings.band->lowest, settings.band->highest);
  }
  return out;
}

Json written(const AgeingSettings& settings) {
  return {{"waiting_times", settings.waiting_times}, {"lags", settings.lags}};
}

Json written(const HysteresisSettings& settings) {
  Json out = Json::object();
  if (settings.last) out["last"] = *settings.last;
  return out;
}

Json written(const OrderingSettings& settings) {
  Json out = {{"threshold", plain_number(settings.threshold)}, {"hold", settings.hold}};
  if (!settings.equilibrium.empty()) out["equilibrium"] = settings.equilibrium;
  if (settings.last) out["last"] = *settings.last;
  return out;
}

Json written(const SweepSettings& settings) {
  Json out = {{"quantity", settings.quantity}};
  if (settings.last) out["last"] = *settings.last;
  if (!settings.against.empty()) out["against"] = settings.against;
  if (settings.reference) out["reference"] = plain_number(*settings.reference);
  return out;
}

Json written(const VolumesSettings& settings) {
  Json out = Json::object();
  if (settings.last) out["last"] = *settings.last;
  if (!settings.against.empty()) out["against"] = settings.against;
  if (settings.spheres) out["spheres"] = plain_number(*settings.spheres);
  return out;
}

Json written(const MemorySettings& settings) {
  return {{"lags", settings.lags}};
}

template <class Settings>
Json written(const std::vector<AnalysisRequest<Settings>>& requests) {
  Json list = Json::array();
  for (const auto& request : requests) {
    Json out = {{"observable", request.observable}};
    out.update(written(request.settings));
    list.push_back(out);
  }
  return list;
}

}  // namespace

Analyses read_analyses(const Reader& in) {
  Analyses analyses;
  if (!in.is_object_of(
          {"steady", "spectrum", "ageing", "hysteresis", "ordering", "sweep", "volumes", "memory"}))
    return analyses;
  read_requests(in, "steady", analyses.steady);
  read_requests(in, "spectrum", analyses.spectrum);
  read_requests(in, "ageing", analyses.ageing);
  read_requests(in, "hysteresis", analyses.hysteresis);
  read_requests(in, "ordering", analyses.ordering);
  read_requests(in, "sweep", analyses.sweep);
  read_requests(in, "volumes", analyses.volumes);
  read_requests(in, "memory", analyses.memory);
  return analyses;
}

Json written(const Analyses& analyses) {
  Json out = {{"steady", written(analyses.steady)},
              {"spectrum", written(analyses.spectrum)},
              {"ageing", written(analyses.ageing)},
              {"hysteresis", written(analyses.hysteresis)},
              {"sweep", written(analyses.sweep)}};
  // Left out where there are none, so that runs of earlier versions can be resumed.
  if (!analyses.ordering.empty()) out["ordering"] = written(analyses.ordering);
  if (!analyses.volumes.empty()) out["volumes"] = written(analyses.volumes);
  if (!analyses.memory.empty()) out["memory"] = written(analyses.memory);
  return out;
}

}  // namespace jostle::inline config
