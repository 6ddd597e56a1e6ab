#include "results/disk/input_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "results/disk/error.hpp"
#include "results/disk/publish.hpp"
#include "results/disk/system_calls.hpp"

namespace jostle::inline results {
namespace {

constexpr std::size_t bytes_at_once = 1u << 16;
constexpr std::size_t longest_line = 64u << 20;
constexpr std::size_t longest_text = 256u
                                     << 20;  // longest text of a scene with 100 000 points and more

/// Without waiting for one who writes to a pipe where none may be.
Descriptor opened(const std::string& path, Pipes pipes) {
  const int wait = pipes == Pipes::allowed ? 0 : O_NONBLOCK;
  Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY | wait));
  if (!file) fail_on_disk(path, "open", errno);
  struct stat status;
  if (::fstat(file.get(), &status) != 0) fail_on_disk(path, "read", errno);
  if (S_ISDIR(status.st_mode)) throw ResultsError(path, "cannot read: it is a folder");
  if (pipes == Pipes::refused && !S_ISREG(status.st_mode))
    throw ResultsError(path, "cannot read: not a file, but a pipe, a socket or a device");
  return file;
}

}  // namespace

InputFile::InputFile(std::string path, Pipes pipes)
    : path_(std::move(path)), file_(opened(path_, pipes)) {}

std::size_t InputFile::read_some(std::span<std::byte> bytes) {
  for (;;) {
    const ssize_t got = ::read(file_.get(), bytes.data(), bytes.size());
    if (got >= 0) return static_cast<std::size_t>(got);
    if (errno != EINTR) fail_on_disk(path_, "read", errno);
  }
}

/// Reads more behind what is not handed out yet; false at the end of the file.
bool InputFile::fill() {
  buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(taken_));
  taken_ = 0;
  const std::size_t have = buffer_.size();
  buffer_.resize(have +
                 std::max(bytes_at_once, have));  // doubled, so that a long line takes linear time
  const std::size_t got = read_some(std::span(buffer_).subspan(have));
  buffer_.resize(have + got);
  return got > 0;
}

std::size_t InputFile::read(std::span<std::byte> bytes) {
  const std::size_t ready = std::min(bytes.size(), buffer_.size() - taken_);
  if (ready > 0) std::memcpy(bytes.data(), buffer_.data() + taken_, ready);
  taken_ += ready;
  std::size_t n = ready;
  while (n < bytes.size()) {
    const std::size_t got = read_some(bytes.subspan(n));
    if (got == 0) break;
    n += got;
  }
  return n;
}

bool InputFile::next_line(std::string& line) {
  std::size_t searched = 0;
  for (;;) {
    const auto begin = buffer_.begin() + static_cast<std::ptrdiff_t>(taken_);
    const auto end =
        std::find(begin + static_cast<std::ptrdiff_t>(searched), buffer_.end(), std::byte{'\n'});
    const bool whole = end != buffer_.end();
    searched = static_cast<std::size_t>(end - begin);
    if (searched > longest_line)
      throw ResultsError(path_, "has a line of more than 64 MB: no text that jostle reads");
    if (!whole && fill()) continue;
    line.assign(reinterpret_cast<const char*>(buffer_.data()) + taken_, searched);
    taken_ += searched + (whole ? 1 : 0);
    return whole || searched > 0;
  }
}

void InputFile::read_at(std::uint64_t offset, std::span<std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t got =
        ::pread(file_.get(), bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail_on_disk(path_, "read", errno);
    if (got == 0) throw ResultsError(path_, "ends before what was written into it");
    offset += static_cast<std::uint64_t>(got);
    bytes = bytes.subspan(static_cast<std::size_t>(got));
  }
}

std::string InputFile::stamp() const {
  struct stat status;
  if (::fstat(file_.get(), &status) != 0) fail_on_disk(path_, "read", errno);
  const ChangeTime changed = change_time(status);
  return fmt::format("{} {} {} {}.{}", status.st_dev, status.st_ino, status.st_size,
                     changed.seconds, changed.nanoseconds);
}

std::string InputFile::rest() {
  std::string text;
  std::vector<std::byte> chunk(bytes_at_once);
  for (std::size_t n = chunk.size(); n == chunk.size();) {
    n = read(chunk);
    if (text.size() + n > longest_text)
      throw ResultsError(path_, "is longer than 256 MB: no text that jostle reads");
    text.append(reinterpret_cast<const char*>(chunk.data()), n);
  }
  return text;
}

std::vector<std::byte> read_bytes(const std::string& path) {
  InputFile file(path);
  return read_bytes(file);
}

std::vector<std::byte> read_bytes(InputFile& file) {
  std::vector<std::byte> bytes;
  std::size_t n = 0;
  do {
    bytes.resize(n + std::max(bytes_at_once, n));
    n += file.read(std::span(bytes).subspan(n));
  } while (n == bytes.size());
  bytes.resize(n);
  return bytes;
}

std::string read_text_file(const std::string& path, Pipes pipes) {
  return InputFile(path, pipes).rest();
}

}  // namespace jostle::inline results
