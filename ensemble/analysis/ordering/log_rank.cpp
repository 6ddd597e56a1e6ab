#include "ensemble/analysis/ordering/log_rank.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "engine/bed/random.hpp"

namespace jostle::inline ensemble {

namespace {

constexpr double rounding = 1e-9;

/// Censors all times at `last`.
OrderingTime seen_until(const OrderingTime& time, std::uint64_t last) {
  return time.tap > last ? OrderingTime{last, false} : time;
}

/// Counts the ways whose sum reaches the one observed.
class Ways {
 public:
  explicit Ways(double observed) : observed_(observed) {}
  void add(double sum) {
    ++all_;
    reached_ += sum >= observed_ - rounding ? 1 : 0;
  }
  double share() const { return static_cast<double>(reached_) / static_cast<double>(all_); }

 private:
  double observed_;
  std::size_t all_ = 0, reached_ = 0;
};

RandomStream drawn_ways() {
  return RandomStream(stream_key(0, 0, 0, Purpose::resampling));
}

/// n over m, at most a little more than `most_ways`.
double choices(std::size_t n, std::size_t m) {
  double product = 1;
  for (std::size_t k = 1; k <= m; ++k) {
    product *= static_cast<double>(n - m + k) / static_cast<double>(k);
  }
  return product;
}

/// The first n_first scores against the others.
double p_of_sharing_out(std::vector<double> scores, std::size_t n_first) {
  const auto sum = [&] {
    return std::accumulate(scores.begin(), scores.begin() + static_cast<long>(n_first), 0.0);
  };
  Ways ways(sum());
  if (choices(scores.size(), n_first) <= static_cast<double>(most_ways)) {
    std::vector<char> chosen(scores.size(), 0);
    std::fill_n(chosen.begin(), n_first, 1);
    do {
      double total = 0;
      for (std::size_t i = 0; i < scores.size(); ++i) total += chosen[i] != 0 ? scores[i] : 0;
      ways.add(total);
    } while (std::ranges::prev_permutation(chosen).found);
    return ways.share();
  }
  RandomStream random = drawn_ways();
  ways.add(std::numeric_limits<double>::infinity());  // the observed one
  for (std::size_t way = 1; way < most_ways; ++way) {
    for (std::size_t i = 0; i < n_first; ++i) {
      std::swap(scores[i], scores[i + random.integer_below(scores.size() - i)]);
    }
    ways.add(sum());
  }
  return ways.share();
}

/// p-value of the sum of differences, with all signs.
double p_of_signs(std::span<const double> differences) {
  Ways ways(std::accumulate(differences.begin(), differences.end(), 0.0));
  const std::size_t n = differences.size();
  constexpr std::size_t most_pairs = 13;
  if (n <= most_pairs) {
    for (std::size_t signs = 0; signs < std::size_t{1} << n; ++signs) {
      double sum = 0;
      for (std::size_t i = 0; i < n; ++i)
        sum += (signs >> i & 1U) != 0 ? -differences[i] : differences[i];
      ways.add(sum);
    }
    return ways.share();
  }
  RandomStream random = drawn_ways();
  ways.add(std::numeric_limits<double>::infinity());
  for (std::size_t way = 1; way < most_ways; ++way) {
    double sum = 0;
    for (const double difference : differences)
      sum += random.integer_below(2) == 0 ? difference : -difference;
    ways.add(sum);
  }
  return ways.share();
}

/// p(i, j): that chance lets i beat j.
Candidates best_of(std::size_t k, const std::function<double(std::size_t, std::size_t)>& p) {
  Candidates found;
  const auto n_others = static_cast<double>(k - 1);
  for (std::size_t j = 0; j < k; ++j) {
    double least = 1;
    for (std::size_t i = 0; i < k; ++i) {
      if (i != j) least = std::min(least, p(i, j));
    }
    found.p.push_back(std::min(1.0, least * n_others));
    found.may_be.push_back(found.p.back() > Candidates::level);
  }
  return found;
}

/// One-sided, of a mean difference above 0.
double upper_tail(const RealizationMean& difference) {
  const double p_of_both = p_value(difference.value, difference.error);
  if (std::isnan(p_of_both)) return 1;
  return difference.value > 0 ? 0.5 * p_of_both : 1 - 0.5 * p_of_both;
}

double p_of_larger(const std::vector<double>& first, const std::vector<double>& second,
                   Streams streams) {
  if (streams == Streams::matched) {
    std::vector<double> differences;
    for (std::size_t r = 0; r < std::min(first.size(), second.size()); ++r) {
      differences.push_back(first[r] - second[r]);
    }
    return upper_tail(mean_of(differences));
  }
  const RealizationMean a = mean_of(first), b = mean_of(second);
  return upper_tail({a.value - b.value, combined(a.error, b.error)});
}

}  // namespace

std::vector<double> log_rank_scores(std::span<const OrderingTime> times) {
  std::vector<std::size_t> order(times.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return times[i].tap; });
  std::vector<double> scores(times.size());
  double hazard = 0;
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin, events = 0;
    for (; end < order.size() && times[order[end]].tap == times[order[begin]].tap; ++end) {
      events += times[order[end]].ordered ? 1 : 0;
    }
    hazard += static_cast<double>(events) / static_cast<double>(order.size() - begin);
    for (; begin < end; ++begin) {
      scores[order[begin]] = (times[order[begin]].ordered ? 1 : 0) - hazard;
    }
  }
  return scores;
}

std::vector<OrderingTime> OrderingTimes::known() const {
  std::vector<OrderingTime> times;
  for (const auto& time : of_realization) {
    if (time) times.push_back(*time);
  }
  return times;
}

EarlierTest earlier(const OrderingTimes& first, const OrderingTimes& second, Streams streams) {
  const std::uint64_t last = std::min(first.last, second.last);
  std::vector<OrderingTime> times;
  const auto add = [&](const OrderingTimes& own, const OrderingTimes& alternative) {
    for (std::size_t r = 0; r < own.of_realization.size(); ++r) {
      const bool paired = r < alternative.of_realization.size() && alternative.of_realization[r];
      if (!own.of_realization[r] || (streams == Streams::matched && !paired)) continue;
      times.push_back(seen_until(*own.of_realization[r], last));
    }
    return times.size();
  };
  const std::size_t n_first = add(first, second), n = add(second, first);
  if (n_first == 0 || n == n_first) return {};
  std::vector<double> scores = log_rank_scores(times);
  if (streams != Streams::matched) {
    const double least = 1 / std::min(choices(n, n_first), static_cast<double>(most_ways));
    return {p_of_sharing_out(std::move(scores), n_first), least};
  }
  std::vector<double> differences;
  for (std::size_t i = 0; i < n_first; ++i) differences.push_back(scores[i] - scores[n_first + i]);
  const double ways = std::min(std::exp2(static_cast<double>(n_first)), double{most_ways});
  return {p_of_signs(differences), 1 / ways};
}

Candidates may_order_first(std::span<const OrderingTimes> all, Streams streams) {
  double least = 1;
  Candidates found = best_of(all.size(), [&](std::size_t i, std::size_t j) {
    const EarlierTest test = earlier(all[i], all[j], streams);
    least = std::min(least, test.least);
    return test.p;
  });
  found.could_decide = least * static_cast<double>(all.size() - 1) <= Candidates::level;
  return found;
}

Candidates may_be_largest(std::span<const std::vector<double>> values, Streams streams,
                          const std::vector<bool>& open) {
  Candidates found = best_of(values.size(), [&](std::size_t i, std::size_t j) {
    return p_of_larger(values[i], values[j], streams);
  });
  for (std::size_t j = 0; j < values.size(); ++j) {
    if (open[j]) found.may_be[j] = true;
    const auto known = std::ranges::count_if(values[j], [](double x) { return !std::isnan(x); });
    found.could_decide = found.could_decide || known >= 2;
  }
  return found;
}

std::size_t orders_first(std::span<const OrderingTimes> all) {
  std::uint64_t last = std::numeric_limits<std::uint64_t>::max();
  for (const OrderingTimes& times : all) last = std::min(last, times.last);
  std::vector<OrderingTime> pooled;
  for (const OrderingTimes& times : all) {
    for (const OrderingTime& time : times.known()) pooled.push_back(seen_until(time, last));
  }
  const std::vector<double> scores = log_rank_scores(pooled);
  std::size_t best = 0, begin = 0;
  double highest = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < all.size(); ++k) {
    const std::size_t n = all[k].known().size();
    double sum = 0;
    for (std::size_t i = begin; i < begin + n; ++i) sum += scores[i];
    begin += n;
    if (n > 0 && sum / static_cast<double>(n) > highest + rounding) {
      highest = sum / static_cast<double>(n);
      best = k;
    }
  }
  return best;
}

}  // namespace jostle::inline ensemble
