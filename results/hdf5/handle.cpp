#include "results/hdf5/handle.hpp"

#include "results/hdf5/at_exit.hpp"

namespace jostle::inline results {

void silence_hdf5() {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

void close_nothing_at_exit() {
  H5dont_atexit();
}

std::string hdf5_reason() {
  std::string reason;
  const auto keep_first = [](unsigned, const H5E_error2_t* error, void* text) -> herr_t {
    auto& kept = *static_cast<std::string*>(text);
    if (kept.empty() && error->desc) kept = error->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_first, &reason);
  H5Eclear2(H5E_DEFAULT);
  if (reason.empty()) return "HDF5 failed: out of memory, or the file is not as jostle writes it";
  return "HDF5: " + reason + "; the file is not as jostle writes it, or the disk failed";
}

}  // namespace jostle::inline results
