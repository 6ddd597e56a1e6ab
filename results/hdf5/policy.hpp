#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "results/hdf5/write.hpp"

// Features of HDF5 that results files never use. The seal is a checksum and no signature: anybody
// can seal a file that leads elsewhere, in circles, or that claims to hold more than it does. All
// throw Hdf5Error.
namespace jostle::inline results {

/// Refuses soft, external and user-defined links: data behind them are not under the seal.
void require_hard_link(hid_t parent, const std::string& name);

/// Refuses a dataset whose values lie in other files (external storage, virtual datasets), that
/// needs filters other than shuffle and deflate, or that claims more values than its bytes can
/// hold.
void require_plain_dataset(hid_t dataset, const std::string& name);

/// Refuses more dimensions or elements than anything has that fits on a disk.
void require_plausible_shape(const Shape& shape);

/// Refuses an object with thousands of attributes, which HDF5 takes hours to list.
void require_few_attributes(hid_t object);

/// A member of a group, and its address in the file.
struct Member {
  std::string name;
  haddr_t address;
};
/// In the order of their names; links other than hard ones are refused.
std::vector<Member> members_of(hid_t group);

/// The groups that a walk from group to group has entered: none twice, as in a circle, and none
/// deeper than tables lie.
class Walk {
 public:
  void enter(const Member& member, const std::string& path);

 private:
  std::set<haddr_t> entered_;
};

}  // namespace jostle::inline results
