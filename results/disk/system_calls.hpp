#pragma once

#include <sys/stat.h>

#include <unistd.h>
#include <array>
#include <cstdint>
#include <utility>

// Calls that systems name differently, or that only Linux has.
namespace jostle::inline results {

/// Makes a pipe, {read end, write end}, that programs started later do not inherit. Returns false
/// where the system refuses.
bool open_pipe(std::array<int, 2>& ends);

/// The time of a file's last change since 1970.
struct ChangeTime {
  std::int64_t seconds, nanoseconds;
};
ChangeTime change_time(const struct stat& status);

/// Distinguishes process `pid` of this host from later ones with its number: the time of its start,
/// in clock ticks since the system's (field 22 of /proc/PID/stat). 1 for every living process where
/// there is no /proc. 0 where there is no such process, or one that has ended and that nobody has
/// reaped; without /proc only a child of this process is seen to have ended so.
std::uint64_t start_time_of(long pid);

/// An open file descriptor, closed when it goes; -1 is none.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int descriptor) : descriptor_(descriptor) {}
  Descriptor(Descriptor&& source) noexcept : descriptor_(std::exchange(source.descriptor_, -1)) {}
  Descriptor& operator=(Descriptor&& source) noexcept {
    std::swap(descriptor_, source.descriptor_);
    return *this;
  }
  ~Descriptor() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }

  explicit operator bool() const { return descriptor_ >= 0; }
  int get() const { return descriptor_; }

 private:
  int descriptor_ = -1;
};

}  // namespace jostle::inline results
