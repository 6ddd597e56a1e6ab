#pragma once

#include <chrono>

namespace jostle {

using Seconds = std::chrono::duration<double>;

}  // namespace jostle
