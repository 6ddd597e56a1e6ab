#include <fmt/format.h>

#include <algorithm>

#include "config/grids.hpp"
#include "config/names.hpp"
#include "config/parts.hpp"
#include "config/suggestion.hpp"

namespace jostle {

namespace {

constexpr std::uint64_t most_taps = 1'000'000'000;
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
    band->fault(fmt::format("the band from {} to {} is empty: the lowest frequency comes first",
                            *lowest, *highest));
  }
  settings.band = Band{*lowest, *highest};
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
    out["band"] = {plain_number(settings.band->lowest), plain_number(settings.band->highest)};
  }
  return out;
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

/// Notes analyses of what the scene does not observe, or of taps that it does not have.
class AnalysisCheck {
 public:
  AnalysisCheck(const Scene& scene, std::vector<Fault>& faults)
      : faults_(faults), taps_(total_taps(scene.protocol)) {
    for (const Observable& observable : scene.observables) observed_.push_back(name_of(observable));
  }

  template <class Settings>
  void operator()(const std::string& kind, const std::vector<AnalysisRequest<Settings>>& requests) {
    for (std::size_t i = 0; i < requests.size(); ++i) {
      const std::string place = fmt::format("/analyse/{}/{}", kind, i);
      const std::string& name = requests[i].observable;
      if (std::ranges::find(observed_, name) == observed_.end()) {
        note(place + "/observable", fmt::format("\"{}\" is not observed (observed: {}).{}", name,
                                                listed(observed_), did_you_mean(name, observed_)));
      }
      check(place, requests[i].settings);
    }
  }

 private:
  void check(const std::string& place, const SteadySettings& settings) {
    check_last(place, settings.last, SteadyStateTest::fewest_taps);
  }

  void check(const std::string& place, const SpectrumSettings& settings) {
    check_last(place, settings.last, fewest_spectrum_taps);
    const std::uint64_t analysed =
        settings.last.value_or(std::max(fewest_spectrum_taps, taps_ / 2));
    if (settings.segment && *settings.segment > analysed) {
      note(place + "/segment", fmt::format("{} taps are more than the {} that are analysed",
                                           *settings.segment, analysed));
    }
  }

  void check_last(const std::string& place, const std::optional<std::uint64_t>& last,
                  std::uint64_t least) {
    if (last && *last > taps_) {
      note(place + "/last", fmt::format("{} taps, but the protocol has {}", *last, taps_));
    } else if (taps_ < least) {
      note(place, fmt::format("needs {} taps, but the protocol has {}", least, taps_));
    }
  }

  void note(std::string pointer, std::string message) {
    faults_.push_back({std::move(pointer), std::move(message)});
  }

  std::vector<Fault>& faults_;
  std::vector<std::string> observed_;
  std::uint64_t taps_;
};

}  // namespace

Analyses read_analyses(const Reader& in) {
  Analyses analyses;
  if (!in.is_object_of({"steady", "spectrum"})) return analyses;
  read_requests(in, "steady", analyses.steady);
  read_requests(in, "spectrum", analyses.spectrum);
  return analyses;
}

Json written(const Analyses& analyses) {
  return {{"steady", written(analyses.steady)}, {"spectrum", written(analyses.spectrum)}};
}

void check_analyses(const Scene& scene, std::vector<Fault>& faults) {
  for (const char* part : {"/analyse", "/observe", "/protocol"}) {
    if (!sound(faults, part)) return;
  }
  AnalysisCheck check(scene, faults);
  check("steady", scene.analyse.steady);
  check("spectrum", scene.analyse.spectrum);
}

}  // namespace jostle
