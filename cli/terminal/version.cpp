#include "cli/terminal/version.hpp"

#include <fmt/format.h>
#include <spdlog/version.h>
#include <tbb/version.h>
#include <CLI/Version.hpp>

#include "config/json/json.hpp"
#include "results/content/study.hpp"
#include "study/version.hpp"

namespace jostle::inline cli {

std::string version_text() {
#ifdef __clang__
  const std::string compiler = fmt::format("clang {}", __clang_version__);
#else
  const std::string compiler = fmt::format("g++ {}", __VERSION__);
#endif
  return fmt::format(
      "jostle {} (git {})\n"
      "compiler {}\n"
      "{}, oneTBB {}, nlohmann-json {}, CLI11 {}, fmt {}.{}.{}, spdlog {}.{}.{}",
      version(), git_revision(), compiler, provenance_of_this_machine().libraries,
      TBB_runtime_version(), json_library_version(), CLI11_VERSION, FMT_VERSION / 10000,
      FMT_VERSION / 100 % 100, FMT_VERSION % 100, SPDLOG_VER_MAJOR, SPDLOG_VER_MINOR,
      SPDLOG_VER_PATCH);
}

}  // namespace jostle::inline cli
