#include "study/running/scene_file.hpp"
#include "study/tables/measured/curve_file.hpp"
#include "tests/fuzz/memory_file.hpp"

// A file holds a curve, of columns of one length, or is refused as bad input.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const MemoryFile file(bytes, size);
  try {
    const jostle::Curve curve = jostle::read_curve(file.path()).curve;
    if (curve.x.size() != curve.t.size()) std::abort();
    if (!curve.sigma.empty() && curve.sigma.size() != curve.t.size()) std::abort();
  } catch (const jostle::BadInput&) {
  }
  return 0;
}
