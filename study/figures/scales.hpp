#pragma once

#include <string>
#include <vector>

#include "study/figures/figure.hpp"

// Where the axes of a figure begin and end, and what stands along them.
namespace jostle::inline study {

/// Where tap 0 stands on a logarithmic axis of taps, to the left of tap 1.
inline constexpr double place_of_tap_zero = 0.28;

struct Tick {
  double at;
  std::string label;
};

struct Scale {
  double low = 0, high = 1;
  bool is_logarithmic = false;
  bool has_break = false;  // tap 0 stands apart
  bool is_whole = false;   // only whole numbers stand along it
  double step = 0;         // of even ticks; 0: `ticks` and `minor` are all that there are
  std::vector<Tick> ticks{};
  std::vector<double> minor{};    // without a label
  std::size_t longest_label = 1;  // characters
};

/// Of what stands along it, errors included. `most_ticks`: about so many, of an even axis.
Scale scale_of_x(const FigurePanel& panel, std::size_t most_ticks);
Scale scale_of_y(const FigurePanel& panel, std::size_t most_ticks);

/// Where a row ends downwards and upwards; y where it has no error.
double lower_end(const FigureRow& row);
double upper_end(const FigureRow& row);

}  // namespace jostle::inline study
