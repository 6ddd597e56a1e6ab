#include "results/file/digest.hpp"

#include <algorithm>
#include <array>

#include "results/disk/checksum.hpp"
#include "results/file/content_walk.hpp"
#include "results/file/results_file.hpp"
#include "results/file/tables.hpp"
#include "results/hdf5/child_process.hpp"
#include "results/hdf5/read.hpp"

namespace jostle::inline results {
namespace {

/// A SHA-256 over the bytes of all items.
class Digest : public ContentSink {
 public:
  void begin(const std::string&, const std::string&) override {}
  void names(const std::string&, const char*, const std::vector<std::string>&) override {}
  void add(std::span<const std::byte> bytes) override { sum_.add(bytes); }
  std::string text() { return hex(sum_.finish()); }

 private:
  Sha256 sum_;
};

/// Contents that depend on who made the numbers, or can be made of them again.
bool is_beside_the_data(const std::string& path) {
  constexpr std::array beside{"/provenance", "/timing", "/h5md"};
  return std::ranges::find(beside, path) != beside.end() ||
         std::ranges::any_of(derived_groups,
                             [&](const char* name) { return path == std::string("/") + name; });
}

}  // namespace

std::string data_digest(hid_t file) {
  Digest digest;
  walk_contents(file, is_beside_the_data, digest);
  return digest.text();
}

std::string digest_of(const std::string& path) {
  return naming_file(path, [&] {
    return in_child_process([&] {
      const ResultsFile valid(path);  // refuses what the walk would trust
      return data_digest(open_to_read(path));
    });
  });
}

}  // namespace jostle::inline results
