#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/fields.hpp"

// How many realizations a target precision needs.
namespace jostle::inline ensemble {

/// The quantity that must become small: the standard error of the mean over realizations, which
/// shrinks as 1/M^(1/2), or their population deviation sigma, which does not shrink: Rosato et al.
/// 2010 add realizations until sigma(N_T; gamma) <= 0.001.
enum class Spread { standard_error, sigma };
inline constexpr NameTable<Spread, 2> spread_names{
    {{"standard_error", Spread::standard_error}, {"sigma", Spread::sigma}}};
inline constexpr Number spread_number{left_open_range(0, 1e6)};

struct SpreadTarget {
  std::string observable;
  std::vector<std::uint64_t> taps;  // ascending; empty: the last one
  Spread spread = Spread::standard_error;
  double at_most = 0;  // in units of the observable
  bool operator==(const SpreadTarget&) const = default;

  template <class Self = SpreadTarget>
  static constexpr auto fields() {
    return std::tuple{
        field("observable", &Self::observable, Text{}, "One that the scene observes",
              {.required = "the name of an observable of this scene"}),
        field("taps", &Self::taps, TapNumbers{},
              "Taps at which the target must be met; absent: the last tap"),
        keyed_number<SpreadTarget, Spread, 2>(
            &Self::at_most, &Self::spread, spread_names, {spread_number, spread_number},
            {"Standard error of the mean over realizations, at most",
             "Population deviation of realizations, at most. It does not shrink with their number"},
            true)};
  }
};

/// Realizations are added until every target is met at every sweep point, or there are `at_most`.
struct TargetPrecision {
  std::vector<SpreadTarget> targets;  // empty: exactly the number of the scene
  std::uint32_t at_most = 0;
  bool operator==(const TargetPrecision&) const = default;

  template <class Self = TargetPrecision>
  static constexpr auto fields() {
    return std::tuple{
        field("targets", &Self::targets, list_of(Object<SpreadTarget>{}, 1, 100, "targets"), "",
              {.required = "a list of observables and how small their spread must be"}),
        field("at_most", &Self::at_most, Whole{1, 1'000'000}, "Realizations of every sweep point",
              {.required = "the largest number of realizations"})};
  }
};

/// The spread of one observable at one tap and sweep point.
struct SpreadFound {
  Spread spread = Spread::standard_error;
  double value = 0;  // NaN below two realizations
  double at_most = 0;
  bool met() const { return value <= at_most; }
};

/// How many realizations there should be in all: `realizations` itself where every target is met
/// or the limit is reached, else more: as many as a standard error needs, judged by what it is now,
/// but at most twice as many at once; a quarter more for a sigma. It depends on its arguments
/// alone.
std::uint32_t next_realizations(std::uint32_t realizations, std::span<const SpreadFound> found,
                                std::uint32_t at_most);

}  // namespace jostle::inline ensemble
