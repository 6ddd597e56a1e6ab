#pragma once

#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "engine/bed/packing.hpp"
#include "engine/bed/random.hpp"
#include "tests/test_files.hpp"

// Points of tests/data/voronoi, as packings in fully periodic boxes.
namespace jostle {

inline std::vector<Vec3> points_of(const std::string& name) {
  std::ifstream file(test_data("voronoi/" + name));
  file.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  std::vector<Vec3> points;
  for (Vec3 r; file >> r.x >> r.y >> r.z;) points.push_back(r);
  return points;
}

inline Packing poisson_points() {
  constexpr double width = 15.874010519681992;
  return {FullyPeriodicBox{width, width, width}, points_of("poisson4000_points.dat")};
}
inline Packing fcc_points() {
  constexpr double width = 7.0710678118654755;
  return {FullyPeriodicBox{width, width, width}, points_of("fcc_points.dat")};
}
inline Packing hcp_points() {
  return {FullyPeriodicBox{5, 8.6602540378443855, 8.1649658092772608}, points_of("hcp_points.dat")};
}

/// Every coordinate displaced by up to `amplitude`.
inline Packing with_noise(Packing packing, double amplitude) {
  RandomStream random(stream_key(63, 0, 0, Purpose::start));
  for (Vec3& r : packing.centres) {
    const auto shift = [&] { return amplitude * (2 * random.uniform() - 1); };
    r = {r.x + shift(), r.y + shift(), r.z + shift()};
  }
  return packing;
}

/// The rows of a CSV file of numbers, without its heading.
inline std::vector<std::vector<double>> rows_of(const std::string& name) {
  std::ifstream file(test_data("voronoi/" + name));
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line.front() == '#') continue;
    std::istringstream fields(line);
    rows.emplace_back();
    for (std::string field; std::getline(fields, field, ',');)
      rows.back().push_back(std::stod(field));
  }
  return rows;
}

}  // namespace jostle
