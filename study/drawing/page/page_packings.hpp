#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "config/json/json.hpp"
#include "results/file/results_file.hpp"

namespace jostle::inline study {

/// Kept packings as a page draws them, a list of objects: point, realization, tap, spheres, the
/// corners of what they are in, and a text in base64 for each of: `position`, 16 bits a coordinate
/// (little-endian, x, y, z of one sphere after another, 0 at the lower corner, 65535 at the upper);
/// `coordination`, a byte a sphere; where contacts are kept `force`, a byte a sphere, 255 for
/// `greatest_force`, m g: the sum of the normal forces on it; `structure`, a byte (0 disordered, 1
/// fcc, 2 hcp); `q6` and `local_fraction`, 255 a one. At most about `room` bytes of text: evenly
/// spread sweep points, taps and realizations, of each the first and the last. `left_out` describes
/// the omitted data. The columns are computed on so many threads.
Json page_packings(const ResultsFile& file, std::size_t room, int threads,
                   std::vector<std::string>& left_out);

}  // namespace jostle::inline study
