#include "cli/terminal/failure.hpp"

#include <fmt/format.h>

#include <new>
#include <string_view>
#include <system_error>

namespace jostle {
namespace {

bool is_want_of_threads(const std::exception& error) {
  const auto* system = dynamic_cast<const std::system_error*>(&error);
  if (system != nullptr) return system->code() == std::errc::resource_unavailable_try_again;
  return std::string_view(error.what()).starts_with("pthread_create");  // TBB's, without a code
}

}  // namespace

std::string failure_text(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) {
    return "out of memory; raise the limit (ulimit -v, a job's memory), use fewer --threads, or "
           "keep fewer snapshots";
  }
  if (is_want_of_threads(error)) {
    return fmt::format(
        "cannot start a thread: {}; raise the limit on threads or memory (ulimit -u, ulimit -v), "
        "or use fewer --threads",
        error.what());
  }
  return error.what();
}

}  // namespace jostle
