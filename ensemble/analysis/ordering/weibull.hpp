#pragma once

#include <optional>
#include <span>

#include "ensemble/analysis/ordering/times.hpp"

namespace jostle::inline ensemble {

/// S(t) = exp(-(t/scale)^shape), by maximum likelihood with censoring; tap t stands for t - 1/2,
/// the middle of where order began. shape 1: memoryless, as by rare nucleation; above 1: order gets
/// likelier the longer it has not come, as a front that grows; below: realizations differ.
struct WeibullFit {
  double shape = 0, scale = 0;  // 1, taps
  Limits shape_68{}, shape_95{};
  double memoryless_p = 1;  // two-sided, of shape = 1
};

/// For few times the best shape is too large and its likelihood no guide. Intervals and p come from
/// the law of (best shape)/(true shape), which has no parameters where all order (Thoman, Bain &
/// Antle 1969, Technometrics 11, 445) and where the end of a run censors the one of
/// its place: from random samples that end at `last`, in units of the fitted law, always the same:
/// 20 000 of up to 100 times, fewer of more, at least 2000.
/// None of fewer than five ordered realizations, of which those that can be fitted at all are no
/// fair sample, nor of fewer than three different times, nor where one ordered at its start.
std::optional<WeibullFit> weibull(std::span<const OrderingTime> times, std::uint64_t last);

}  // namespace jostle::inline ensemble
