#include "study/drawing/page/page_packings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>

#include "ensemble/parallel.hpp"
#include "results/export/packing_file.hpp"
#include "results/export/particle_columns.hpp"
#include "study/drawing/drawn/drawn_results.hpp"
#include "study/drawing/drawn/thinning.hpp"
#include "study/drawing/page/page_json.hpp"

namespace jostle::inline study {
namespace {

/// Text of a sphere: 6 bytes of position and 5 of columns, in base64. A sphere of a mixture has
/// its radius (2 bytes), its kind and at most three columns.
constexpr double bytes_of_a_sphere = 11 * 4.0 / 3, bytes_of_a_mixed_sphere = 12 * 4.0 / 3;

struct KeptRealization {
  RealizationId id;
  std::vector<std::uint64_t> taps;  // with positions
};

/// Sweep points, and realizations of each, that are looked at.
constexpr std::size_t most_shown_points = 100, most_realizations = 20;

/// Realizations of a sweep point that keep positions.
struct KeptPoint {
  std::uint32_t n_spheres = 0;
  std::size_t n_available = 0;  // realizations that there are
  std::vector<KeptRealization> realizations;
};

KeptPoint kept_of(const ResultsFile& file, std::uint32_t point) {
  KeptPoint kept;
  const std::vector<std::uint32_t> available = realizations_with_taps(file, point);
  kept.n_available = available.size();
  for (const std::uint32_t r : spread(available, most_realizations)) {
    KeptRealization realization{{point, r}, {}};
    for (const SnapshotOutline& outline : file.realization(realization.id)->snapshots()) {
      if (outline.n_spheres[kept_positions] == 0) continue;
      realization.taps.push_back(outline.tap);
      kept.n_spheres = std::max(kept.n_spheres, outline.n_spheres[kept_positions]);
    }
    if (!realization.taps.empty()) kept.realizations.push_back(std::move(realization));
  }
  return kept;
}

struct ChosenPackings {
  std::vector<std::pair<RealizationId, std::uint64_t>> packings;
  std::size_t n_available = 0;
};

/// At most so many of the packings of these points: points first, then taps, then realizations.
ChosenPackings choose(std::vector<KeptPoint> points, std::size_t most) {
  ChosenPackings chosen;
  std::size_t most_taps = 0, realizations_of_a_point = 0;
  for (const KeptPoint& point : points) {
    realizations_of_a_point = std::max(realizations_of_a_point, point.realizations.size());
    for (const KeptRealization& realization : point.realizations) {
      chosen.n_available += realization.taps.size();
      most_taps = std::max(most_taps, realization.taps.size());
    }
  }
  if (most == 0 || chosen.n_available == 0) return chosen;
  points = spread(points, std::max<std::size_t>(1, most / std::min<std::size_t>(2, most_taps)));
  const std::size_t taps = std::clamp<std::size_t>(most / points.size(), 1, most_taps);
  const std::size_t realizations =
      std::clamp<std::size_t>(most / (points.size() * taps), 1, realizations_of_a_point);
  for (const KeptPoint& point : points) {
    for (const KeptRealization& realization : spread(point.realizations, realizations)) {
      for (const std::uint64_t tap : spread(realization.taps, taps))
        chosen.packings.push_back({realization.id, tap});
    }
  }
  return chosen;
}

Vec3 upper_corner(const Packing& packing) {
  Vec3 upper = extent(packing.container);
  if (!(upper.z > 0)) upper.z = std::max(1.0, surface_height(packing));
  return upper;
}

/// Adds a share of 1 as two bytes, the low one first.
void add_word(double share, std::vector<std::uint8_t>& bytes) {
  const auto word = static_cast<std::uint16_t>(std::lround(std::clamp(share, 0.0, 1.0) * 65535));
  bytes.push_back(static_cast<std::uint8_t>(word & 255));
  bytes.push_back(static_cast<std::uint8_t>(word >> 8));
}

std::string encoded_positions(const Packing& packing, const Vec3& upper) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(packing.centres.size() * 6);
  for (const Vec3& r : packing.centres) {
    add_word(r.x / upper.x, bytes);
    add_word(r.y / upper.y, bytes);
    add_word(r.z / upper.z, bytes);
  }
  return base64(bytes);
}

std::string encoded(const std::vector<ParticleColumn>& columns, const char* name,
                    double (*drawn)(double)) {
  std::vector<std::uint8_t> bytes;
  for (const ParticleColumn& column : columns) {
    if (column.name != name) continue;
    std::visit(
        [&](const auto& values) {
          for (const auto value : values) {
            const double share = drawn(static_cast<double>(value));
            bytes.push_back(static_cast<std::uint8_t>(std::lround(std::clamp(share, 0.0, 255.0))));
          }
        },
        column.values);
  }
  return base64(bytes);
}

/// The volume of each sphere over that of its cell.
std::string encoded_fractions(const Packing& packing, const std::vector<ParticleColumn>& columns) {
  std::vector<std::uint8_t> bytes;
  for (const ParticleColumn& column : columns) {
    if (column.name != "voronoi_volume") continue;
    const auto& volumes = std::get<std::vector<double>>(column.values);
    for (std::size_t i = 0; i < volumes.size(); ++i) {
      const double diameter = 2 * packing.radius(i);
      const double sphere = sphere_volume * (diameter * diameter * diameter);
      const double share = volumes[i] > 0 ? std::min(sphere / volumes[i], 1.0) : 0;
      bytes.push_back(static_cast<std::uint8_t>(std::lround(255 * share)));
    }
  }
  return base64(bytes);
}

/// The sum of the normal forces on each sphere, m g; of the floor and the sides too.
std::vector<double> forces_on(std::size_t n_spheres, const std::vector<Contact>& contacts) {
  std::vector<double> forces(n_spheres);
  for (const Contact& contact : contacts) {
    for (const std::uint32_t sphere : {contact.first, contact.second}) {
      if (sphere < n_spheres) forces[sphere] += contact.normal_force;  // others are walls
    }
  }
  return forces;
}

void add_forces(Json& json, std::size_t n_spheres, const std::vector<Contact>& contacts) {
  if (contacts.empty() || n_spheres == 0) return;
  const std::vector<double> forces = forces_on(n_spheres, contacts);
  const double greatest = std::ranges::max(forces);
  if (!(greatest > 0) || !std::isfinite(greatest)) return;
  std::vector<std::uint8_t> bytes;
  for (const double force : forces) {
    const double share = std::clamp(force / greatest, 0.0, 1.0);
    bytes.push_back(static_cast<std::uint8_t>(std::lround(255 * share)));
  }
  json["force"] = base64(bytes);
  json["greatest_force"] = page_number(greatest);
}

/// The radius and the kind of each sphere of a mixture.
void add_sizes(Json& json, const Sizes& sizes) {
  std::vector<std::uint8_t> radii, kinds;
  radii.reserve(2 * sizes.size());
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    add_word(sizes.radius(i) / sizes.largest_radius(), radii);
    kinds.push_back(static_cast<std::uint8_t>(std::min(sizes.kind(i), 255U)));
  }
  json["radius"] = base64(radii);
  json["least_radius"] = page_number(sizes.smallest_radius());
  json["greatest_radius"] = page_number(sizes.largest_radius());
  json["kind"] = base64(kinds);
  json["kinds"] = Json::array();
  for (const SphereKind& kind : sizes.kinds()) json["kinds"].push_back(page_text(kind.name));
}

Json page_packing(RealizationId id, std::uint64_t tap, const Packing& packing,
                  const std::vector<Contact>& contacts) {
  const Vec3 upper = upper_corner(packing);
  Json json{{"point", id.point},
            {"realization", id.realization},
            {"tap", tap},
            {"spheres", packing.centres.size()},
            {"lower", Json::array({0, 0, 0})},
            {"upper", page_numbers(std::vector{upper.x, upper.y, upper.z})}};
  if (packing.sizes) add_sizes(json, *packing.sizes);
  try {
    const Packing inside = wrapped_inside(packing);
    const std::vector<ParticleColumn> columns = particle_columns(packing);
    json["position"] = encoded_positions(inside, upper);
    const auto as_it_is = [](double value) { return value; };
    json["coordination"] = encoded(columns, "coordination", as_it_is);
    if (!packing.sizes) json["structure"] = encoded(columns, "structure_type", as_it_is);
    if (!packing.sizes) json["q6"] = encoded(columns, "q6", [](double q6) { return 255 * q6; });
    json["local_fraction"] = encoded_fractions(packing, columns);
  } catch (const std::invalid_argument&) {  // a centre outside, of another program
    json["position"] = encoded_positions(packing, upper);
  }
  add_forces(json, packing.centres.size(), contacts);
  return json;
}

}  // namespace

Json page_packings(const ResultsFile& file, std::size_t room, int threads,
                   std::vector<std::string>& left_out) {
  std::vector<KeptPoint> points;
  std::uint32_t largest = 0;
  std::size_t most_there = 0;
  const std::size_t n_points = file.study().points.size();
  bool has_mixtures = false;
  for (const std::size_t point : evenly_spread(n_points, most_shown_points)) {
    has_mixtures = has_mixtures || file.study().points[point].mixture != nullptr;
    KeptPoint kept = kept_of(file, static_cast<std::uint32_t>(point));
    if (kept.realizations.empty()) continue;
    largest = std::max(largest, kept.n_spheres);
    most_there = std::max(most_there, kept.n_available);
    points.push_back(std::move(kept));
  }
  if (points.empty()) return Json::array();
  const double bytes = has_mixtures ? bytes_of_a_mixed_sphere : bytes_of_a_sphere;
  const auto most =
      static_cast<std::size_t>(static_cast<double>(room) / (bytes * std::max(1u, largest) + 200));
  const ChosenPackings chosen = choose(std::move(points), most);
  if (most == 0) {
    left_out.push_back(fmt::format(
        "no packing is drawn: one of {} spheres alone takes more room than a page has", largest));
  } else if (chosen.packings.size() < chosen.n_available) {
    left_out.push_back(
        fmt::format("{} of {} kept packings are drawn: evenly spread over sweep "
                    "points, taps and realizations",
                    chosen.packings.size(), chosen.n_available));
  }
  if (n_points > most_shown_points || most_there > most_realizations) {
    left_out.push_back(
        fmt::format("packings are those of at most {} sweep points and {} realizations of each",
                    most_shown_points, most_realizations));
  }
  std::vector<Packing> packings;
  std::vector<std::vector<Contact>> contacts;
  for (const auto& [id, tap] : chosen.packings) {
    const auto realization = file.realization(id);
    packings.push_back({file.study().points[id.point].container,
                        realization->vectors(tap, kept_positions), file.sizes(id)});
    contacts.push_back(file.study().points[id.point].snapshots.contacts ? realization->contacts(tap)
                                                                        : std::vector<Contact>{});
  }
  std::vector<Json> made(packings.size());
  std::atomic<std::size_t> next = 0;
  std::vector<std::exception_ptr> failures(packings.size());
  on_threads(threads, [&] {
    for (std::size_t i = next++; i < packings.size(); i = next++) {
      try {
        made[i] = page_packing(chosen.packings[i].first, chosen.packings[i].second, packings[i],
                               contacts[i]);
      } catch (...) {
        failures[i] = std::current_exception();
      }
    }
  });
  for (const std::exception_ptr& failure : failures) {
    if (failure) std::rethrow_exception(failure);
  }
  return made;
}

}  // namespace jostle::inline study
