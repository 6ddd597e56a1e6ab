#include "results/file/contents.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <unordered_map>

#include "results/disk/checksum.hpp"
#include "results/file/content_walk.hpp"
#include "results/file/results_file.hpp"
#include "results/file/tables.hpp"
#include "results/hdf5/child_process.hpp"
#include "results/hdf5/policy.hpp"
#include "results/hdf5/read.hpp"

namespace jostle::inline results {
namespace {

constexpr const char *folder = "provenance/contents", *folder_path = "/provenance/contents";
constexpr const char* root = "root";  // the items of the root itself
constexpr const char* method_attribute = "method";
constexpr std::uint32_t method = 1;  // raised when the hashes are made in another way

using Hash = std::uint64_t;
using HashesByGroup = std::map<std::string, std::vector<Hash>>;

bool is_contents(const std::string& path) {
  return path == folder_path;
}

/// The group below the root that contains a path.
std::string group_of(const std::string& path) {
  return path == "/" ? root : path.substr(1, path.find('/', 1) - 1);
}

/// The first 64 bits of the SHA-256 of every item, and of the lists of names.
class ItemHashes : public ContentSink {
 public:
  void begin(const std::string& path, const std::string& attribute) override {
    end();
    path_ = path;
    description_ = attribute.empty() ? path : fmt::format("attribute {} of {}", attribute, path);
    sum_.emplace();
  }
  void add(std::span<const std::byte> bytes) override { sum_->add(bytes); }
  void names(const std::string& path, const char* kind,
             const std::vector<std::string>& names) override {
    begin(path, "");
    description_ = fmt::format("the list of {} of {}", kind, path);
    is_list_ = true;
    ContentSink::add(fmt::format("{} {}\n", path, kind));
    for (const std::string& name : names)
      if (!is_contents(path + "/" + name))
        ContentSink::add(fmt::format("{}:{}", name.size(), name));
  }

 protected:
  struct Item {
    std::string path, description;
    bool is_list;
  };
  virtual void take(const Item& item, Hash hash) = 0;

  void end() {
    if (!sum_) return;
    const Sha256::Sum sum = sum_->finish();
    Hash hash = 0;
    for (std::size_t i = 0; i < sizeof(Hash); ++i)
      hash |= Hash{std::to_integer<std::uint8_t>(sum[i])} << (8 * i);
    take({path_, description_, is_list_}, hash);
    sum_.reset();
    is_list_ = false;
  }

 private:
  std::optional<Sha256> sum_;
  std::string path_, description_;
  bool is_list_ = false;
};

class CollectedHashes : public ItemHashes {
 public:
  HashesByGroup finish() {
    end();
    return std::move(hashes_);
  }

 private:
  void take(const Item& item, Hash hash) override { hashes_[group_of(item.path)].push_back(hash); }

  HashesByGroup hashes_;
};

/// Finds the items that were not there.
class ComparedHashes : public ItemHashes {
 public:
  explicit ComparedHashes(const HashesByGroup& stored) {
    for (const auto& [group, hashes] : stored)
      for (const Hash hash : hashes) ++missing_[hash];
  }

  std::vector<std::string> finish() {
    end();
    std::vector<std::string> changes;
    for (const Item& item : changed_)
      if (!item.is_list || !explains(item)) changes.push_back(item.description);
    const bool any_gone =
        std::ranges::any_of(missing_, [](const auto& entry) { return entry.second > 0; });
    if (changes.empty() && any_gone) changes.emplace_back("something that is no longer there");
    return changes;
  }

 private:
  void take(const Item& item, Hash hash) override {
    const auto found = missing_.find(hash);
    if (found != missing_.end() && found->second > 0)
      --found->second;
    else
      changed_.push_back(item);
  }

  /// True if another change explains a changed list of names: the added name is reported.
  bool explains(const Item& list) const {
    const std::string prefix = list.path == "/" ? "/" : list.path + "/";
    return std::ranges::any_of(changed_, [&](const Item& item) {
      return !item.is_list && (item.path == list.path || item.path.starts_with(prefix));
    });
  }

  std::unordered_map<Hash, std::uint32_t> missing_;
  std::vector<Item> changed_;
};

void write_group(hid_t contents, const std::string& name, const std::vector<Hash>& hashes) {
  if (exists(contents, name)) checked(H5Ldelete(contents, name.c_str(), H5P_DEFAULT));
  make_axis(write_numbers(contents, name, hashes), name);
}

HashesByGroup read_hashes(hid_t file) {
  if (!exists(file, folder))
    throw Hdf5Error(
        "another program opened it for writing, and it holds no hashes of its contents that could "
        "show that they are the old ones: not written by jostle, or by a version before 0.2.0; "
        "restore it from a copy");
  const Hdf5Handle contents = open_group(file, folder);
  if (read_number_attribute<std::uint32_t>(contents, method_attribute) != method)
    throw Hdf5Error(
        "another program opened it for writing, and the hashes of its contents come from another "
        "version of jostle: verify it with that version");
  HashesByGroup hashes;
  for (const Member& member : members_of(contents))
    hashes[member.name] = read_numbers<Hash>(contents, member.name);
  return hashes;
}

}  // namespace

void write_contents(hid_t file) {
  CollectedHashes hashes;
  const Hdf5Handle contents = create_group(file, folder);
  write_attribute(contents, method_attribute, method);
  walk_contents(file, is_contents, hashes);
  for (const auto& [group, of_group] : hashes.finish()) write_group(contents, group, of_group);
}

void update_contents(hid_t file, std::span<const std::string> groups) {
  if (!exists(file, folder)) return write_contents(file);
  const auto is_left_out = [&](const std::string& path) {
    return std::ranges::find(groups, group_of(path)) == groups.end();
  };
  CollectedHashes hashes;
  walk_contents(file, is_left_out, hashes);
  const Hdf5Handle contents = open_group(file, folder);
  for (const auto& [group, of_group] : hashes.finish()) write_group(contents, group, of_group);
}

std::vector<std::string> changed_contents(hid_t file) {
  const HashesByGroup stored = read_hashes(file);
  ComparedHashes found(stored);
  walk_contents(file, is_contents, found);
  return found.finish();
}

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
  constexpr std::array extra_paths{"/provenance", "/timing", "/h5md"};
  return std::ranges::find(extra_paths, path) != extra_paths.end() ||
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
