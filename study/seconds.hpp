#pragma once

#include <chrono>

namespace jostle::inline study {

using Seconds = std::chrono::duration<double>;

}  // namespace jostle::inline study
