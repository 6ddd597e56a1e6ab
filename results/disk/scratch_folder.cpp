#include "results/disk/scratch_folder.hpp"

#include <fmt/format.h>
#include <stdlib.h>

#include <cerrno>
#include <system_error>

#include "results/disk/error.hpp"
#include "results/disk/output_path.hpp"

namespace jostle::inline results {

ScratchFolder::ScratchFolder(const std::string& purpose, const std::filesystem::path& within) {
  std::string name = (within / fmt::format("jostle-{}-XXXXXX", purpose)).string();
  output_path(name);  // refuses links of others on the way
  if (::mkdtemp(name.data()) == nullptr) {
    const std::string reason = std::generic_category().message(errno);
    throw ResultsError(within.string(), fmt::format("cannot make a folder there ({})", reason));
  }
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace jostle::inline results
