// A scene run into memory, by a sink of one's own: no results file. Its first observable is then
// analysed and fitted as `jostle analyse` and `jostle fit` would.
#include <cstdio>
#include <jostle/analyse.hpp>
#include <jostle/scene.hpp>
#include <jostle/sink.hpp>
#include <map>
#include <mutex>

/// Keeps the first observable of every realization, tap after tap.
class FirstObservable final : public jostle::Sink {
 public:
  using Series = std::vector<double>;  // [n_taps + 1]: tap 0 is the start

  std::optional<jostle::RealizationState> begin(jostle::RealizationId id) override {
    const std::lock_guard guard(mutex_);  // realizations come from several threads
    series_[id];
    return std::nullopt;  // every realization begins anew
  }
  void append(jostle::RealizationId id, const jostle::TapRow& row) override {
    const std::lock_guard guard(mutex_);
    series_[id].push_back(row.observables.at(0));
  }
  void snapshot(jostle::RealizationId, const jostle::SnapshotRecord&) override {}
  void checkpoint(jostle::RealizationId, const jostle::RealizationState&,
                  const jostle::Work&) override {}
  void end(jostle::RealizationId id, const jostle::RealizationState&,
           const jostle::Outcome& outcome) override {
    if (outcome.status == jostle::RealizationStatus::done) return;
    std::fprintf(stderr, "realization %u: %s\n", id.realization, outcome.reason.c_str());
    const std::lock_guard guard(mutex_);
    series_.erase(id);
  }

  /// Those of one sweep point, in the order of realizations.
  std::vector<Series> series_at(std::uint32_t point) const {
    std::vector<Series> all;
    for (const auto& [id, series] : series_) {
      if (id.point == point) all.push_back(series);
    }
    return all;
  }

 private:
  std::mutex mutex_;
  std::map<jostle::RealizationId, Series> series_;
};

/// Mean over realizations against taps, from tap 1 on, with the realizations behind it.
jostle::Curve curve_of(const std::vector<FirstObservable::Series>& realizations) {
  std::vector<double> taps, values;  // [n_taps], [n_taps, n_realizations]
  for (std::size_t tap = 1; tap < realizations.front().size(); ++tap) {
    taps.push_back(static_cast<double>(tap));
    for (const auto& series : realizations) values.push_back(series[tap]);
  }
  return jostle::mean_curve(std::move(taps), std::move(values), realizations.size());
}

int main(int n_arguments, char** arguments) try {
  if (n_arguments != 2) return std::fprintf(stderr, "own_sink SCENE.json\n"), 2;
  const jostle::LoadedScene loaded = jostle::load_scene(arguments[1]);

  std::vector<jostle::RealizationId> all;
  for (std::uint32_t point = 0; point < loaded.plans.size(); ++point) {
    for (std::uint32_t r = 0; r < loaded.scene.realizations; ++r) all.push_back({point, r});
  }
  FirstObservable sink;
  jostle::Progress progress;  // may be read from another thread meanwhile
  jostle::run_ensemble(loaded.plans, all, {.threads = 2}, sink, progress);

  for (std::uint32_t point = 0; point < loaded.plans.size(); ++point) {
    const auto realizations = sink.series_at(point);
    if (realizations.empty()) continue;
    jostle::SteadyStateTest test;
    for (const auto& series : realizations) {
      test.add(std::span(series).last(jostle::SteadyStateTest::fewest_taps));
    }
    const jostle::SteadyState steady = test.result();
    std::printf("steady %.17g\n%s\n", steady.value, steady.statement().c_str());

    const auto models = jostle::models_named("inverse_log");
    for (const auto& outcome : jostle::fit_models(models, curve_of(realizations), {})) {
      if (const auto* refusal = std::get_if<jostle::Refusal>(&outcome.result)) {
        std::printf("%s\n", refusal->message.c_str());
        continue;
      }
      for (const auto& estimate : std::get<jostle::Fit>(outcome.result).estimates) {
        std::printf("%s %.17g\n", estimate.parameter.name.c_str(), estimate.value);
      }
    }
  }
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
