#include "results/export/extended_xyz.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <sstream>
#include <vector>

#include "results/error.hpp"
#include "results/export/container_text.hpp"
#include "results/export/input_file.hpp"
#include "results/export/printable.hpp"

namespace jostle::inline results {
namespace {

// As in scenes; a column of all spheres is as high as they are many.
constexpr std::size_t most_columns = 1000;

using Keys = std::map<std::string, std::string>;

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

/// key=value pairs; a value with blanks stands in double quotes.
Keys parse_comment(const std::string& line) {
  Keys keys;
  std::size_t i = 0;
  while (i < line.size()) {
    const std::size_t equals = line.find('=', i);
    if (equals == std::string::npos) break;
    const auto before = words_of(line.substr(i, equals - i));
    const bool quoted = equals + 1 < line.size() && line[equals + 1] == '"';
    const std::size_t first = equals + (quoted ? 2 : 1);
    const std::size_t end =
        std::min(line.find_first_of(quoted ? "\"" : " \t\r", first), line.size());
    if (!before.empty()) keys[before.back()] = line.substr(first, end - first);
    i = end + 1;
  }
  return keys;
}

/// Where the positions stand in the lines of the spheres.
struct Columns {
  std::size_t positions = 1, least = 4, most = std::string::npos;
};

class FrameReader {
 public:
  explicit FrameReader(const std::string& path) : path_(path), file_(path) {}

  /// Reads the next frame; false at the end of the file.
  bool next(Packing& packing);

 private:
  bool next_line(std::string& line);
  [[noreturn]] void fail(const std::string& what) const {
    throw ResultsError(path_, printable(fmt::format("line {}: {}", line_number_, what)));
  }
  double number(const std::string& word) const;
  double coordinate(const std::string& word) const;
  std::size_t count(const std::string& word) const;
  Container container(const Keys& keys) const;
  Columns columns(const Keys& keys) const;

  std::string path_;
  InputFile file_;
  std::size_t line_number_ = 0;
};

bool FrameReader::next_line(std::string& line) {
  ++line_number_;
  return file_.next_line(line);
}

double FrameReader::number(const std::string& word) const {
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
    fail("\"" + word + "\" is not a finite number");
  return value;
}

double FrameReader::coordinate(const std::string& word) const {
  const double value = number(word);
  if (std::abs(value) > double{most_spheres})
    fail(fmt::format("{} diameters are farther than {}", word, most_spheres));
  return value;
}

std::size_t FrameReader::count(const std::string& word) const {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || value == 0)
    fail("\"" + word + "\" is not a count");
  return value;
}

Container FrameReader::container(const Keys& keys) const {
  const auto lattice = keys.find("Lattice");
  if (lattice == keys.end()) fail("no Lattice=\"...\": the container's widths are not known");
  const auto words = words_of(lattice->second);
  if (words.size() != 9) fail("Lattice has not 9 numbers");
  for (std::size_t k = 0; k < 9; ++k)
    if (k % 4 != 0 && number(words[k]) != 0)
      fail("Lattice is not a right-angled box along x, y, z");
  const std::array<double, 3> widths = {number(words[0]), number(words[4]), number(words[8])};
  std::string kind;
  if (const auto named = keys.find("container"); named != keys.end()) {
    kind = named->second;
  } else if (const auto pbc = keys.find("pbc"); pbc != keys.end()) {
    if (pbc->second == "T T F") kind = "periodic";
    if (pbc->second == "T T T") kind = "fully_periodic";
    if (pbc->second == "F F F") kind = "walls";
  }
  const auto made = container_from(kind, widths);
  for (std::size_t k = 0; k < (kind == "fully_periodic" ? 3U : 2U); ++k)
    if (!(widths[k] > 0) || widths[k] > widest_container)
      fail(fmt::format("the sides of Lattice must be above 0 and at most {} diameters, not {}",
                       widest_container, widths[k]));
  if (!made)
    fail(
        "neither container=periodic|walls|cylinder|fully_periodic nor pbc=\"T T F\", \"T T T\" "
        "or \"F F F\"");
  return *made;
}

/// By Properties=name:type:columns:..., where a line must hold all of them: one that lacks a number
/// would pass for another. Without it, a name and the positions come first.
Columns FrameReader::columns(const Keys& keys) const {
  const auto properties = keys.find("Properties");
  if (properties == keys.end()) return {};
  std::istringstream stream(properties->second);
  std::size_t column = 0;
  std::optional<std::size_t> positions;
  for (std::string name, type, columns; std::getline(stream, name, ':') &&
                                        std::getline(stream, type, ':') &&
                                        std::getline(stream, columns, ':');) {
    if (name == "pos" && type == "R" && columns == "3" && !positions) positions = column;
    const std::size_t n = count(columns);
    if (n > most_columns || (column += n) > most_columns)
      fail(fmt::format("Properties names more than {} columns", most_columns));
  }
  if (!positions) fail("Properties has no pos:R:3");
  return {*positions, column, column};
}

bool FrameReader::next(Packing& packing) {
  std::string line;
  do {
    if (!next_line(line)) return false;
  } while (words_of(line).empty());
  const std::size_t n_spheres = count(words_of(line).front());
  if (!next_line(line)) fail("the file ends before the comment line");
  const Keys keys = parse_comment(line);
  if (n_spheres > most_spheres)
    fail(fmt::format("{} spheres are more than {}", n_spheres, most_spheres));
  packing = {container(keys), {}};
  const auto [column, least, most] = columns(keys);
  for (std::size_t i = 0; i < n_spheres; ++i) {
    if (!next_line(line)) fail(fmt::format("the file ends after {} of {} spheres", i, n_spheres));
    const auto words = words_of(line);
    if (words.size() < least || words.size() > most)
      fail(fmt::format("too {} columns: {} and not {}", words.size() < least ? "few" : "many",
                       words.size(), least));
    const Vec3 centre{coordinate(words[column]), coordinate(words[column + 1]),
                      coordinate(words[column + 2])};
    packing.centres.push_back(centre);
  }
  return true;
}

}  // namespace

Packing read_extended_xyz(const std::string& path, std::optional<std::uint64_t> frame) {
  FrameReader reader(path);
  Packing packing;
  std::uint64_t n = 0;
  while (reader.next(packing)) {
    if (frame && *frame == n) return packing;
    ++n;
  }
  if (frame) throw ResultsError(path, fmt::format("has no frame {}: it has {}", *frame, n));
  if (n == 0) throw ResultsError(path, "is empty");
  return packing;
}

std::vector<Packing> read_extended_xyz_frames(const std::string& path) {
  FrameReader reader(path);
  std::vector<Packing> frames;
  for (Packing packing; reader.next(packing);) frames.push_back(packing);
  if (frames.empty()) throw ResultsError(path, "is empty");
  return frames;
}

}  // namespace jostle::inline results
