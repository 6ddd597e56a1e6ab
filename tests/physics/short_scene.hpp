#pragma once

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/bed/geometry.hpp"
#include "ensemble/moments.hpp"
#include "ensemble/run.hpp"
#include "structure/measure.hpp"
#include "tests/config/scene_files.hpp"
#include "tests/ensemble/memory_sink.hpp"
#include "tests/monte_carlo_plan.hpp"

namespace jostle {

/// A shipped scene cut down to a test's means: `change` is merged into it (RFC 7386). Its sweep,
/// its analyses and structure, which may need more taps, are left out.
inline Plan short_plan(const std::string& scene, const nlohmann::json& change) {
  auto json = nlohmann::json::parse(text_of(shipped_scenes / scene));
  for (const char* key : {"sweep", "analyse", "fits", "structure"}) json.erase(key);
  json.merge_patch(change);
  return make_plans(scene_of(json.dump()), {}).at(0);
}

using Records = std::map<RealizationId, RecordedRealization>;

/// Runs realizations 0 .. n - 1 of a plan on two threads; every one must succeed.
inline Records run_records(const Plan& plan, std::uint32_t n) {
  std::vector<RealizationId> ids;
  for (std::uint32_t r = 0; r < n; ++r) ids.push_back({0, r});
  MemorySink sink;
  Progress progress;
  const RunSummary summary = run_ensemble({&plan, 1}, ids, {.threads = 2}, sink, progress);
  if (summary.done != n) throw std::runtime_error("a realization failed");
  const std::vector<Column> recorded = columns(plan.engine);
  const auto capped = std::ranges::find(recorded, "capped", &Column::name) - recorded.begin();
  for (const auto& [id, record] : sink.records()) {
    for (const TapRow& row : record.rows) {
      if (row.diagnostics.at(static_cast<std::size_t>(capped)) != 0)
        throw std::runtime_error("a relaxation met its cap");
    }
  }
  return sink.records();
}

/// The series of one observable, [realization][tap].
using Series = std::vector<std::vector<double>>;

inline Series series_of(const Plan& plan, const Records& records, const std::string& observable) {
  std::size_t column = plan.observables.size();
  for (std::size_t k = 0; k < plan.observables.size(); ++k) {
    if (label(plan.observables[k]).name == observable) column = k;
  }
  if (column == plan.observables.size()) throw std::runtime_error(observable + " is not observed");
  Series series;
  for (const auto& [id, record] : records) {
    std::vector<double>& values = series.emplace_back();
    for (const TapRow& row : record.rows) values.push_back(row.observables[column]);
  }
  return series;
}

inline Series run_series(const Plan& plan, std::uint32_t n, const std::string& observable) {
  return series_of(plan, run_records(plan, n), observable);
}

/// One number of the structure of every kept packing, [realization][kept tap].
inline Series structure_of(const Plan& plan, const Records& records,
                           const StructureSettings& settings, const std::string& name,
                           std::size_t place = 0) {
  Series series;
  for (const auto& [id, record] : records) {
    std::vector<double>& values = series.emplace_back();
    for (const SnapshotRecord& kept : record.snapshots) {
      Packing packing{plan.container, kept.centres};
      for (Vec3& r : packing.centres) {
        r = std::visit([&](const auto& box) { return wrapped(box, r); }, plan.container);
      }
      const auto parts =
          measure(packing, settings, stream_key(1, 0, id.realization, Purpose::void_points));
      values.push_back(parts.at(0).find(name)->value_at(place));
    }
  }
  return series;
}

/// Mean over realizations of the value at one tap less that at another, paired.
inline Moments change(const Series& series, std::size_t first, std::size_t last) {
  Moments moments;
  for (const auto& values : series) moments.add(values.at(last) - values.at(first));
  return moments;
}

}  // namespace jostle
