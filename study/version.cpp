#include "study/version.hpp"

namespace jostle::inline study {

const char* version() {
  return JOSTLE_VERSION;
}

}  // namespace jostle::inline study
