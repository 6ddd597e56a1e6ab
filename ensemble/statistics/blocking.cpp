#include "ensemble/statistics/blocking.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "ensemble/moments.hpp"

namespace jostle::inline ensemble {

namespace {

// Below it, the error of an error is above 27 %.
constexpr std::size_t fewest_blocks = 8;

bool long_enough(const BlockingLevel& level, const BlockingLevel& single_taps) {
  if (level.n_blocks < fewest_blocks) return false;
  if (single_taps.error == 0) return true;
  const auto length = static_cast<double>(level.block_length);
  const double ratio = level.error / single_taps.error;
  return length * length * length >
         2 * static_cast<double>(single_taps.n_blocks) * ratio * ratio * ratio * ratio;
}

}  // namespace

double BlockingResult::error() const {
  if (plateau) return levels[*plateau].error;
  double largest = std::numeric_limits<double>::quiet_NaN();
  for (const BlockingLevel& level : levels) largest = std::fmax(largest, level.error);
  return largest;
}

void Blocking::add(std::span<const double> series) {
  assert(n_ == 0 || series.size() == n_);
  n_ = series.size();
  ++realizations_;
  std::vector<double> blocks(series.begin(), series.end());
  for (std::size_t level = 0; blocks.size() >= 2; ++level) {
    if (level == pools_.size()) pools_.push_back({blocks.size(), 0});
    Moments moments;
    for (const double block : blocks) moments.add(block);
    const double sigma = moments.sigma();
    pools_[level].squares += sigma * sigma * static_cast<double>(blocks.size());
    // A last value without a partner is left out from here on.
    for (std::size_t i = 0; 2 * i + 1 < blocks.size(); ++i) {
      blocks[i] = 0.5 * (blocks[2 * i] + blocks[2 * i + 1]);
    }
    blocks.resize(blocks.size() / 2);
  }
}

BlockingResult Blocking::result() const {
  BlockingResult result;
  for (std::size_t i = 0; i < pools_.size(); ++i) {
    const double freedom = static_cast<double>(realizations_ * (pools_[i].n_blocks - 1));
    BlockingLevel level{.block_length = std::size_t{1} << i,
                        .n_blocks = realizations_ * pools_[i].n_blocks,
                        .variance = pools_[i].squares / freedom};
    level.error = std::sqrt(level.variance / static_cast<double>(level.n_blocks));
    level.error_error = level.error / std::sqrt(2 * freedom);
    result.levels.push_back(level);
    if (!result.plateau && long_enough(level, result.levels.front())) result.plateau = i;
  }
  return result;
}

}  // namespace jostle::inline ensemble
