#pragma once

#include <array>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ensemble/plan.hpp"

// What scenes call the enumerators.
namespace jostle::inline config {

template <class Enum, std::size_t n>
using NameTable = std::array<std::pair<std::string_view, Enum>, n>;

inline constexpr NameTable<ThetaLaw, 3> theta_laws{{{"gaussian", ThetaLaw::gaussian},
                                                    {"exponential", ThetaLaw::exponential},
                                                    {"linear", ThetaLaw::linear}}};
inline constexpr NameTable<AcceptanceBase, 2> acceptance_bases{
    {{"all_trials", AcceptanceBase::all_trials}, {"not_upward", AcceptanceBase::not_upward}}};
inline constexpr NameTable<Lattice, 2> lattices{{{"hcp", Lattice::hcp}, {"fcc", Lattice::fcc}}};
inline constexpr NameTable<Sampler, 2> samplers{
    {{"exhaustive", Sampler::exhaustive}, {"skipping", Sampler::rejection_free}}};
inline constexpr NameTable<Streams, 2> stream_kinds{
    {{"independent", Streams::independent}, {"matched", Streams::matched}}};

template <class Enum, std::size_t n>
std::string name_in(const NameTable<Enum, n>& names, Enum value) {
  for (const auto& [name, enumerator] : names) {
    if (enumerator == value) return std::string(name);
  }
  throw std::logic_error("an enumerator that scenes have no name for");
}

template <class Enum, std::size_t n>
std::vector<std::string> names_in(const NameTable<Enum, n>& names) {
  std::vector<std::string> all;
  for (const auto& [name, enumerator] : names) all.emplace_back(name);
  return all;
}

}  // namespace jostle::inline config
