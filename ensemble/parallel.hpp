#pragma once

#include <functional>

namespace jostle::inline ensemble {

/// Makes `threads` calls of `work`, on as many threads (this one among them), and returns when all
/// have ended. What happened before is visible to every call, and what the calls did is visible
/// afterwards. `work` must not throw. Requires threads >= 1.
void on_threads(int threads, const std::function<void()>& work);

}  // namespace jostle::inline ensemble
