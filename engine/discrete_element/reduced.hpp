#pragma once

#include "engine/discrete_element/discrete_element.hpp"
#include "engine/discrete_element/kernel/grain_rows.hpp"
#include "engine/discrete_element/kernel/law_constants.hpp"

namespace jostle::inline engine {

/// Settings in the engine's own units: lengths in diameters, masses in sphere masses, times in
/// sqrt(diameter / gravity).
struct ReducedSettings {
  GrainLaw law = GrainLaw::walton_braun;
  LawConstants spheres, floor, sides;
  double gravity = 1;
  double time_step = 0;
  double seconds = 1;  // seconds of the unit of time
  double contact_time =
      0;  // contact of the two lightest spheres: (pi / 2) sqrt(m / 2 K1) (1 + e) of Walton
          // & Braun; of the linear spring half a period of the damped oscillation
};

/// Constants are those of spheres of mass 1, the time step that of the lightest. Throws
/// std::invalid_argument where spheres, floor and sides have not one kind of law.
ReducedSettings reduced(const DiscreteElement& settings, const LightestMasses& lightest = {});

}  // namespace jostle::inline engine
