#include "study/version.hpp"

namespace jostle {

const char* version() {
  return JOSTLE_VERSION;
}

}  // namespace jostle
