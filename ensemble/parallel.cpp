#include "ensemble/parallel.hpp"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_group.h>

#include <cassert>

// All use of TBB. The thread sanitizer cannot see how TBB hands tasks over, for its library is
// built without; so this file is compiled with instrumentation in the tsan build
// (ensemble/CMakeLists.txt), and annotations describe its guarantees of visibility to the
// sanitizer. Whatever `work` does is still watched.
#ifdef JOSTLE_TSAN
#include <sanitizer/tsan_interface.h>
#endif

namespace jostle::inline ensemble {

namespace {

#ifdef JOSTLE_TSAN
void release(void* point) {
  __tsan_release(point);
}
void acquire(void* point) {
  __tsan_acquire(point);
}
#else
void release(void*) {}
void acquire(void*) {}
#endif

}  // namespace

void on_threads(int threads, const std::function<void()>& work) {
  assert(threads >= 1);
  namespace tbb = oneapi::tbb;
  // The requested number, even if the machine has fewer processors.
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  char begun = 0, ended = 0;  // points of handing over, for the sanitizer
  release(&begun);
  arena.execute([&] {
    tbb::task_group calls;
    for (int i = 0; i < threads; ++i) {
      calls.run([&] {
        acquire(&begun);
        work();
        release(&ended);
      });
    }
    calls.wait();
  });
  acquire(&ended);
}

}  // namespace jostle::inline ensemble
