#pragma once

#include <string>

// Names and texts of results files as a journal prints them.
namespace jostle::inline study {

/// "mean_height": "mean height".
std::string words(std::string name);
/// A quantity with its symbol: "coordination N_c" for "n_c". A quantity without a symbol is in
/// words.
std::string printed_name(const std::string& name);
/// A text with Greek letters and signs in place of their names: "Φ_b" of "Phi_b", "⟨Z⟩" of "<Z>",
/// "ξ³" of "xi^3". Names that are parts of words stay.
std::string in_print(const std::string& text);

}  // namespace jostle::inline study
