#include "results/export/extended_xyz_header.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "engine/number_reading.hpp"
#include "results/disk/printable.hpp"

namespace jostle::inline results {
namespace {

// The limit of scenes; a column of all spheres is as high as they are many.
constexpr std::size_t most_columns = 1000;
// Digits that another program did not write.
constexpr double rounding = 1e-6;

/// Values by their keys in lower case.
using Keys = std::map<std::string, std::string>;

template <class... Parts>
[[noreturn]] void refuse(fmt::format_string<Parts...> text, Parts&&... parts) {
  throw std::invalid_argument(printable(fmt::format(text, std::forward<Parts>(parts)...)));
}

std::string lower(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

/// Splits a comment line into key=value pairs. A value with blanks is in quotes or brackets.
class CommentParser {
 public:
  explicit CommentParser(const std::string& line) : line_(line) {}

  Keys keys() {
    Keys found;
    for (skip_blanks(); i_ < line_.size(); skip_blanks()) {
      const std::string key = lower(word("=" + blanks_));
      skip_blanks();
      if (i_ >= line_.size() || line_[i_] != '=') continue;  // a word of its own
      ++i_;
      skip_blanks();
      const std::string value = word(blanks_);
      if (!found.emplace(key, value).second)
        refuse("the comment line names {} twice; leave one of them out", key);
    }
    return found;
  }

 private:
  void skip_blanks() { i_ = std::min(line_.find_first_not_of(blanks_, i_), line_.size()); }

  /// Ends at one of `ends`, at the closing quote, or at the bracket that closes the first.
  std::string word(const std::string& ends) {
    if (i_ >= line_.size()) return "";
    const char open = line_[i_];
    const std::size_t first = i_;
    if (open == '"' || open == '\'') {
      i_ = line_.find(open, first + 1);
      if (i_ == std::string::npos)
        refuse("the comment line has a quote {} that is not closed", open);
      return line_.substr(first + 1, i_++ - first - 1);
    }
    if (open == '{' || open == '[') {
      const char close = open == '{' ? '}' : ']';
      int depth = 0;
      for (; i_ < line_.size(); ++i_) {
        depth += line_[i_] == open ? 1 : line_[i_] == close ? -1 : 0;
        if (depth == 0) return line_.substr(first, ++i_ - first);
      }
      refuse("the comment line has a bracket {} that is not closed", open);
    }
    i_ = std::min(line_.find_first_of(ends, first), line_.size());
    if (i_ == first && i_ < line_.size()) ++i_;  // a lone "="
    return line_.substr(first, i_ - first);
  }

  const std::string blanks_ = " \t\r";
  const std::string& line_;
  std::size_t i_ = 0;
};

/// The entries of a list, with or without commas and brackets.
std::vector<std::string> entries_of(std::string list) {
  for (char& c : list)
    if (std::string_view("[]{},").find(c) != std::string_view::npos) c = ' ';
  return words_of(list);
}

std::array<double, 3> widths_of(const Keys& keys) {
  const auto lattice = keys.find("lattice");
  if (lattice == keys.end()) refuse("no Lattice=\"...\": the container's widths are not known");
  const auto words = entries_of(lattice->second);
  if (words.size() != 9) refuse("Lattice has {} numbers, not 9", words.size());
  for (std::size_t k = 0; k < 9; ++k)
    if (k % 4 != 0 && finite_number(words[k]) != 0)
      refuse("Lattice is not a right-angled box along x, y, z: its number {} is {} and not 0",
             k + 1, words[k]);
  return {finite_number(words[0]), finite_number(words[4]), finite_number(words[8])};
}

Vec3 origin_of(const Keys& keys) {
  auto origin = keys.end();
  for (auto key = keys.begin(); key != keys.end(); ++key) {
    std::string plain = key->first;
    std::erase(plain, '_');
    if (plain != "origin" && plain != "cellorigin" && plain != "boxorigin" &&
        plain != "latticeorigin")
      continue;
    if (origin != keys.end())
      refuse("the comment line has both {} and {}; leave one of them out", origin->first,
             key->first);
    origin = key;
  }
  if (origin == keys.end()) return {};
  const auto words = entries_of(origin->second);
  if (words.size() != 3) refuse("Origin has {} numbers, not 3", words.size());
  const Vec3 corner{finite_number(words[0]), finite_number(words[1]), finite_number(words[2])};
  for (const double x : {corner.x, corner.y, corner.z})
    if (std::abs(x) > double{most_spheres})
      refuse("Origin: {} diameters are farther than {}", x, most_spheres);
  return corner;
}

/// "T T F" of pbc, however it is spelled.
std::optional<std::string> pbc_of(const Keys& keys) {
  const auto pbc = keys.find("pbc");
  if (pbc == keys.end()) return std::nullopt;
  std::string directions;
  for (const std::string& entry : entries_of(pbc->second)) {
    const std::string word = lower(entry);
    const bool yes = word == "t" || word == "true" || word == "1";
    if (!yes && word != "f" && word != "false" && word != "0")
      refuse("pbc=\"{}\" is not three times T or F", pbc->second);
    directions += directions.empty() ? "" : " ";
    directions += yes ? 'T' : 'F';
  }
  if (directions.size() != 5) refuse("pbc=\"{}\" is not three times T or F", pbc->second);
  return directions;
}

std::string kind_of(const Keys& keys) {
  const auto pbc = pbc_of(keys);
  const auto named = keys.find("container");
  if (named != keys.end()) {
    const auto container = container_of(named->second, {});
    if (!container)
      refuse("container={} is not known; there are {}", named->second,
             fmt::join(container_names(), ", "));
    const std::string expected = periodic_directions(Boundary(*container));
    if (pbc && *pbc != expected)
      refuse(
          "pbc=\"{}\" contradicts container={}, which is pbc=\"{}\"; correct one of them, or leave "
          "pbc out",
          *pbc, named->second, expected);
    return named->second;
  }
  if (!pbc)
    refuse("neither container={} nor pbc=\"T T F\" or the like", fmt::join(container_names(), "|"));
  // "F F F" is a box between walls, not a tube: the first that has them.
  std::vector<std::string> known;
  for (const std::string& name : container_names()) {
    const std::string directions = periodic_directions(Boundary(*container_of(name, {})));
    if (*pbc == directions) return name;
    known.push_back(fmt::format("\"{}\" ({})", directions, name));
  }
  refuse("pbc=\"{}\" is no container of jostle: there are {}", *pbc, fmt::join(known, ", "));
}

Container container_in(const Keys& keys) {
  const auto widths = widths_of(keys);
  const std::string kind = kind_of(keys);
  const Boundary shape(*container_of(kind, {}));
  for (std::size_t k = 0; k < (shape.periodic_z ? 3U : 2U); ++k)
    if (!(widths[k] > 0) || widths[k] > widest_container)
      refuse("the sides of Lattice must be above 0 and at most {} diameters, not {}",
             widest_container, widths[k]);
  if (widths[2] < 0) refuse("the height of Lattice must not be negative: it is {}", widths[2]);
  if (shape.tube && std::abs(widths[0] - widths[1]) > rounding * widths[0])
    refuse("container={} has one diameter, and Lattice has the sides {} and {}; make them equal",
           kind, widths[0], widths[1]);
  Container container = *container_of(kind, {widths[0], widths[1], widths[2]});
  if (const auto fault = width_fault(container))
    refuse("{}; check that lengths are in diameters", *fault);
  return container;
}

/// The model's value of what a name calls the size of a sphere; nothing of another name.
std::optional<SizeColumns> size_named(const std::string& name) {
  std::string plain = lower(name);
  std::erase(plain, '_');
  for (const char* radius : {"radius", "radii", "particleradius", "r", "rad"})
    if (plain == radius)
      return SizeColumns{.name = name, .model = sphere_radius, .of_mixtures = plain.size() > 3};
  for (const char* diameter :
       {"diameter", "diameters", "particlediameter", "size", "d", "diam", "sigma"})
    if (plain == diameter)
      return SizeColumns{.name = name,
                         .model = 2 * sphere_radius,
                         .of_mixtures = plain.ends_with("diameter") || plain == "diameters"};
  if (plain == "asphericalshape")
    return SizeColumns{.name = name, .model = sphere_radius, .zero_means = true};
  return std::nullopt;
}

/// Sizes that hold for the whole frame, and units of length.
void require_model_keys(const Keys& keys) {
  for (const auto& [key, value] : keys) {
    const auto size = size_named(key);
    static constexpr std::array anything = {"size", "r", "d", "sigma"};  // true if a frame has any
    if (size && std::ranges::find(anything, key) == anything.end()) {
      for (const std::string& entry : entries_of(value)) {
        const double given = finite_number(entry);
        require_model_size(key, given, given, size->model);
      }
    }
    const bool unit = key == "unit" || key == "units" || key == "length_unit" ||
                      key == "length_units" || key == "lengthunit";
    const std::string named = lower(value);
    if (unit && named != "d" && named != "diameter" && named != "diameters" && named != "lj")
      refuse(
          "{}={}: lengths must be in diameters of the spheres; convert them, and leave the key "
          "out",
          key, value);
  }
}

/// The kinds of a mixture, each with its density, which is 1 where none is given.
std::vector<SphereKind> kinds_of(const Keys& keys) {
  const auto named = keys.find("kinds");
  if (named == keys.end()) return {};
  std::vector<SphereKind> kinds;
  for (const std::string& name : words_of(named->second)) kinds.push_back({name, 1});
  const auto given = keys.find("densities");
  if (given == keys.end()) return kinds;
  const auto densities = words_of(given->second);
  if (densities.size() != kinds.size())
    refuse("kinds names {} kinds of spheres, and densities has {} numbers; give one per kind",
           kinds.size(), densities.size());
  for (std::size_t k = 0; k < kinds.size(); ++k) kinds[k].density = finite_number(densities[k]);
  return kinds;
}

/// Reads Properties=name:type:columns:..., where a line must hold all of them: a line without a
/// number could be misread. Without it, a name and the positions are all.
void read_columns(const Keys& keys, ExtendedXyzHeader& header) {
  const auto properties = keys.find("properties");
  if (properties == keys.end()) return;
  std::istringstream stream(properties->second);
  std::size_t column = 0;
  bool positions = false;
  for (std::string name, type, columns; std::getline(stream, name, ':');) {
    if (!std::getline(stream, type, ':') || !std::getline(stream, columns, ':'))
      refuse("Properties is not name:type:columns, repeated: \"{}\" has not all three", name);
    const std::size_t n = positive_count(columns);
    if (type != "R" && type != "I" && type != "S" && type != "L")
      refuse("Properties: {} has the type {}; there are R, I, S and L", name, type);
    if (lower(name) == "pos") {
      if (positions) refuse("Properties names pos twice; leave one of them out");
      if (type != "R" || n != 3) refuse("Properties has {}:{}:{}, not pos:R:3", name, type, n);
      positions = true;
      header.positions = column;
    }
    if (lower(name) == "species" && type == "S" && n == 1) header.species = column;
    if (auto size = size_named(name)) {
      size->first = column;
      size->n = n;
      header.sizes.push_back(*size);
    }
    if (n > most_columns || (column += n) > most_columns)
      refuse("Properties names more than {} columns", most_columns);
  }
  if (!positions) refuse("Properties has no pos:R:3");
  header.n_columns = column;
}

}  // namespace

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

double finite_number(const std::string& word) {
  double value = 0;
  const auto [end, error] = read_decimal(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
    refuse("\"{}\" is not a finite number", word);
  return value;
}

std::size_t positive_count(const std::string& word) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || value == 0)
    refuse("\"{}\" is not a count", word);
  return value;
}

void require_model_size(const std::string& name, double least, double most, double model) {
  if (is_model_size(least, most, model)) return;
  if (!(least > 0))
    refuse("{} is {}: every sphere must have {}, with lengths in diameters", name, least, model);
  constexpr std::array ambiguous = {"r", "rad", "d", "diam", "sigma"};
  const char* const rename = std::ranges::find(ambiguous, lower(name)) != ambiguous.end()
                                 ? ". Rename the column if it holds no sizes"
                                 : "";
  if (are_alike(least, most))
    refuse(
        "{} is {}, and the spheres of the model have {}: lengths must be in diameters. Divide all "
        "lengths (Lattice, Origin, pos, {}) by {:.6g}{}",
        name, least, model, name, least / model, rename);
  refuse(
      "{} is from {} to {}: sizes of a mixture are read of columns named radius or diameter alone. "
      "Rename the column, or give all spheres {}, with lengths in diameters{}",
      name, least, most, model, rename);
}

bool is_model_size(double least, double most, double model) {
  const double close = rounding * model;
  return std::abs(least - model) <= close && std::abs(most - model) <= close;
}

bool are_alike(double least, double most) {
  return most - least <= rounding * most;
}

std::string periodic_directions(const Boundary& boundary) {
  const auto letter = [](bool periodic) { return periodic ? 'T' : 'F'; };
  return fmt::format("{} {} {}", letter(boundary.periodic_x), letter(boundary.periodic_y),
                     letter(boundary.periodic_z));
}

ExtendedXyzHeader parse_extended_xyz_header(const std::string& comment) {
  const Keys keys = CommentParser(comment).keys();
  ExtendedXyzHeader header{.container = container_in(keys),
                           .origin = origin_of(keys),
                           .sizes = {},
                           .species = {},
                           .kinds = {}};
  require_model_keys(keys);
  read_columns(keys, header);
  header.kinds = kinds_of(keys);
  return header;
}

}  // namespace jostle::inline results
