#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "results/file/results_file.hpp"

namespace jostle::inline cli {

enum class Glyphs {
  ascii,
  unicode  // braille dots and blocks
};

/// A curve over taps, `values` from tap 0 on, with its least and greatest value at the left and
/// taps below: tap 0, which has no place on a logarithmic axis, is separate, then tap 1 to the
/// last on it. NaN is not drawn. Nothing of fewer than three values that are no NaN.
std::string curve_text(const std::string& name, std::span<const double> values, std::size_t width,
                       Glyphs glyphs);

/// The curve in one line of so many characters, heights between `low` and `high`.
std::string sparkline(std::span<const double> values, double low, double high, std::size_t width,
                      Glyphs glyphs);

/// The compaction curve of a file: of one sweep point drawn, of several a line each on one scale.
/// The observable is its first fraction, or else its first one.
std::string compaction_curves(const ResultsFile& file, std::size_t width, Glyphs glyphs);

}  // namespace jostle::inline cli
