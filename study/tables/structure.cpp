#include "study/tables/structure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <tuple>

#include "config/json/json_text.hpp"
#include "config/scene.hpp"
#include "ensemble/analysis/structure_comparison.hpp"
#include "ensemble/analysis/structure_tables.hpp"
#include "ensemble/parallel.hpp"
#include "ensemble/statistics/finite_text.hpp"
#include "results/export/export.hpp"
#include "results/export/extended_xyz.hpp"
#include "results/export/packing_file.hpp"
#include "results/groups/layout.hpp"
#include "study/bad_input.hpp"
#include "study/tables/repeated_series.hpp"

namespace jostle::inline study {

namespace {

/// A kept packing, or none.
struct KeptPacking {
  std::uint64_t tap = 0;
  Packing packing;
};

/// The packings of one ensemble, read realization by realization.
struct KeptEnsemble {
  std::string name;    // for messages
  std::string copies;  // text of realizations left out because they repeat another
  std::vector<std::uint64_t> taps;
  std::uint32_t realizations = 0;
  std::function<std::vector<KeptPacking>(std::uint32_t realization)> read;  // one call at a time
  std::uint64_t seed = 0, sweep_point = 0;                                  // for random points
  std::vector<std::string> files = {};  // [realization], if each has one of its own

  /// For messages.
  std::string name_of(std::uint32_t realization) const {
    if (!files.empty()) return files[realization];
    return fmt::format("{}, realization {}", name, realization);
  }
};

/// Measures one packing after another, on many threads. Those of a realization are read together.
class Measurer {
 public:
  Measurer(const KeptEnsemble& ensemble, const StructureSettings& settings)
      : ensemble_(ensemble),
        settings_(settings),
        n_jobs_(ensemble.taps.size() * ensemble.realizations),
        failures_(n_jobs_) {
    structure_.taps = ensemble.taps;
    structure_.packings.assign(ensemble.taps.size(),
                               std::vector<std::vector<Measurement>>(ensemble.realizations));
  }

  EnsembleStructure measured(int threads) {
    on_threads(threads, [this] { work(); });
    for (const std::exception_ptr& failure : failures_) {
      if (failure) std::rethrow_exception(failure);
    }
    return std::move(structure_);
  }

 private:
  using Packings = std::vector<KeptPacking>;

  void work() {
    for (std::size_t job = next_++; job < n_jobs_; job = next_++) {
      try {
        measure_one(static_cast<std::uint32_t>(job / ensemble_.taps.size()),
                    job % ensemble_.taps.size());
      } catch (...) {
        failures_[job] = std::current_exception();
      }
    }
  }

  /// Jobs come in the order of realizations: the last one read is nearly always the next one
  /// needed.
  std::shared_ptr<const Packings> packings_of(std::uint32_t realization) {
    const std::lock_guard lock(reading_);
    if (!read_ || read_realization_ != realization) {
      read_ = std::make_shared<const Packings>(ensemble_.read(realization));
      read_realization_ = realization;
    }
    return read_;
  }

  void measure_one(std::uint32_t r, std::size_t place) {
    const std::uint64_t tap = ensemble_.taps[place];
    const auto packings = packings_of(r);
    const auto kept = std::ranges::find(*packings, tap, &KeptPacking::tap);
    if (kept == packings->end()) return;
    try {
      structure_.packings[place][r] =
          measure(wrapped_inside(kept->packing), settings_,
                  stream_key(ensemble_.seed, ensemble_.sweep_point, r, Purpose::void_points));
    } catch (const std::invalid_argument& error) {
      throw BadInput(fmt::format("{}, tap {}: {}", ensemble_.name_of(r), tap, error.what()));
    }
  }

  const KeptEnsemble& ensemble_;
  const StructureSettings& settings_;
  std::size_t n_jobs_;
  EnsembleStructure structure_;
  std::vector<std::exception_ptr> failures_;
  std::atomic<std::size_t> next_ = 0;
  std::mutex reading_;
  std::shared_ptr<const Packings> read_;
  std::uint32_t read_realization_ = 0;
};

/// Where a part of the structure was measured. Few parts count in the region.
std::string region_note(std::string_view part, const StructureSettings& settings) {
  if (part == "layers") return "all heights, from side to side";
  if (part == "pair_correlation") {
    return "of each packing: central spheres from side to side, at heights at least r_max above "
           "1/2 and below 2<Z>, or in the middle half of a lower bed; all of a fully periodic box";
  }
  if (part == "sides") {
    const auto& heights = settings.sides->heights;
    return heights ? finite_text("heights {:g} to {:g}", heights->low, heights->high)
                   : "of each packing: heights 2 to 0.8 of 2<Z>";
  }
  if (settings.region && part != "profile") return resolved(settings).at("region").dump();
  const std::string heights =
      settings.region
          ? finite_text("heights {:g} to {:g}", settings.region->low, settings.region->high)
          : "heights from 1 d to 10 d, but at most 2<Z> - 1 d, in each packing";
  return part == "profile" ? "phi_region: " + heights + ", from side to side"
                           : heights + ", at least 1 d from walls; all of a fully periodic box";
}

bool is_in_radii(std::string_view units) {
  return units == "R" || units == "1/R";
}

/// Terms of a table that its numbers are printed with.
void add_terms(Table& table) {
  const bool in_radii = std::ranges::any_of(
      table.quantities, [](const Quantity& quantity) { return is_in_radii(quantity.units); });
  if (!in_radii) return;
  table.notes.emplace_back("R", "radius of a sphere of diameter d = 1");
  if (!table.name.ends_with("profile")) return;
  table.notes.emplace_back(
      "slopes",
      "alpha: of a straight line through the smoothed profile; eq7_alpha: of eq. 7 of Philippe & "
      "Bideau 2001, fitted to the profile with its free surface");
}

/// Notes of the settings and the region that a part was measured with.
void add_settings(std::string_view part, const StructureSettings& settings, Table& table) {
  table.notes.emplace_back("settings", resolved(settings).at(std::string(part)).dump());
  table.notes.emplace_back("region", region_note(part, settings));
}

/// The tables, each with what it was measured with.
std::vector<Table> tables_of(const std::string& prefix, const EnsembleStructure& structure,
                             const StructureSettings& settings) {
  std::vector<Table> tables = structure_tables(prefix, structure, settings);
  for (Table& table : tables) {
    add_settings(table.name.substr(prefix.size()), settings, table);
    add_terms(table);
  }
  return tables;
}

[[noreturn]] void refuse_without_packings(const std::string& name) {
  throw BadInput(
      fmt::format("{}: no packings are kept: every realization failed, or the scene keeps none; it "
                  "keeps them with \"snapshots\": {{\"taps\": [...], \"keep\": [\"positions\"]}}",
                  name));
}

std::vector<Table> tables_without_packings(const std::string& prefix,
                                           const StructureSettings& settings) {
  std::vector<Table> tables;
  for (const std::string& part : parts_of(settings)) {
    tables.push_back({.name = prefix + part,
                      .notes = {{"refused", "no realization has a packing at this point"}}});
  }
  return tables;
}

/// The taps of the file that are named; all if none is named.
std::vector<std::uint64_t> chosen_taps(const std::string& name,
                                       const std::vector<std::uint64_t>& available,
                                       std::span<const std::uint64_t> named) {
  if (named.empty()) return available;
  std::vector<std::uint64_t> chosen(named.begin(), named.end());
  std::ranges::sort(chosen);
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  for (const std::uint64_t tap : chosen) {
    if (!std::ranges::binary_search(available, tap)) {
      throw BadInput(
          fmt::format("{}: no packing of tap {}; there are {}", name, tap, list_of(available)));
    }
  }
  return chosen;
}

std::vector<std::uint64_t> kept_taps(const ResultsFile& file, std::uint32_t point) {
  std::vector<std::uint64_t> taps;
  for (std::uint32_t r = 0; r < file.study().realizations; ++r) {
    for (const SnapshotRecord& snapshot : file.positions({point, r})) taps.push_back(snapshot.tap);
  }
  std::ranges::sort(taps);
  taps.erase(std::unique(taps.begin(), taps.end()), taps.end());
  return taps;
}

KeptEnsemble ensemble_at(const ResultsFile& file, std::uint32_t point) {
  const Repetitions repeated = repetitions(file, point);
  const Container& container = file.study().points[point].container;
  KeptEnsemble ensemble{.name = fmt::format("{}, sweep point {}", file.path(), point),
                        .copies = repeated.text,
                        .taps = kept_taps(file, point),
                        .realizations = file.study().realizations,
                        .read = {},
                        .seed = file.study().points[point].seed,
                        .sweep_point = file.study().points[point].id};
  ensemble.read = [&file, &container, point, left_out = repeated.realizations](std::uint32_t r) {
    std::vector<KeptPacking> packings;
    if (std::ranges::binary_search(left_out, r)) return packings;
    for (SnapshotRecord& snapshot : file.positions({point, r})) {
      packings.push_back(
          {snapshot.tap, {container, std::move(snapshot.centres), file.sizes({point, r})}});
    }
    return packings;
  };
  return ensemble;
}

/// Differences between the points. If the scene cannot be read, it is unknown whether realizations
/// are pairs, and there is no comparison.
std::vector<Table> comparisons_of(const ResultsFile& file, std::span<const ComparedPoint> numbers,
                                  const StructureSettings& settings) {
  const ParsedScene parsed = parse_scene(file.study().resolved_scene);
  if (!parsed.scene) return {};
  std::vector<Table> tables = comparison_tables(numbers, parsed.scene->streams);
  for (Table& table : tables)
    add_settings(table.name.substr(table.name.find('/') + 1), settings, table);
  return tables;
}

/// The kinds of a mixture in their order, or that there are none.
std::string kind_names(const Packing& packing) {
  if (!packing.sizes) return "equal spheres";
  std::vector<std::string> names;
  for (const SphereKind& kind : packing.sizes->kinds()) names.push_back('"' + kind.name + '"');
  return joined(names, ", ");
}

/// True if two packings have the same centres, in whichever order.
bool same_centres(const Packing& a, const Packing& b) {
  const auto sorted = [](std::vector<Vec3> centres) {
    std::ranges::sort(centres, {}, [](Vec3 r) { return std::tuple(r.z, r.y, r.x); });
    return centres;
  };
  return a.centres.size() == b.centres.size() && top_height(a) == top_height(b) &&
         sorted(a.centres) == sorted(b.centres);
}

/// True if two files hold the same packing as the same frame. Different realizations may start from
/// one packing: the first frame decides only where a file has no other.
bool share_a_frame(const std::vector<Packing>& a, const std::vector<Packing>& b) {
  const std::size_t n = std::min(a.size(), b.size());
  for (std::size_t k = n > 1 ? 1 : 0; k < n; ++k)
    if (same_centres(a[k], b[k])) return true;
  return false;
}

}  // namespace

std::vector<Table> structure_of(const ResultsFile& file, std::span<const std::uint32_t> points,
                                const StructureSettings& settings,
                                std::span<const std::uint64_t> taps, int threads) {
  std::vector<KeptEnsemble> ensembles;
  for (const std::uint32_t point : points) ensembles.push_back(ensemble_at(file, point));
  const auto is_empty = [](const KeptEnsemble& ensemble) { return ensemble.taps.empty(); };
  if (std::ranges::all_of(ensembles, is_empty)) refuse_without_packings(file.path());
  std::vector<Table> tables;
  std::vector<ComparedPoint> numbers;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::uint32_t point = points[k];
    const std::string& label = file.study().points[point].label;
    KeptEnsemble& ensemble = ensembles[k];
    const std::string prefix = point_name(point) + "/";
    std::vector<Table> of_point;
    if (is_empty(ensemble)) {
      of_point = tables_without_packings(prefix, settings);
    } else {
      ensemble.taps = chosen_taps(ensemble.name, ensemble.taps, taps);
      const EnsembleStructure structure = Measurer(ensemble, settings).measured(threads);
      of_point = tables_of(prefix, structure, settings);
      numbers.push_back(packing_numbers(label, point, structure));
    }
    for (Table& table : of_point) {
      if (!ensemble.copies.empty()) table.notes.emplace_back("copies", ensemble.copies);
      if (!label.empty()) table.notes.insert(table.notes.begin(), {"sweep_point", label});
      tables.push_back(std::move(table));
    }
  }
  for (Table& table : comparisons_of(file, numbers, settings)) tables.push_back(std::move(table));
  return tables;
}

std::vector<Table> structure_of(std::span<const std::string> files,
                                const StructureSettings& settings,
                                std::span<const std::uint64_t> frames, int threads) {
  std::vector<std::vector<Packing>> packings;
  std::size_t most = 0;
  for (const std::string& path : files) {
    packings.push_back(read_extended_xyz_frames(path));
    most = std::max(most, packings.back().size());
    for (const Packing& packing : packings.back()) {
      if (kind_names(packing) != kind_names(packings.front().front())) {
        throw BadInput(fmt::format(
            "{}: its kinds of spheres, {}, are not those of {}, {}: only packings of the same "
            "kinds, in one order, have a mean; name them by kinds=\"...\" in the comment line",
            path, kind_names(packing), files.front(), kind_names(packings.front().front())));
      }
      if (packing.container == packings.front().front().container) continue;
      throw BadInput(fmt::format(
          "{}: its container is not that of {}: only packings of one container have a mean", path,
          files.front()));
    }
    const auto twin = std::ranges::find_if(packings, [&](const std::vector<Packing>& candidate) {
      return &candidate == &packings.back() || share_a_frame(candidate, packings.back());
    });
    if (twin != packings.end() - 1) {
      throw BadInput(fmt::format("{}: the same packings as in {}, and not another realization",
                                 path, files[static_cast<std::size_t>(twin - packings.begin())]));
    }
  }
  KeptEnsemble ensemble{.name = joined({files.begin(), files.end()}, ", "),
                        .copies = {},
                        .taps = {},
                        .realizations = static_cast<std::uint32_t>(files.size()),
                        .read = {},
                        .seed = 1,
                        .files = {files.begin(), files.end()}};
  for (std::uint64_t frame = 0; frame < most; ++frame) ensemble.taps.push_back(frame);
  ensemble.taps = chosen_taps(ensemble.name, ensemble.taps, frames);
  ensemble.read = [&packings](std::uint32_t r) {
    std::vector<KeptPacking> kept;
    for (std::size_t k = 0; k < packings[r].size(); ++k) kept.push_back({k, packings[r][k]});
    return kept;
  };
  return tables_of("", Measurer(ensemble, settings).measured(threads), settings);
}

StructureSettings structure_asked_for(const ResultsFile& file) {
  const ParsedScene parsed = parse_scene(file.study().resolved_scene);
  return parsed.scene ? parsed.scene->structure : StructureSettings{};
}

}  // namespace jostle::inline study
