#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

// Plain values to bytes and back: little-endian, no padding, lengths as 64-bit counts.
namespace jostle::inline engine {

static_assert(std::endian::native == std::endian::little,
              "states and results are written little-endian");

class ByteWriter {
 public:
  template <class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void put(T value) {
    const auto* first = reinterpret_cast<const std::byte*>(&value);
    bytes_.insert(bytes_.end(), first, first + sizeof value);
  }
  /// Elements without padding: bytes, doubles, Vec3, HeightWindow.
  template <class T>
  void put(const std::vector<T>& values) {
    static_assert(std::is_same_v<T, std::byte> ||
                  (std::is_trivially_copyable_v<T> && sizeof(T) % sizeof(double) == 0));
    put<std::uint64_t>(values.size());
    const auto raw = std::as_bytes(std::span(values));
    bytes_.insert(bytes_.end(), raw.begin(), raw.end());
  }
  void put(const std::string& text) {
    put<std::uint64_t>(text.size());
    const auto raw = std::as_bytes(std::span(text));
    bytes_.insert(bytes_.end(), raw.begin(), raw.end());
  }

  std::vector<std::byte>& bytes() { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

/// Throws std::out_of_range where the bytes end too early.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : rest_(bytes), size_(bytes.size()) {}

  /// Bytes that were read.
  std::uint64_t position() const { return size_ - rest_.size(); }

  template <class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T> T get() {
    T value;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  bool get_flag() {
    const auto value = get<std::uint8_t>();
    if (value > 1) throw std::out_of_range("no flag");
    return value != 0;
  }
  /// An enumerator from 0 up to `last`.
  template <class Enum>
  Enum get_enum(Enum last) {
    using Underlying = std::underlying_type_t<Enum>;
    static_assert(std::is_unsigned_v<Underlying>);
    const auto value = get<Underlying>();
    if (value > static_cast<Underlying>(last)) throw std::out_of_range("no such name");
    return static_cast<Enum>(value);
  }
  template <class T>
  std::vector<T> get_vector() {
    const auto n = get<std::uint64_t>();
    if (n > rest_.size() / sizeof(T)) throw std::out_of_range("too short");
    std::vector<T> values(n);
    if (n > 0) std::memcpy(values.data(), take(n * sizeof(T)).data(), n * sizeof(T));
    return values;
  }
  /// Reads past a vector; returns its length.
  template <class T>
  std::uint64_t skip_vector() {
    const auto n = get<std::uint64_t>();
    if (n > rest_.size() / sizeof(T)) throw std::out_of_range("too short");
    take(n * sizeof(T));
    return n;
  }
  std::string get_string() {
    const auto raw = take(get<std::uint64_t>());
    return {reinterpret_cast<const char*>(raw.data()), raw.size()};
  }
  bool at_end() const { return rest_.empty(); }

 private:
  std::span<const std::byte> take(std::uint64_t n) {
    if (n > rest_.size()) throw std::out_of_range("too short");
    const auto head = rest_.first(n);
    rest_ = rest_.subspan(n);
    return head;
  }

  std::span<const std::byte> rest_;
  std::uint64_t size_;
};

}  // namespace jostle::inline engine
