#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

// Results files as somebody would forge them: whatever HDF5's own functions can do to a file, and
// then the seal made anew. Used with random numbers by a test, and with libFuzzer's bytes.
namespace jostle::synthetic {

/// Whole numbers that decide about changes: bytes, and zeros once they are used up.
class Choices {
 public:
  explicit Choices(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  bool any_left() const { return !bytes_.empty(); }
  /// 0 .. n - 1.
  std::size_t integer_below(std::size_t n);

 private:
  std::span<const std::uint8_t> bytes_;
};

/// The kinds of change that forge() makes.
inline constexpr std::size_t n_forgeries = 14;
const char* forgery_name(std::size_t kind);

/// Makes one change of a kind somewhere in a sealed results file, and seals it again. Changes that
/// HDF5 rejects are skipped.
void forge(const std::string& path, std::size_t kind, Choices& choices);

/// Everything that the program does with a file that it is given. Returns how many of its uses
/// refused it; any exception but those that a command turns into a message gets out.
int use_in_every_way(const std::string& path);

/// How many uses there are.
int n_uses();

}  // namespace jostle::synthetic
