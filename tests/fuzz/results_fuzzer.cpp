#include <cstdint>
#include <filesystem>

#include "tests/results/hdf5_mutations.hpp"
#include "tests/results/runs.hpp"
#include "tests/results/temporary_folder.hpp"

// The bytes choose changes that HDF5's own functions make to a results file, which is then sealed
// again: every use of it succeeds, or is refused.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace jostle::synthetic;
  static const TemporaryFolder folder;
  static const std::string original = folder / "original.h5", forged = folder / "forged.h5";
  static const std::string digest = run_to_end(original);
  std::filesystem::copy_file(original, forged, std::filesystem::copy_options::overwrite_existing);
  std::filesystem::remove_all(forged + ".parts");
  constexpr int most_changes = 4;
  Choices choices({bytes, size});
  for (int i = 0; i < most_changes && choices.any_left(); ++i) {
    const std::size_t kind = choices.integer_below(n_forgeries);
    forge(forged, kind, choices);
  }
  use_in_every_way(forged);
  return 0;
}
