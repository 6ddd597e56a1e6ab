#include "results/extended_xyz.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <vector>

#include "results/container_text.hpp"
#include "results/error.hpp"

namespace jostle {
namespace {

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

class FrameReader {
 public:
  explicit FrameReader(const std::string& path) : path_(path), file_(path) {
    if (!file_) throw ResultsError(path, "cannot open");
  }

  /// Reads the next frame; false at the end of the file.
  bool next(Packing& packing);

 private:
  bool next_line(std::string& line);
  [[noreturn]] void fail(const std::string& what) const {
    throw ResultsError(path_, fmt::format("line {}: {}", line_number_, what));
  }
  double number(const std::string& word) const;
  std::size_t count(const std::string& word) const;
  Container container(const Keys& keys) const;
  std::size_t position_column(const std::string& properties) const;

  std::string path_;
  std::ifstream file_;
  std::size_t line_number_ = 0;
};

bool FrameReader::next_line(std::string& line) {
  ++line_number_;
  return static_cast<bool>(std::getline(file_, line));
}

double FrameReader::number(const std::string& word) const {
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
    fail("\"" + word + "\" is not a finite number");
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
  if (!made)
    fail(
        "neither container=periodic|walls|cylinder|fully_periodic nor pbc=\"T T F\", \"T T T\" "
        "or \"F F F\"");
  return *made;
}

/// The first of the three columns of `pos` in Properties=name:type:columns:...
std::size_t FrameReader::position_column(const std::string& properties) const {
  std::istringstream stream(properties);
  std::size_t column = 0;
  for (std::string name, type, columns; std::getline(stream, name, ':') &&
                                        std::getline(stream, type, ':') &&
                                        std::getline(stream, columns, ':');) {
    if (name == "pos" && type == "R" && columns == "3") return column;
    column += count(columns);
  }
  fail("Properties has no pos:R:3");
}

bool FrameReader::next(Packing& packing) {
  std::string line;
  do {
    if (!next_line(line)) return false;
  } while (words_of(line).empty());
  const std::size_t n_spheres = count(words_of(line).front());
  if (!next_line(line)) fail("the file ends before the comment line");
  const Keys keys = parse_comment(line);
  packing = {container(keys), {}};
  const auto properties = keys.find("Properties");
  const std::size_t column = properties == keys.end() ? 1 : position_column(properties->second);
  for (std::size_t i = 0; i < n_spheres; ++i) {
    if (!next_line(line)) fail(fmt::format("the file ends after {} of {} spheres", i, n_spheres));
    const auto words = words_of(line);
    if (words.size() < column + 3) fail("too few columns");
    packing.centres.push_back(
        {number(words[column]), number(words[column + 1]), number(words[column + 2])});
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

}  // namespace jostle
