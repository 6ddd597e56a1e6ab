#pragma once

#include <openssl/evp.h>

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace jostle::inline results {

/// SHA-256 of bytes that come piece by piece.
class Sha256 {
 public:
  using Sum = std::array<std::byte, 32>;

  Sha256();
  void add(std::span<const std::byte> bytes);
  void add(std::string_view text) { add(std::as_bytes(std::span(text))); }
  /// Ends the sum; nothing may be added after.
  Sum finish();

 private:
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

Sha256::Sum sha256(std::span<const std::byte> bytes);
std::string hex(const Sha256::Sum& sum);

/// 128 random bits in hex, from the operating system: an identity, never a simulation's number.
std::string random_identity();

}  // namespace jostle::inline results
