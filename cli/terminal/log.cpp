#include "cli/terminal/log.hpp"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "results/disk/printable.hpp"

namespace jostle::inline cli {

void begin_log() {
  const auto log = spdlog::stderr_color_mt("jostle");
  log->set_pattern("%T jostle: %v");
  spdlog::set_default_logger(log);
}

void log_line(const std::string& text) {
  spdlog::default_logger_raw()->info(printable(text));
}

void silence_log() {
  spdlog::set_level(spdlog::level::warn);
}

}  // namespace jostle::inline cli
