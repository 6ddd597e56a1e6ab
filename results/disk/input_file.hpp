#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "results/disk/system_calls.hpp"

namespace jostle::inline results {

/// True if an input may be a pipe or a device, as in `fit <(command)`.
enum class Pipes { refused, allowed };

/// A file that is read from its beginning, and in which a failed read is never taken for its end.
/// Everything throws ResultsError, with the path and the reason.
class InputFile {
 public:
  explicit InputFile(std::string path, Pipes pipes = Pipes::refused);

  /// Fills the bytes; fewer come only at the end of the file.
  std::size_t read(std::span<std::byte> bytes);
  /// The next line without its newline; false at the end of the file. Throws at one of over 64 MB.
  bool next_line(std::string& line);
  /// Fills the bytes from a place in the file; throws where the file ends before.
  void read_at(std::uint64_t offset, std::span<std::byte> bytes);
  /// Identifies the file: differs for every other file that exists or was made since.
  std::string stamp() const;
  /// All that has not been read; throws beyond 256 MB.
  std::string rest();

 private:
  std::size_t read_some(std::span<std::byte> bytes);
  bool fill();

  std::string path_;
  Descriptor file_;
  std::vector<std::byte> buffer_;  // read, of which `taken_` bytes were handed out
  std::size_t taken_ = 0;
};

/// A whole file.
std::vector<std::byte> read_bytes(InputFile& file);
std::vector<std::byte> read_bytes(const std::string& path);
std::string read_text_file(const std::string& path, Pipes pipes = Pipes::refused);

}  // namespace jostle::inline results
