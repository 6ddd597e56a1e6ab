#pragma once

#include <hdf5.h>

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace jostle::inline results {

/// Receives what an HDF5 file holds, item by item. An item is a group, the values of a dataset, one
/// attribute, or one axis of a dataset; its bytes begin with a line "path kind ..." and do not
/// depend on chunks, compression, byte order and places in the file.
class ContentSink {
 public:
  virtual ~ContentSink() = default;

  /// The following bytes belong to another item. `attribute` is empty for other kinds.
  virtual void begin(const std::string& path, const std::string& attribute) = 0;
  virtual void add(std::span<const std::byte> bytes) = 0;
  /// Names of all members of a group, or of all attributes of an object, in their order: no item.
  virtual void names(const std::string& path, const char* kind,
                     const std::vector<std::string>& names) = 0;

  void add(std::string_view text) { add(std::as_bytes(std::span(text))); }
};

/// Hands the sink the attributes of the root, then every object in the order of its path: its own
/// bytes, its attributes in the order of their names, its axes. `is_left_out` names what is passed
/// over, with what is below it; paths begin with a slash. Throws Hdf5Error also for what no results
/// file has.
void walk_contents(hid_t file, const std::function<bool(const std::string& path)>& is_left_out,
                   ContentSink& sink);

}  // namespace jostle::inline results
