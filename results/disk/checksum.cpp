#include "results/disk/checksum.hpp"

#include <fmt/format.h>
#include <openssl/rand.h>

#include <new>
#include <stdexcept>

namespace jostle::inline results {

Sha256::Sha256() : context_(EVP_MD_CTX_new(), &EVP_MD_CTX_free) {
  if (!context_) throw std::bad_alloc();
  if (EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) != 1)
    throw std::runtime_error("OpenSSL offers no SHA-256");
}

void Sha256::add(std::span<const std::byte> bytes) {
  EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size());
}

Sha256::Sum Sha256::finish() {
  Sum sum;
  EVP_DigestFinal_ex(context_.get(), reinterpret_cast<unsigned char*>(sum.data()), nullptr);
  return sum;
}

Sha256::Sum sha256(std::span<const std::byte> bytes) {
  Sha256 sum;
  sum.add(bytes);
  return sum.finish();
}

std::string hex(const Sha256::Sum& sum) {
  std::string text;
  for (const std::byte byte : sum) text += fmt::format("{:02x}", static_cast<unsigned>(byte));
  return text;
}

std::string random_identity() {
  std::array<unsigned char, 16> bytes;
  if (RAND_bytes(bytes.data(), bytes.size()) != 1)
    throw std::runtime_error("OpenSSL gives no random bytes");
  std::string text;
  for (const unsigned char byte : bytes) text += fmt::format("{:02x}", byte);
  return text;
}

}  // namespace jostle::inline results
