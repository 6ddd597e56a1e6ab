#pragma once

#include <string>
#include <utility>
#include <vector>

#include "config/json/json_text.hpp"
#include "config/scene.hpp"

namespace jostle::inline config {

/// One point of a sweep: the values it sets, and the index of each in its axis.
struct SweepPoint {
  std::vector<std::pair<std::string, Json>> values;  // pointer, value; in the order of the axes
  std::vector<std::size_t> indices;                  // [n_axes]
};

/// Every point, first axis slowest; without a sweep the one point that sets nothing.
std::vector<SweepPoint> sweep_points(const std::vector<SweepAxis>& sweep);

/// The point's identity: 0 for a point that sets nothing, else FNV-1a (64 bits, offset
/// 0xcbf29ce484222325, prime 0x100000001b3) over the bytes of the texts `pointer=value\n`, one for
/// every pair, value in canonical_text, the texts sorted bytewise; 1 in place of a 0. It therefore
/// depends on neither the order of axes nor other points.
std::uint64_t point_id(const SweepPoint& point);

/// "/protocol/0/tap/dilate" -> "dilate"; of an element of a list with the list's name: "width/1".
std::string short_name(const std::string& pointer);

/// "dilate = 0.02, spheres = 512": for people.
std::string point_label(const SweepPoint& point);

/// The scene of every point, none of which has a sweep, in their order; of a scene without a sweep
/// itself. Notes every fault of the sweep: pointers that lead nowhere, points that are no scenes,
/// equal points. `written_sweep` is the sweep as the file has it, `faults` what was found before. A
/// fault of a swept value points to where the sweep lists it; one that several points have is noted
/// once.
std::vector<Scene> read_sweep_points(const Scene& scene, const Json& written_sweep,
                                     std::vector<Fault>& faults);

}  // namespace jostle::inline config
