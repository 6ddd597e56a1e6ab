#include "study/tables/points/same_realizations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "config/json/json_text.hpp"
#include "study/bad_input.hpp"
#include "study/tables/points/point_scenes.hpp"

namespace jostle::inline study {
namespace {

/// Taps of one kind, one after another: `count` of them; or a ramp, which counts once.
struct TapLine {
  std::string tap;
  std::uint64_t count = 0;
};

/// A sweep point of a file, with what decides its realizations.
struct Ensemble {
  std::size_t file = 0;
  std::uint32_t point = 0;
  std::vector<TapLine> taps;
};

/// Everything but the taps: random numbers, container, start, relaxation.
using Physics = std::tuple<std::uint64_t, std::uint64_t, std::string>;

std::vector<TapLine> tap_lines(const Json& protocol) {
  std::vector<TapLine> lines;
  for (const Json& line : protocol.elements()) {
    if (const Json* const ramp = line.find("ramp")) {
      lines.push_back({canonical_text(*ramp) + canonical_text(line.at("count")), 1});
      continue;
    }
    const std::uint64_t count = line.at("count").whole_number();
    const std::string tap = canonical_text(line.at("tap"));
    if (!lines.empty() && lines.back().tap == tap)
      lines.back().count += count;
    else
      lines.push_back({tap, count});
  }
  return lines;
}

/// True if one sequence of taps begins with all of the other.
bool same_as_far_as_both_go(const std::vector<TapLine>& a, const std::vector<TapLine>& b) {
  const std::size_t n = std::min(a.size(), b.size());
  for (std::size_t i = 0; i < n; ++i) {
    if (a[i].tap != b[i].tap) return false;
    if (a[i].count == b[i].count) continue;
    const auto& shorter = a[i].count < b[i].count ? a : b;
    return i + 1 == shorter.size();
  }
  return true;
}

Physics physics_of(const StudyPoint& studied, const Json& scene, Streams streams) {
  std::string text;
  for (const char* key : {"container", "spheres", "start", "engine", "relax", "relax_start"}) {
    const Json* part = scene.find(key);
    if (std::string_view(key) == "start" && !studied.start_sum.empty())
      text += studied.start_sum;  // the packing, independent of its file's place
    else
      text += part != nullptr ? canonical_text(*part) : "";
    text += '\n';
  }
  return {studied.seed, streams == Streams::matched ? 0 : studied.id, text};
}

std::vector<std::uint32_t> begun(const ResultsFile& file, std::uint32_t point) {
  std::vector<std::uint32_t> numbers;
  for (const RealizationSummary& realization : file.realizations_at(point))
    if (realization.rows > 0) numbers.push_back(realization.id.realization);
  std::ranges::sort(numbers);
  return numbers;
}

[[noreturn]] void refuse(std::span<const ResultsFile* const> files, const Ensemble& a,
                         const Ensemble& b) {
  const auto first = begun(*files[a.file], a.point), second = begun(*files[b.file], b.point);
  std::vector<std::uint32_t> shared;
  std::ranges::set_intersection(first, second, std::back_inserter(shared));
  const std::string place_text =
      fmt::format("{}, sweep point {}, and {}, sweep point {}", files[a.file]->path(), a.point,
                  files[b.file]->path(), b.point);
  if (shared.empty())
    throw BadInput(
        fmt::format("{}, hold realizations of one ensemble: join the files with jostle merge first",
                    place_text));
  throw BadInput(fmt::format(
      "{}, hold the same {} realizations (one scene, one seed), which count once: leave "
      "one of the files out, or run one of them with another seed",
      place_text, shared.size()));
}

}  // namespace

void require_different_ensembles(std::span<const ResultsFile* const> files) {
  std::map<Physics, std::vector<Ensemble>> seen;
  for (std::size_t k = 0; k < files.size(); ++k) {
    const Study& study = files[k]->study();
    const PointScenes scenes(*files[k]);
    for (std::uint32_t point = 0; point < study.points.size(); ++point) {
      const Json scene = resolved(scenes.point_scene(point));
      Ensemble ensemble{k, point, tap_lines(scene.at("protocol"))};
      auto& ensembles =
          seen[physics_of(study.points[point], scene, scenes.point_scene(point).streams)];
      for (const Ensemble& earlier : ensembles)
        if (earlier.file != k && same_as_far_as_both_go(earlier.taps, ensemble.taps))
          refuse(files, earlier, ensemble);
      ensembles.push_back(std::move(ensemble));
    }
  }
}

Streams streams_of(std::vector<RandomKey> keys) {
  const std::size_t n_points = keys.size();
  std::ranges::sort(keys);
  const auto repeated = std::ranges::unique(keys);
  const std::size_t n = n_points - repeated.size();
  if (n == 1) return Streams::matched;
  if (n == n_points) return Streams::independent;
  throw BadInput(fmt::format(
      "some of the {} points share starts and random numbers (one seed, matched streams), others "
      "do not: the points are neither paired nor independent. Analyse files of one seed together, "
      "and those of another by themselves",
      n_points));
}

}  // namespace jostle::inline study
