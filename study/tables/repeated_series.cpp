#include "study/tables/repeated_series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <set>
#include <utility>

namespace jostle::inline study {
namespace {

constexpr std::uint64_t fewest_rows = 3;
constexpr std::size_t enough_values = 8;  // different values that do not agree by chance
constexpr std::uint64_t first_rows = 64;  // decide in almost all files
constexpr std::uint64_t values_at_once = 4'000'000;

std::uint64_t bits_of(double value) {
  return std::bit_cast<std::uint64_t>(value);
}

/// Realizations whose series agree so far.
struct Group {
  std::vector<std::uint32_t> members;
  std::set<std::uint64_t> values{};  // up to enough_values of them
};

class Comparison {
 public:
  Comparison(const ResultsFile& file, std::uint32_t point, std::uint64_t n_rows)
      : file_(file), point_(point), n_rows_(n_rows) {}

  /// Splits groups where a column differs. Groups of one realization are left out.
  void split(std::vector<Group>& groups, const std::string& column) const {
    const std::uint32_t width = file_.study().realizations;
    std::uint64_t rows = first_rows;
    for (std::uint64_t first = 0; first < n_rows_ && !groups.empty(); first += rows) {
      if (first > 0) rows = std::max(first_rows, values_at_once / width);
      const std::uint64_t end = std::min(first + rows, n_rows_);
      const std::vector<double> block = file_.block(point_, column, {first, end}, {0, width});
      for (std::uint64_t row = 0; row < end - first; ++row) {
        split(groups, std::span(block).subspan(row * width, width));
      }
    }
  }

 private:
  static void split(std::vector<Group>& groups, std::span<const double> row) {
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const std::uint64_t value = bits_of(row[groups[g].members.front()]);
      const auto differing = std::ranges::stable_partition(
          groups[g].members, [&](std::uint32_t r) { return bits_of(row[r]) == value; });
      Group rest{{differing.begin(), differing.end()}, groups[g].values};
      groups[g].members.erase(differing.begin(), differing.end());
      if (groups[g].values.size() < enough_values) groups[g].values.insert(value);
      if (rest.members.size() > 1) groups.push_back(std::move(rest));
    }
    std::erase_if(groups, [](const Group& group) { return group.members.size() < 2; });
  }

  const ResultsFile& file_;
  std::uint32_t point_;
  std::uint64_t n_rows_;
};

}  // namespace

std::vector<std::size_t> distinct_columns(std::span<const double> values, std::size_t n_columns) {
  const auto column = [&](std::size_t c) {
    std::vector<std::uint64_t> bits;
    for (std::size_t i = c; i < values.size(); i += n_columns) bits.push_back(bits_of(values[i]));
    return bits;
  };
  std::set<std::vector<std::uint64_t>> known;
  std::vector<std::size_t> distinct;
  for (std::size_t c = 0; c < n_columns; ++c) {
    std::vector<std::uint64_t> bits = column(c);
    const bool constant = std::ranges::adjacent_find(bits, std::not_equal_to<>()) == bits.end();
    if (constant || known.insert(std::move(bits)).second) distinct.push_back(c);
  }
  return distinct;
}

std::vector<std::uint32_t> distinct_realizations(const ResultsFile& file, std::uint32_t point,
                                                 const std::string& observable,
                                                 const std::vector<std::uint32_t>& realizations,
                                                 std::uint64_t n_rows) {
  if (realizations.size() < 2 || n_rows < fewest_rows) return realizations;
  const Comparison comparison(file, point, n_rows);
  std::vector<Group> groups = {{realizations}};
  comparison.split(groups, observable);
  std::vector<Group> doubtful, copies;
  for (Group& group : groups) {
    (group.values.size() < enough_values ? doubtful : copies).push_back(std::move(group));
  }
  // Values of other columns decide: `values` counts the most of one column.
  for (Group& group : doubtful) {
    std::vector<Group> parts = {{std::move(group.members)}};
    bool changes = false;
    for (const Column& column : file.columns(point)) {
      for (Group& part : parts) part.values.clear();
      comparison.split(parts, column.name);
      for (const Group& part : parts) changes = changes || part.values.size() > 1;
    }
    if (changes) std::ranges::move(parts, std::back_inserter(copies));
  }
  std::set<std::uint32_t> repeated;
  for (const Group& group : copies) {
    repeated.insert(group.members.begin() + 1, group.members.end());
  }
  std::vector<std::uint32_t> distinct = realizations;
  std::erase_if(distinct, [&](std::uint32_t r) { return repeated.contains(r); });
  return distinct;
}

std::string copies_text(std::size_t n_copies, std::size_t n_distinct) {
  if (n_copies == 0) return {};
  return fmt::format(
      "{} of the {} realizations repeat{} the series of another, so {} realization{} used",
      n_copies, n_copies + n_distinct, n_copies == 1 ? "s" : "", n_distinct,
      n_distinct == 1 ? " is" : "s are");
}

}  // namespace jostle::inline study
