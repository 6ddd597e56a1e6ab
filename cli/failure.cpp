#include "cli/failure.hpp"

#include <fmt/format.h>

#include <algorithm>
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

constexpr std::size_t longest_line = 2000;

/// Bytes of the character of UTF-8 that `text` begins with; 0 where it is none, or controls.
std::size_t character_length(std::string_view text) {
  const auto first = static_cast<unsigned char>(text[0]);
  if (first < 0x80) return first == '\t' || (first >= 0x20 && first != 0x7f) ? 1 : 0;
  const std::size_t length = first >= 0xf8 ? 0 : first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || length > text.size()) return 0;
  if (first == 0xc2 && static_cast<unsigned char>(text[1]) < 0xa0) return 0;  // controls
  const auto continues = [](char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; };
  return std::ranges::all_of(text.substr(1, length - 1), continues) ? length : 0;
}

std::string printable_line(std::string_view line) {
  std::string shown;
  while (!line.empty() && shown.size() < longest_line) {
    const std::size_t length = character_length(line);
    if (length == 0) {
      shown += fmt::format("\\x{:02x}", static_cast<unsigned char>(line[0]));
    } else {
      shown += line.substr(0, length);
    }
    line.remove_prefix(std::max<std::size_t>(1, length));
  }
  if (!line.empty()) shown += "...";
  return shown;
}

}  // namespace

std::string printable(std::string_view text) {
  std::string shown;
  for (;;) {
    const std::size_t end = text.find('\n');
    shown += printable_line(text.substr(0, end));
    if (end == std::string_view::npos) return shown;
    shown += '\n';
    text.remove_prefix(end + 1);
  }
}

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
