#include "results/disk/error.hpp"
#include "results/export/extended_xyz.hpp"
#include "tests/fuzz/memory_file.hpp"

// A file holds a packing, or is refused with a ResultsError.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const MemoryFile file(bytes, size);
  try {
    jostle::read_extended_xyz(file.path(), std::nullopt);
  } catch (const jostle::ResultsError&) {
  }
  return 0;
}
