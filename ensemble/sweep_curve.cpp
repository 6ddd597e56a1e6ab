#include "ensemble/sweep_curve.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <span>

#include "ensemble/moments.hpp"

namespace jostle {

namespace {

Moments folded(std::span<const double> values, std::optional<std::size_t> left_out = std::nullopt) {
  Moments moments;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i != left_out) moments.add(values[i]);
  }
  return moments;
}

template <class T>
std::vector<T> chosen(const std::vector<T>& values, const std::vector<std::size_t>& order) {
  std::vector<T> kept;
  for (const std::size_t i : order) kept.push_back(values[i]);
  return kept;
}

}  // namespace

SweepCurve::SweepCurve(std::vector<double> x, std::vector<double> y, std::vector<double> error)
    : x_(std::move(x)), y_(std::move(y)), error_(std::move(error)), count_(x_.size(), 0) {
  assert(y_.size() == x_.size() && error_.size() == x_.size());
  sort_and_drop();
}

SweepCurve::SweepCurve(std::vector<double> x, std::vector<std::vector<double>> realizations,
                       Streams streams)
    : x_(std::move(x)), realizations_(std::move(realizations)), streams_(streams) {
  assert(realizations_.size() == x_.size());
  for (const std::vector<double>& values : realizations_) {
    const Moments moments = folded(values);
    y_.push_back(moments.mean());
    error_.push_back(moments.standard_error());
    count_.push_back(moments.count());
  }
  sort_and_drop();
}

void SweepCurve::sort_and_drop() {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < x_.size(); ++i) {
    if (!std::isnan(y_[i])) order.push_back(i);
  }
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return x_[i]; });
  x_ = chosen(x_, order);
  y_ = chosen(y_, order);
  error_ = chosen(error_, order);
  count_ = chosen(count_, order);
  if (has_realizations()) realizations_ = chosen(realizations_, order);
}

bool SweepCurve::errors_known() const {
  return std::ranges::all_of(error_, [](double error) { return error > 0; });
}

std::vector<std::vector<std::vector<double>>> SweepCurve::left_out() const {
  std::vector<std::vector<std::vector<double>>> groups;
  if (streams_ == Streams::matched) {
    std::size_t n = 0;
    for (const auto& values : realizations_) n = std::max(n, values.size());
    groups.emplace_back();
    for (std::size_t r = 0; r < n; ++r) {
      const bool present = std::ranges::any_of(realizations_, [r](const auto& values) {
        return r < values.size() && !std::isnan(values[r]);
      });
      if (!present) continue;
      std::vector<double> y;
      for (const auto& values : realizations_) y.push_back(folded(values, r).mean());
      groups.back().push_back(std::move(y));
    }
    return groups;
  }
  for (std::size_t i = 0; i < realizations_.size(); ++i) {
    groups.emplace_back();
    for (std::size_t r = 0; r < realizations_[i].size(); ++r) {
      if (std::isnan(realizations_[i][r])) continue;
      groups.back().push_back(y_);
      groups.back().back()[i] = folded(realizations_[i], r).mean();
    }
  }
  return groups;
}

}  // namespace jostle
