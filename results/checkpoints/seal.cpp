#include "results/checkpoints/seal.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <vector>

#include "results/checkpoints/checksum.hpp"
#include "results/checkpoints/publish.hpp"
#include "results/error.hpp"
#include "results/hdf5/descriptor.hpp"

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

/// The last line of a results file, its checksum.
std::string read_seal(const std::string& path, const Descriptor& file) {
  struct stat status;
  if (::fstat(file.get(), &status) != 0) fail_on_disk(path, "read", errno);
  if (!S_ISREG(status.st_mode))
    throw ResultsError(path, "not a file: results cannot be read from a folder, pipe or device");
  if (read_at(path, file, 0, hdf5_signature.size()) != hdf5_signature)
    throw ResultsError(path, "not an HDF5 file");
  const std::uint64_t size = size_of(path, file);
  if (size < line_size) throw ResultsError(path, "truncated");
  std::string line = read_at(path, file, size - line_size, line_size);
  if (!line.starts_with(line_start))
    throw ResultsError(path,
                       "truncated, changed by another program, or not written by jostle (it does "
                       "not end with its checksum); restore it from a copy");
  return line;
}

}  // namespace

void seal(const std::string& path) {
  const Descriptor file = open_or_fail(path, O_RDWR | O_APPEND | O_NOFOLLOW);
  const std::string line = line_for(path, file, size_of(path, file));
  write_all(path, file.get(), std::as_bytes(std::span(line)));
}

void require_seal(const std::string& path) {
  read_seal(path, open_or_fail(path, O_RDONLY | O_NONBLOCK | O_NOCTTY));
}

void verify_seal(const std::string& path, const Take& take) {
  const Descriptor file = open_or_fail(path, O_RDONLY | O_NONBLOCK | O_NOCTTY);
  const std::string line = read_seal(path, file);
  if (line != line_for(path, file, size_of(path, file) - line_size, take))
    throw ResultsError(path,
                       "damaged, or changed by another program (its checksum is wrong); restore it "
                       "from a copy");
  if (take) take(std::as_bytes(std::span(line)));
}

}  // namespace jostle::inline results
