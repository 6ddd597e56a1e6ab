#include "study/drawing/drawn/printed_names.hpp"

#include <catch2/catch.hpp>

namespace jostle {

TEST_CASE("Quantities have the symbols of print, others are words") {
  CHECK(printed_name("n_c") == "coordination N_c");
  CHECK(printed_name("phi_region") == "packing fraction Φ");
  CHECK(printed_name("mean_height") == "mean height");
  CHECK(printed_name("s_0_of_squares") == "S(0) by a line in k²");
}

TEST_CASE("Names of letters become letters if they are words of their own") {
  CHECK(in_print("Solids fraction Phi_b between the floor and 2 d") ==
        "Packing fraction Φ_b between the floor and 2 d");
  CHECK(in_print("Elastic energy a sphere") == "Elastic energy per sphere");
  CHECK(in_print("contacts with force a sphere when the tap ended") ==
        "contacts with force per sphere when the tap ended");
  CHECK(in_print("height <Z> of xi^3, tau > 2") == "height ⟨Z⟩ of ξ³, τ > 2");
  CHECK(in_print("mu is 0.1: t/t_W^mu, A_inf") == "μ is 0.1: t/t_W^μ, A_∞");
  // Parts of words and names of several letters stay.
  CHECK(in_print("much, alphabet, phi_x and eq7_alpha") == "much, alphabet, Φ_x and eq7_alpha");
  CHECK(in_print("alpha_line_error, (3/2)^(1/2), x^2.5") == "alpha_line_error, (3/2)^(1/2), x^2.5");
  CHECK(in_print("").empty());
}

}  // namespace jostle
