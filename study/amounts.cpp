#include "study/amounts.hpp"

#include <cmath>
#include <initializer_list>

#include "ensemble/statistics/finite_text.hpp"

namespace jostle::inline study {
namespace {

std::string scaled(double number, double base, std::initializer_list<const char*> units) {
  auto unit = units.begin();
  while (std::abs(number) >= base && unit + 1 != units.end()) {
    number /= base;
    ++unit;
  }
  if (unit == units.begin()) return finite_text("{:.0f}{}", number, *unit);
  return finite_text("{:.1f}{}", number, *unit);
}

}  // namespace

std::string format_count(double count) {
  return scaled(count, 1000, {"", " k", " M", " G", " T"});
}

std::string format_bytes(double bytes) {
  return scaled(bytes, 1024, {" B", " KiB", " MiB", " GiB", " TiB"});
}

}  // namespace jostle::inline study
