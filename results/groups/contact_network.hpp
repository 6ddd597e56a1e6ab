#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "engine/bed/bed_mechanics.hpp"
#include "engine/bed/container.hpp"
#include "results/hdf5/handle.hpp"

namespace jostle::inline results {

/// Contacts of the snapshot of a tap.
struct ContactFrame {
  std::uint64_t tap = 0, n_contacts = 0;
};

/// Writes `contacts` into a group of /particles: step and offset, [step], and along `contact`,
/// frame after frame, what Contact has. Without contacts it writes nothing.
void write_contacts(hid_t group, const Container& container, std::uint32_t n_spheres,
                    std::span<const ContactFrame> frames,
                    const std::function<std::vector<Contact>(std::uint64_t tap)>& contacts_at);

/// Such contacts, read frame by frame. Throws Hdf5Error, also for contacts of other spheres and
/// walls than there are, and where two spheres touch twice.
class ContactNetwork {
 public:
  ContactNetwork() = default;  // without frames
  ContactNetwork(hid_t group, std::uint32_t n_spheres, const Container& container);
  /// In that frame; 0 where there is none.
  std::uint64_t n_contacts(std::uint64_t tap) const;
  std::vector<Contact> contacts(std::uint64_t tap) const;

 private:
  struct Extent {
    std::uint64_t first = 0, n = 0;
  };
  Extent extent_of(std::uint64_t tap) const;

  std::uint32_t n_spheres_ = 0, n_walls_ = 0;
  std::vector<std::uint64_t> taps_, ends_;  // [n_frames]
  Hdf5Handle first_, second_, overlap_, normal_force_, normal_, tangential_force_;
};

}  // namespace jostle::inline results
