#include "results/export/extended_xyz.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "engine/bed/boundary.hpp"
#include "engine/bed/mixture.hpp"
#include "results/disk/error.hpp"
#include "results/disk/input_file.hpp"
#include "results/disk/printable.hpp"
#include "results/export/extended_xyz_header.hpp"
#include "results/export/packing_file.hpp"
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

/// The diameters and the kinds of the spheres of a mixture, as they are read.
class MixtureReader {
 public:
  explicit MixtureReader(const ExtendedXyzHeader& header)
      : header_(header), kinds_(header.kinds), diameters_(header.sizes.size()) {}

  void include(const std::vector<std::string>& words) {
    for (std::size_t k = 0; k < header_.sizes.size(); ++k) {
      const SizeColumns& column = header_.sizes[k];
      if (column.of_mixtures && column.n == 1)
        diameters_[k].push_back(finite_number(words[column.first]) * 2 * sphere_radius /
                                column.model);
    }
    kind_of_.push_back(header_.species ? kind_named(words[*header_.species]) : 0);
  }

  /// The sizes; null of equal spheres, whose columns are still to be compared with the model.
  std::shared_ptr<const Sizes> sizes(const std::vector<SizeRange>& ranges) {
    const auto first = first_column(ranges);
    if (!first) {
      if (!header_.kinds.empty())
        throw std::invalid_argument(
            "kinds names kinds of spheres, and no column radius or diameter gives their sizes; add "
            "one, or leave kinds out");
      return nullptr;
    }
    require_agreement(*first, ranges);
    if (kinds_.empty() || (header_.kinds.empty() && kinds_.size() == 1)) {
      kinds_ = {{"spheres", 1}};
      std::ranges::fill(kind_of_, 0u);
    }
    const auto fault = sizes_fault(diameters_[*first], kind_of_, kinds_);
    if (fault) throw std::invalid_argument(*fault + "; lengths must be in diameters");
    return std::make_shared<const Sizes>(diameters_[*first], kind_of_, kinds_);
  }

 private:
  std::uint32_t kind_named(const std::string& name) {
    const auto found = std::ranges::find(kinds_, name, &SphereKind::name);
    if (found != kinds_.end()) return static_cast<std::uint32_t>(found - kinds_.begin());
    if (!header_.kinds.empty())
      throw std::invalid_argument(
          fmt::format("the species {} is none of the kinds that the comment line names", name));
    if (kinds_.size() == most_kinds)
      throw std::invalid_argument(fmt::format("more than {} species of spheres", most_kinds));
    kinds_.push_back({name, 1});
    return static_cast<std::uint32_t>(kinds_.size() - 1);
  }

  /// The column that gives the sizes of a mixture. Sizes that are alike and not the model's are
  /// nearly always lengths in another unit: a mixture of them names its kinds.
  std::optional<std::size_t> first_column(const std::vector<SizeRange>& ranges) const {
    for (std::size_t k = 0; k < ranges.size(); ++k) {
      const bool several = !are_alike(ranges[k].least, ranges[k].most);
      if (!diameters_[k].empty() && (several || !header_.kinds.empty())) return k;
    }
    return std::nullopt;
  }

  void require_agreement(std::size_t first, const std::vector<SizeRange>& ranges) const {
    constexpr double rounding = 1e-6;
    for (std::size_t k = 0; k < header_.sizes.size(); ++k) {
      const SizeColumns& column = header_.sizes[k];
      if (diameters_[k].empty()) {
        require_model_size(column.name, ranges[k].least, ranges[k].most, column.model);
        continue;
      }
      for (std::size_t i = 0; i < diameters_[k].size(); ++i) {
        const double a = diameters_[first][i], b = diameters_[k][i];
        if (std::abs(a - b) > rounding * std::abs(a))
          throw std::invalid_argument(
              fmt::format("sphere {} has the diameter {} by {} and {} by {}; correct one of them",
                          i, a, header_.sizes[first].name, b, column.name));
      }
    }
  }

  const ExtendedXyzHeader& header_;
  std::vector<SphereKind> kinds_;
  std::vector<std::uint32_t> kind_of_;
  std::vector<std::vector<double>>
      diameters_;  // diameters of every column of sizes, [n_spheres] or empty
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
  MixtureReader mixture(header);
  packing = {header.container, {}};
  for (std::size_t i = 0; i < n_spheres; ++i) {
    const auto words = sphere_line(header, i, n_spheres);
    const std::size_t x = header.positions;
    const Vec3 read{coordinate(words[x]), coordinate(words[x + 1]), coordinate(words[x + 2])};
    packing.centres.push_back(into_periods(boundary, read - header.origin));
    for (std::size_t k = 0; k < sizes.size(); ++k) sizes[k].include(header.sizes[k], words);
    mixture.include(words);
  }
  packing.sizes = mixture.sizes(sizes);
  if (packing.sizes) {
    wrapped_inside(packing);
    return true;
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
