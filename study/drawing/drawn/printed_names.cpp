#include "study/drawing/drawn/printed_names.hpp"

#include <algorithm>
#include <map>
#include <string_view>
#include <utility>

namespace jostle::inline study {
namespace {

bool is_letter_or_digit(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

/// True if the text at this place is a name, not a part of one: "Phi_b" has "Phi", "alpha_line" has
/// no "alpha".
bool stands_alone(std::string_view text, std::size_t index, std::size_t length) {
  if (index > 0 && (is_letter_or_digit(text[index - 1]) || text[index - 1] == '_')) return false;
  const std::string_view rest = text.substr(index + length);
  if (rest.empty()) return true;
  if (rest[0] != '_') return !is_letter_or_digit(rest[0]);
  return rest.size() >= 2 && is_letter_or_digit(rest[1]) &&
         (rest.size() == 2 || !(is_letter_or_digit(rest[2]) || rest[2] == '_'));
}

constexpr std::pair<std::string_view, std::string_view> letters[] = {
    {"Phi", "Φ"},    {"phi", "Φ"}, {"alpha", "α"}, {"beta", "β"},   {"epsilon", "ε"},
    {"sigma", "σ"},  {"tau", "τ"}, {"mu", "μ"},    {"xi", "ξ"},     {"chi", "χ"},
    {"lambda", "λ"}, {"rho", "ρ"}, {"theta", "θ"}, {"A_inf", "A_∞"}};

constexpr std::pair<std::string_view, std::string_view> signs[] = {
    {"<Z>", "⟨Z⟩"},
    {"Solids fraction", "Packing fraction"},
    {"solids fraction", "packing fraction"},
    {"energy a sphere", "energy per sphere"},
    {"force a sphere", "force per sphere"}};

/// "^2" and "^3" after a letter, a digit or a bracket, where no further digit follows.
void replace_powers(std::string& text) {
  for (const auto& [power, sign] : {std::pair{"^2", "²"}, std::pair{"^3", "³"}}) {
    for (std::size_t index = 0; (index = text.find(power, index)) != std::string::npos;) {
      const bool ends =
          index + 2 == text.size() || !(is_letter_or_digit(text[index + 2]) ||
                                        text[index + 2] == '.' || text[index + 2] == '/');
      if (ends) text.replace(index, 2, sign);
      ++index;
    }
  }
}

}  // namespace

std::string words(std::string name) {
  if (name == "s_0_of_line") return "S(0) by a line in k";
  if (name == "s_0_of_squares") return "S(0) by a line in k²";
  std::ranges::replace(name, '_', ' ');
  return name;
}

std::string printed_name(const std::string& name) {
  static const std::map<std::string, std::string> symbols{
      {"alpha", "gradient α"},
      {"phi_region", "packing fraction Φ"},
      {"phi", "packing fraction Φ of the region"},
      {"eq7_phi_0", "Φ_0 of eq. 7"},
      {"eq7_alpha", "α of eq. 7"},
      {"eq7_beta", "β of eq. 7"},
      {"eq7_z_star", "z* of eq. 7"},
      {"eq7_status", "fit of eq. 7"},
      {"lateral", "packing fraction Φ of the profile near its walls"},
      {"lateral_change", "change of Φ of the profile near its walls"},
      {"central", "packing fraction Φ of the middle of the profile"},
      {"central_change", "change of Φ of the middle of the profile"},
      {"n_c", "coordination N_c"},
      {"n_c_all", "coordination N_c of all spheres"},
      {"n_spheres", "spheres of the region"},
      {"normal_mean", "mean of the normal law"},
      {"normal_width", "width of the normal law"},
      {"q4", "bond order q_4"},
      {"q6", "bond order q_6"},
      {"w6", "bond order w_6"},
      {"fcc", "fcc share"},
      {"hcp", "hcp share"},
      {"disordered", "disordered share"},
      {"mean_faces", "mean number of faces"},
      {"mean_free_volume", "mean free volume v_f"},
      {"sigma_free_volume", "σ of the free volumes"},
      {"mean_local_fraction", "mean local packing fraction"},
      {"mean_volume", "mean volume of a cell"},
      {"n_cells", "number of cells"},
      {"k", "k from mean and variance"},
      {"k_gamma_k", "k of the k-gamma law"},
      {"k_gamma_status", "fit of the k-gamma law"},
      {"n_pores", "number of pores"},
      {"nu", "mean pore volume ν"},
      {"mean_touched", "spheres that a pore touches"},
      {"tetrahedral", "share of tetrahedral pores"},
      {"octahedral", "share of octahedral pores"},
      {"tail_v0", "v_0 of the tail"},
      {"tail_status", "fit of the tail"},
      {"unclassified", "share in no canonical hole"},
      {"contacts", "contacts Z"},
      {"backbone_contacts", "contacts Z without rattlers"},
      {"rattlers", "share of rattlers"},
      {"gap_exponent", "gap exponent γ"}};
  const auto found = symbols.find(name);
  return found == symbols.end() ? words(name) : found->second;
}

std::string in_print(const std::string& text) {
  std::string printed;
  for (std::size_t index = 0; index < text.size();) {
    const std::string_view rest = std::string_view(text).substr(index);
    const auto* const sign = std::ranges::find_if(
        signs, [&](const auto& sign_text) { return rest.starts_with(sign_text.first); });
    const auto* const letter = std::ranges::find_if(letters, [&](const auto& greek) {
      return rest.starts_with(greek.first) && stands_alone(text, index, greek.first.size());
    });
    if (sign != std::end(signs)) {
      printed += sign->second;
      index += sign->first.size();
    } else if (letter != std::end(letters)) {
      printed += letter->second;
      index += letter->first.size();
    } else {
      printed += text[index++];
    }
  }
  replace_powers(printed);
  return printed;
}

}  // namespace jostle::inline study
