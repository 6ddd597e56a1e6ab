#include "results/export/extended_xyz.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "engine/bed/boundary.hpp"
#include "results/error.hpp"
#include "results/export/extended_xyz_header.hpp"
#include "results/export/input_file.hpp"
#include "results/export/particle_columns.hpp"
#include "results/export/printable.hpp"
#include "structure/order/neighbours.hpp"

namespace jostle::inline results {
namespace {

/// The sizes that were read in one column, from the least to the greatest.
struct SizeRange {
  double least = std::numeric_limits<double>::infinity(), most = -least;

  void include(const SizeColumns& columns, const std::vector<std::string>& words) {
    for (std::size_t k = columns.first; k < columns.first + columns.n; ++k) {
      const double read = finite_number(words[k]);
      const double size = columns.zero_means && read == 0 ? columns.model : read;
      least = std::min(least, size);
      most = std::max(most, size);
    }
  }
};

double coordinate(const std::string& word) {
  const double value = finite_number(word);
  if (std::abs(value) > double{most_spheres})
    throw std::invalid_argument(
        fmt::format("{} diameters are farther than {}", word, most_spheres));
  return value;
}

/// Reads frame after frame. Centres come from the corner of the container, inside its periods.
class FrameReader {
 public:
  explicit FrameReader(const std::string& path) : path_(path), file_(path) {}

  /// Reads the next frame; false at the end of the file.
  bool next(Packing& packing) {
    try {
      return read(packing);
    } catch (const std::invalid_argument& error) {
      throw ResultsError(path_, printable(fmt::format("line {}: {}", line_number_, error.what())));
    }
  }

 private:
  bool next_line(std::string& line) {
    ++line_number_;
    return file_.next_line(line);
  }
  bool read(Packing& packing);
  std::vector<std::string> sphere_line(const ExtendedXyzHeader& header, std::size_t i,
                                       std::size_t n_spheres);

  std::string path_;
  InputFile file_;
  std::size_t line_number_ = 0;
};

std::vector<std::string> FrameReader::sphere_line(const ExtendedXyzHeader& header, std::size_t i,
                                                  std::size_t n_spheres) {
  std::string line;
  if (!next_line(line))
    throw std::invalid_argument(fmt::format("the file ends after {} of {} spheres", i, n_spheres));
  auto words = words_of(line);
  if (words.size() != header.n_columns)
    throw std::invalid_argument(fmt::format("too {} columns: {} and not {}",
                                            words.size() < header.n_columns ? "few" : "many",
                                            words.size(), header.n_columns));
  return words;
}

bool FrameReader::read(Packing& packing) {
  std::string line;
  do {
    if (!next_line(line)) return false;
  } while (words_of(line).empty());
  const auto first_line = words_of(line);
  const std::size_t n_spheres = positive_count(first_line.front());
  if (first_line.size() > 1)
    throw std::invalid_argument(
        "a frame begins with its number of spheres, alone on the line; check the number of the "
        "frame before");
  if (!next_line(line)) throw std::invalid_argument("the file ends before the comment line");
  const ExtendedXyzHeader header = parse_extended_xyz_header(line);
  if (n_spheres > most_spheres)
    throw std::invalid_argument(
        fmt::format("{} spheres are more than {}", n_spheres, most_spheres));
  const Boundary boundary(header.container);
  std::vector<SizeRange> sizes(header.sizes.size());
  packing = {header.container, {}};
  for (std::size_t i = 0; i < n_spheres; ++i) {
    const auto words = sphere_line(header, i, n_spheres);
    const std::size_t x = header.positions;
    const Vec3 read{coordinate(words[x]), coordinate(words[x + 1]), coordinate(words[x + 2])};
    packing.centres.push_back(into_periods(boundary, read - header.origin));
    for (std::size_t k = 0; k < sizes.size(); ++k) sizes[k].include(header.sizes[k], words);
  }
  for (std::size_t k = 0; k < sizes.size(); ++k)
    require_model_size(header.sizes[k].name, sizes[k].least, sizes[k].most, header.sizes[k].model);
  require_diameters(wrapped_inside(packing));
  return true;
}

}  // namespace

Packing read_extended_xyz(const std::string& path, std::optional<std::uint64_t> frame) {
  FrameReader reader(path);
  Packing packing, wanted;
  std::uint64_t n = 0;
  for (; reader.next(packing); ++n) {  // to the end: every command reads and refuses alike
    if (!frame || *frame == n) wanted = packing;
  }
  if (n == 0) throw ResultsError(path, "is empty");
  if (frame && *frame >= n)
    throw ResultsError(path, fmt::format("has no frame {}: it has {}", *frame, n));
  return wanted;
}

std::vector<Packing> read_extended_xyz_frames(const std::string& path) {
  FrameReader reader(path);
  std::vector<Packing> frames;
  for (Packing packing; reader.next(packing);) frames.push_back(packing);
  if (frames.empty()) throw ResultsError(path, "is empty");
  return frames;
}

}  // namespace jostle::inline results
