#pragma once

#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "engine/bed/packing.hpp"
#include "tests/test_files.hpp"

namespace jostle {

/// The reference deposit of tests/data, in diameters: 4096 spheres, periodic sides of 16 d.
inline Packing reference_deposit() {
  Packing packing{PeriodicBox{16, 16}, {}};
  std::ifstream file(test_data("dep_L32_N4096_s1.dat"));
  file.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  double x = 0, y = 0, z = 0;
  int supports = 0;
  while (file >> x >> y >> z >> supports) {
    packing.centres.push_back({x * sphere_radius, y * sphere_radius, z * sphere_radius});
  }
  return packing;
}

/// Measurements of the deposit by the program that made it; lengths in R.
inline nlohmann::json reference_measurements() {
  std::ifstream file(test_data("dep_L32_N4096_s1.json"));
  return nlohmann::json::parse(file);
}

}  // namespace jostle
