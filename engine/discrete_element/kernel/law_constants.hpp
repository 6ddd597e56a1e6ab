#pragma once

namespace jostle::inline engine {

/// Constants of the laws for a kind of contact: two spheres, or a sphere and a side.
struct LawConstants {
  double stiffness = 0;      // stiffness of loading: K1; of the linear spring: k_n
  double unloading = 0;      // K2 = K1 / e^2
  double latched = 0;        // 1 - e^2, so that a0 = latched x the greatest overlap
  double tangential = 0;     // K0; of the linear spring: k_t
  double friction = 0;       // mu
  double damping = 0;        // damping of the linear spring: the normal dashpot, force / velocity
  double shear_damping = 0;  // the tangential one
  double time_step = 0;
};

}  // namespace jostle::inline engine
