// Writes the results file of a synthetic study: two sweep points, three realizations, one of them
// failed, six taps, snapshots of five spheres at taps 0, 2 and 6.
#include <filesystem>

#include "runs.hpp"

int main(int argc, char** argv) {
  using namespace jostle;
  if (argc != 2) return 2;
  const Study study = synthetic::study();
  const auto store = RunStore::create(argv[1], study, {}, synthetic::provenance());
  for (const RealizationId id : store->pending()) {
    synthetic::Conduct conduct;
    if (id == RealizationId{1, 2}) conduct.fail_at_tap = 4;
    synthetic::run(*store, study, id, conduct);
  }
  store->finish();
}
