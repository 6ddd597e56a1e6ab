#include "results/hdf5/handle.hpp"

#include "results/hdf5/at_exit.hpp"

namespace jostle::inline results {

// HDF5's cache of objects grows to 32 MB of the file by itself, which take ten times as much in
// memory. Here it grows for large entries only, the names of a group's many members: where those of
// a million (46 MB) do not fit, they are read and written again for every one of them.
Hdf5Handle file_access() {
  Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5AC_cache_config_t cache{};
  cache.version = H5AC__CURR_CACHE_CONFIG_VERSION;
  checked(H5Pget_mdc_config(access, &cache));
  cache.set_initial_size = true;
  cache.initial_size = cache.min_size = 2u << 20;
  cache.max_size = 128u << 20;  // the limit of HDF5
  cache.incr_mode = H5C_incr__off;
  cache.decr_mode = H5C_decr__off;
  cache.flash_incr_mode = H5C_flash_incr__add_space;
  checked(H5Pset_mdc_config(access, &cache));
  return access;
}

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
