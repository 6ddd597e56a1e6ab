#pragma once

#include <functional>

namespace jostle::inline ensemble {

/// Makes `threads` calls of `work`, on as many threads (this one among them), and returns when all
/// have ended. Earlier writes are visible to every call, and writes of the calls are visible
/// afterwards. `work` must not throw. Requires threads >= 1.
void on_threads(int threads, const std::function<void()>& work);

}  // namespace jostle::inline ensemble
