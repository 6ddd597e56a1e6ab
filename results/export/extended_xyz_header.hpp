#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/bed/boundary.hpp"
#include "engine/bed/container.hpp"
#include "engine/bed/sizes.hpp"
#include "engine/bed/vec3.hpp"

// The comment line of an extended XYZ frame: the properties of the spheres below it.
namespace jostle::inline results {

/// A column, or several, that holds sizes of spheres.
struct SizeColumns {
  std::string name;       // spelled as in the file
  std::size_t first = 0;  // index of a word in a line
  std::size_t n = 1;
  double model = 0;          // the size of equal spheres: radius 0.5 or diameter 1
  bool of_mixtures = false;  // named radius or diameter, so that it may hold several sizes
  bool zero_means = false;   // 0 stands for "the radius", as in OVITO's aspherical shapes
};

struct ExtendedXyzHeader {
  Container container;
  Vec3 origin;  // origin of the container's corner, diameters
  std::size_t positions = 1;
  std::size_t n_columns = 4;
  std::vector<SizeColumns> sizes;
  std::optional<std::size_t> species;  // a column of names
  std::vector<SphereKind> kinds;       // in the order of the line; empty: those that species name
};

/// Reads a comment line. Throws std::invalid_argument: whatever changes the meaning of the
/// positions is understood or refused (docs/reference/file-format.md#extended-xyz).
ExtendedXyzHeader parse_extended_xyz_header(const std::string& comment);

/// "T T F": periodic directions, in the form of pbc.
std::string periodic_directions(const Boundary& boundary);

/// Words between blanks.
std::vector<std::string> words_of(const std::string& line);
/// A finite number, or std::invalid_argument.
double finite_number(const std::string& word);
/// A whole number above 0, or std::invalid_argument.
std::size_t positive_count(const std::string& word);

/// True if the sizes from `least` to `most` are the model's, but for digits that another program
/// did not write.
bool is_model_size(double least, double most, double model);
/// True if the sizes from `least` to `most` are equal, but for rounding.
bool are_alike(double least, double most);
/// Throws std::invalid_argument where the sizes that `name` gives, from `least` to `most`, are not
/// the model's.
void require_model_size(const std::string& name, double least, double most, double model);

}  // namespace jostle::inline results
