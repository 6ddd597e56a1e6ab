#include "config/json/suggestion.hpp"

#include <catch2/catch.hpp>

namespace jostle {

TEST_CASE("Edit distance counts insertions, deletions, replacements and exchanges") {
  CHECK(edit_distance("", "") == 0);
  CHECK(edit_distance("dilate", "dilate") == 0);
  CHECK(edit_distance("dilat", "dilate") == 1);
  CHECK(edit_distance("ditale", "dilate") == 2);
  CHECK(edit_distance("heigth", "height") == 1);
  CHECK(edit_distance("kitten", "sitting") == 3);
  CHECK(edit_distance("", "lift") == 4);
}

TEST_CASE("The nearest candidate is suggested, and none that is far") {
  const std::vector<std::string> taps{"dilate", "dilate_floor_held", "lift", "shake"};
  CHECK(did_you_mean("dilat", taps) == " Did you mean \"dilate\"?");
  CHECK(did_you_mean("floor_held", taps) == " Did you mean \"dilate_floor_held\"?");
  CHECK(did_you_mean("DILATE", taps) == " Did you mean \"dilate\"?");
  CHECK(did_you_mean("shkae", taps) == " Did you mean \"shake\"?");
  CHECK(did_you_mean("vibration", taps).empty());
  CHECK(did_you_mean("", taps).empty());
}

TEST_CASE("A quantity that papers name otherwise has a hint, a misspelt key its nearest") {
  const std::vector<std::string> keys{"spheres", "start", "protocol"};
  CHECK(key_hint("acceleration", keys).find("Gamma") != std::string::npos);
  CHECK(key_hint("polydispersity", keys).find("kinds of a mixture") != std::string::npos);
  CHECK(key_hint("friction", keys).find("discrete_element") != std::string::npos);
  CHECK(key_hint("gravity", keys).find("along -z") != std::string::npos);
  CHECK(key_hint("n_particles", keys).find("\"spheres\"") != std::string::npos);
  // "acceleration" is near "realizations", and no slip of it.
  CHECK(key_hint("acceleration", {"realizations"}).find("Gamma") != std::string::npos);
  CHECK(key_hint("diameters", {"diameter"}) == " Did you mean \"diameter\"?");
  CHECK(key_hint("radius", keys).find("kinds of a mixture") != std::string::npos);
  CHECK(key_hint("radius", {"sides", "width"}).find("\"cylinder\"") != std::string::npos);
  CHECK(key_hint("sphere", keys) == " Did you mean \"spheres\"?");
  CHECK(key_hint("colour", keys).empty());
}

}  // namespace jostle
