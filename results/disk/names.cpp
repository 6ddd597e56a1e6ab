#include "results/disk/names.hpp"

#include <fmt/format.h>
#include <limits.h>
#include <unistd.h>

#include <algorithm>
#include <span>

#include "results/disk/checksum.hpp"
#include "results/disk/error.hpp"
#include "results/disk/publish.hpp"

namespace jostle::inline results {
namespace {

std::size_t start_of_name(const std::string& path) {
  return path.find_last_of('/') + 1;  // 0 without a folder
}

}  // namespace

std::size_t longest_name_beside(const std::string& path) {
  const long longest = ::pathconf(folder_of(path).c_str(), _PC_NAME_MAX);
  return longest > 0 ? static_cast<std::size_t>(longest) : NAME_MAX;
}

std::string path_with_ending(const std::string& path, std::string_view ending) {
  const std::size_t longest = longest_name_beside(path), start = start_of_name(path);
  const std::string name = path.substr(start);
  if (name.size() + ending.size() <= longest) return path + std::string(ending);
  constexpr std::size_t digits = 16;
  std::size_t kept = longest - std::min(longest, ending.size() + 1 + digits);
  const auto is_inside_character = [&](std::size_t index) {
    return (static_cast<unsigned char>(name[index]) & 0xc0u) == 0x80u;
  };
  while (kept > 0 && is_inside_character(kept)) --kept;
  return fmt::format("{}{}~{}{}", path.substr(0, start), name.substr(0, kept),
                     hex(sha256(std::as_bytes(std::span(name)))).substr(0, digits), ending);
}

void require_name_fits(const std::string& path) {
  const std::size_t longest = longest_name_beside(path), size = path.size() - start_of_name(path);
  if (size > longest)
    throw ResultsError(path, fmt::format("has a name of {} bytes, and its folder takes up to {}; "
                                         "choose a shorter one",
                                         size, longest));
  if (path.size() >= PATH_MAX)
    throw ResultsError(path, fmt::format("is a path of {} bytes, and the system takes up to {}; "
                                         "choose a shorter one",
                                         path.size(), PATH_MAX - 1));
}

}  // namespace jostle::inline results
