#include "results/content/study.hpp"

#include <fmt/format.h>
#include <hdf5.h>
#include <openssl/crypto.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <fstream>

#include "engine/bed/boundary.hpp"
#include "results/disk/checksum.hpp"

namespace jostle::inline results {
namespace {

/// The scene names a file only by its path: what it held when the run began is known by this.
std::string sum_of_given(const Start& start) {
  const auto* given = std::get_if<GivenPacking>(&start);
  if (given == nullptr) return "";
  Sha256 sum;
  sum.add(std::as_bytes(std::span(*given->centres)));
  if (given->sizes) {
    sum.add(std::as_bytes(std::span(given->sizes->radii())));
    sum.add(std::as_bytes(std::span(given->sizes->kind_of())));
  }
  return hex(sum.finish());
}

/// Kinds and diameters as the first realization has them; drawn ones are left to each.
std::shared_ptr<const PointSpheres> mixture_of(const Plan& plan) {
  const auto sizes = sizes_of(plan, 0);
  if (!sizes) return nullptr;
  return std::make_shared<const PointSpheres>(
      PointSpheres{sizes->kinds(), sizes->kind_of(),
                   has_drawn_sizes(plan) ? std::vector<double>{} : diameters_of(*sizes)});
}

StudyPoint make_point(const Plan& plan) {
  StudyPoint point{.label = plan.label,
                   .sweep_values = plan.sweep_values,
                   .id = plan.point_id,
                   .seed = plan.seed,
                   .container = plan.container,
                   .n_spheres = plan.n_spheres,
                   .mixture = mixture_of(plan),
                   .taps = total_taps(plan),
                   .observables = {},
                   .diagnostics = {},
                   .unit = unit_name(plan.engine),
                   .snapshots = plan.snapshots,
                   .motion = plan.motion,
                   .start_sum = sum_of_given(plan.start)};
  const Spheres spheres = point.mixture ? Spheres::several_sizes : Spheres::equal;
  point.diagnostics = columns(plan.engine, spheres);
  for (const Observable& observable : plan.observables)
    point.observables.push_back(label(observable, spheres));
  return point;
}

/// Has the last point share the spheres of an earlier one that has the same.
void share_spheres(std::vector<StudyPoint>& points) {
  StudyPoint& last = points.back();
  if (!last.mixture) return;
  for (const StudyPoint& earlier : std::span(points).first(points.size() - 1)) {
    if (!earlier.mixture || *earlier.mixture != *last.mixture) continue;
    last.mixture = earlier.mixture;
    return;
  }
}

/// Bins of n(z) up to the top of a bed that is looser than any that settles.
std::uint64_t histogram_bins(const StudyPoint& point) {
  constexpr double loose_fraction = 0.4;
  const Boundary boundary(point.container);
  const double volume = sphere_volume * point.n_spheres / loose_fraction;
  const double depth =
      boundary.periodic_z ? boundary.height : volume / footprint_area(point.container) + 2;
  return static_cast<std::uint64_t>(depth / point.snapshots.bin_width) + 1;
}

std::uint64_t bytes_of_realization(const StudyPoint& point) {
  const std::uint64_t positions = point.n_spheres * sizeof(Vec3);
  constexpr std::uint64_t contacts_a_sphere = 3;  // isostatic without friction; fewer with it
  const Snapshots& kept = point.snapshots;
  constexpr std::uint64_t driven = 3 * 8;  // profiles of a bed that is thrown eight times as high
  const std::uint64_t profiles = std::uint64_t{kept.height_histogram} +
                                 2 * kept.granular_temperature + driven * kept.driven_temperature;
  const std::uint64_t a_snapshot =
      (kept.positions ? positions : 0) + (kept.velocities ? 2 * positions : 0) +
      (kept.contacts ? contacts_a_sphere * point.n_spheres * sizeof(Contact) : 0) +
      (profiles > 0 ? profiles * histogram_bins(point) * sizeof(double) : 0) + 512;
  return (point.taps + 1) * point.n_columns() * sizeof(double) +
         point.snapshots.taps.size() * a_snapshot + positions + 4096 +
         (point.mixture && point.mixture->drawn() ? 2 * sizeof(double) * point.n_spheres : 0) +
         (point.motion ? 2 * motion_bytes(*point.motion, point.n_spheres) : 0);
}

std::string processor_model() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown";
}

std::string hdf5_version() {
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  return fmt::format("{}.{}.{}", major, minor, release);
}

std::string utc_now() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc{};
  ::gmtime_r(&now, &utc);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", utc.tm_year + 1900, utc.tm_mon + 1,
                     utc.tm_mday, utc.tm_hour, utc.tm_min, utc.tm_sec);
}

}  // namespace

std::vector<std::string> PointSpheres::names_of_kinds() const {
  std::vector<std::string> names;
  for (const SphereKind& kind : kinds) names.push_back(kind.name);
  return names;
}

std::shared_ptr<const Sizes> PointSpheres::sizes(const std::vector<double>& of_realization) const {
  return std::make_shared<const Sizes>(drawn() ? of_realization : diameters, kind_of, kinds);
}

std::vector<Column> StudyPoint::columns() const {
  std::vector<Column> all = observables;
  all.insert(all.end(), diagnostics.begin(), diagnostics.end());
  return all;
}

std::string common_unit(const Study& study) {
  if (study.points.empty()) return "trials";
  const std::string& unit = study.points.front().unit;
  const bool one_engine = std::ranges::all_of(
      study.points, [&](const StudyPoint& point) { return point.unit == unit; });
  return one_engine ? unit : "";
}

Study make_study(std::span<const Plan> plans, std::string scene, std::string resolved_scene,
                 std::uint32_t realizations) {
  Study study{std::move(scene), std::move(resolved_scene), realizations, {}};
  for (const Plan& plan : plans) {
    study.points.push_back(make_point(plan));
    share_spheres(study.points);
  }
  return study;
}

PointNumbers::PointNumbers(const Study& study) {
  for (std::uint32_t p = 0; p < study.points.size(); ++p) numbers_.emplace(study.points[p].id, p);
}

std::optional<std::uint32_t> PointNumbers::find(std::uint64_t id) const {
  const auto found = numbers_.find(id);
  if (found == numbers_.end()) return std::nullopt;
  return found->second;
}

std::optional<std::uint32_t> other_start(const Study& a, const Study& b) {
  const PointNumbers numbers(b);
  for (std::uint32_t p = 0; p < a.points.size(); ++p) {
    const auto twin = numbers.find(a.points[p].id);
    if (!twin) continue;
    const std::string &own_sum = a.points[p].start_sum, &twin_sum = b.points[*twin].start_sum;
    if (!own_sum.empty() && !twin_sum.empty() && own_sum != twin_sum) return p;
  }
  return std::nullopt;
}

bool in_share(const Shard& shard, const Study& study, RealizationId id) {
  const std::uint64_t place = std::uint64_t{id.realization} * study.points.size() + id.point;
  return place % shard.count + 1 == shard.index;
}

std::vector<RealizationId> realizations_of(const Study& study, const Shard& shard) {
  std::vector<RealizationId> ids;
  for (std::uint32_t r = 0; r < study.realizations; ++r)
    for (std::uint32_t p = 0; p < study.points.size(); ++p)
      if (in_share(shard, study, {p, r})) ids.push_back({p, r});
  return ids;
}

std::uint64_t disk_estimate(const Study& study, const Shard& shard) {
  std::uint64_t bytes = 1 << 20;
  for (const StudyPoint& point : study.points) {
    const std::uint64_t ensemble = (point.taps + 1) * point.n_columns() * 28;
    bytes += ensemble + 65536;
  }
  for (const RealizationId id : realizations_of(study, shard))
    bytes += 2 * bytes_of_realization(study.points[id.point]);
  return bytes;
}

Provenance provenance_of_this_machine() {
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  Provenance provenance;
  provenance.libraries =
      fmt::format("HDF5 {}, {}", hdf5_version(), OpenSSL_version(OPENSSL_VERSION));
  provenance.host = host.data();
  provenance.cpu = processor_model();
  provenance.started = utc_now();
  return provenance;
}

}  // namespace jostle::inline results
