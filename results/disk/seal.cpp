#include "results/disk/seal.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <optional>
#include <string_view>

#include "results/disk/checksum.hpp"
#include "results/disk/error.hpp"
#include "results/disk/publish.hpp"
#include "results/disk/system_calls.hpp"

namespace jostle::inline results {
namespace {

constexpr std::string_view line_start = "\njostle-sha256 ";
constexpr std::size_t line_size = line_start.size() + 64 + 1;
constexpr std::string_view hdf5_signature = "\x89HDF\r\n\x1a\n";

Descriptor open_or_fail(const std::string& path, int flags) {
  Descriptor file(::open(path.c_str(), flags | O_CLOEXEC));
  if (!file) fail_on_disk(path, "open", errno);
  return file;
}

std::uint64_t size_of(const std::string& path, const Descriptor& file) {
  struct stat status;
  if (::fstat(file.get(), &status) != 0) fail_on_disk(path, "read", errno);
  return static_cast<std::uint64_t>(status.st_size);
}

std::string read_at(const std::string& path, const Descriptor& file, std::uint64_t offset,
                    std::size_t n) {
  std::string text(n, '\0');
  std::size_t have = 0;
  while (have < n) {
    const ssize_t got =
        ::pread(file.get(), text.data() + have, n - have, static_cast<off_t>(offset + have));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail_on_disk(path, "read", errno);
    if (got == 0) break;
    have += static_cast<std::size_t>(got);
  }
  text.resize(have);
  return text;
}

using Take = std::function<void(std::span<const std::byte>)>;

std::string line_for(const std::string& path, const Descriptor& file, std::uint64_t size,
                     const Take& take = {}) {
  constexpr std::size_t piece = 4u << 20;
  Sha256 sum;
  for (std::uint64_t offset = 0; offset < size; offset += piece) {
    const std::string read =
        read_at(path, file, offset, std::min<std::uint64_t>(piece, size - offset));
    sum.add(read);
    if (take) take(std::as_bytes(std::span(read)));
  }
  return std::string(line_start) + hex(sum.finish()) + "\n";
}

/// Position of the signature: at the start, or behind a user block of 512 bytes, 1024, 2048, ...;
/// nothing where there is none. https://docs.hdfgroup.org/hdf5/develop/_f_m_t3.html
std::optional<std::uint64_t> signature_place(const std::string& path, const Descriptor& file) {
  const std::uint64_t size = size_of(path, file);
  for (std::uint64_t offset = 0; offset + hdf5_signature.size() <= size;
       offset = offset == 0 ? 512 : 2 * offset)
    if (read_at(path, file, offset, hdf5_signature.size()) == hdf5_signature) return offset;
  return std::nullopt;
}

/// End of the file by HDF5's superblock; 0 for an unknown layout.
std::uint64_t hdf5_end(const std::string& path, const Descriptor& file) {
  constexpr std::size_t longest = 64;
  const std::string block = read_at(path, file, 0, longest);
  if (block.size() < longest) return 0;
  const auto byte = [&](std::size_t offset) { return static_cast<unsigned char>(block[offset]); };
  const unsigned version = byte(8);
  constexpr unsigned bytes_an_offset = 8;
  if (version > 3 || byte(version < 2 ? 13 : 9) != bytes_an_offset) return 0;
  constexpr std::array<std::size_t, 4> end_at{40, 44, 28, 28};  // by the version
  std::uint64_t end = 0;
  for (std::size_t i = bytes_an_offset; i-- > 0;) end = end << 8 | byte(end_at[version] + i);
  return end;
}

void require_results(const std::string& path, const Descriptor& file) {
  struct stat status;
  if (::fstat(file.get(), &status) != 0) fail_on_disk(path, "read", errno);
  if (!S_ISREG(status.st_mode))
    throw ResultsError(path, "not a file: results cannot be read from a folder, pipe or device");
  const auto place = signature_place(path, file);
  if (!place) throw ResultsError(path, "not an HDF5 file");
  if (*place > 0)
    throw ResultsError(path, fmt::format("has {} bytes in front of HDF5's signature, a user block, "
                                         "which another program put there; take it away (h5unjam)",
                                         *place));
}

/// The last line of a results file, its checksum; empty where it is lost.
std::string read_seal(const std::string& path, const Descriptor& file) {
  require_results(path, file);
  const std::uint64_t size = size_of(path, file);
  if (size < line_size) throw ResultsError(path, "truncated");
  std::string line = read_at(path, file, size - line_size, line_size);
  if (line.starts_with(line_start)) return line;
  if (size == hdf5_end(path, file)) return "";
  throw ResultsError(path,
                     "truncated, changed by another program, or not written by jostle (it does "
                     "not end with its checksum); restore it from a copy");
}

Descriptor open_to_verify(const std::string& path) {
  return open_or_fail(path, O_RDONLY | O_NONBLOCK | O_NOCTTY);
}

}  // namespace

void seal(const std::string& path) {
  const Descriptor file = open_or_fail(path, O_RDWR | O_APPEND | O_NOFOLLOW);
  const std::string line = line_for(path, file, size_of(path, file));
  write_all(path, file.get(), std::as_bytes(std::span(line)));
}

SealState seal_state(const std::string& path) {
  return read_seal(path, open_to_verify(path)).empty() ? SealState::lost : SealState::whole;
}

SealState verify_seal(const std::string& path, const Take& take) {
  const Descriptor file = open_to_verify(path);
  const std::string line = read_seal(path, file);
  if (line.empty() && !take) return SealState::lost;
  const std::string found = line_for(path, file, size_of(path, file) - line.size(), take);
  if (line.empty()) return SealState::lost;
  if (line != found)
    throw ResultsError(path,
                       "damaged, or changed by another program (its checksum is wrong); restore it "
                       "from a copy");
  if (take) take(std::as_bytes(std::span(line)));
  return SealState::whole;
}

bool is_hdf5_file(const std::string& path) {
  return signature_place(path, open_to_verify(path)).has_value();
}

}  // namespace jostle::inline results
