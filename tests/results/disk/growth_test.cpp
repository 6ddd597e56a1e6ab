#include <catch2/catch.hpp>
#include <fstream>
#include <string>

#include "tests/results/forked.hpp"
#include "tests/results/runs.hpp"
#include "tests/results/temporary_folder.hpp"

// System calls that change and read results files of four times the size: in proportion 4,
// its square 16. Calls for points may double besides: HDF5 writes metadata that outgrow its cache
// more than once.
// ./dev bench growth compares their processor times.
using namespace jostle;

namespace {

constexpr std::uint32_t times = 4;
constexpr double most_growth = 2.5 * times;

/// Calls of a kind, "changes" or "reads", that `work` makes below a folder.
template <class Work>
double calls_of(const char* kind, const TemporaryFolder& folder, const Work& work) {
  const TemporaryFolder notes;
  const std::string count = notes / "count", messages = notes / "messages";
  const Ending ending = run_forked({{"JOSTLE_FAULT_PATH", folder.path()},
                                    {"JOSTLE_FAULT_OF", kind},
                                    {"JOSTLE_FAULT_COUNT", count}},
                                   messages, work);
  REQUIRE(ending.code == 0);
  double calls = 0;
  std::ifstream(count) >> calls;
  REQUIRE(calls > 0);
  return calls;
}

/// Calls of a whole run, and of opening its file and reading all series.
struct Calls {
  double changes, reads;
};
Calls calls_of_a_study(const synthetic::StudySize& size) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  Calls calls{};
  calls.changes = calls_of("changes", folder, [&] { synthetic::run_to_end(path, size); });
  calls.reads = calls_of("reads", folder, [&] {
    const ResultsFile file(path);
    for (const RealizationSummary& realization : file.realizations()) file.record(realization.id);
  });
  return calls;
}

void check_growth(const synthetic::StudySize& small, const synthetic::StudySize& large) {
  const Calls of_small = calls_of_a_study(small), of_large = calls_of_a_study(large);
  CAPTURE(of_small.changes, of_small.reads);
  CHECK(of_large.changes <= most_growth * of_small.changes);
  CHECK(of_large.reads <= most_growth * of_small.reads);
}

}  // namespace

TEST_CASE("calls that write and read a file grow in proportion to what is in it") {
  SECTION("realizations") {
    check_growth({.points = 1, .realizations = 15}, {.points = 1, .realizations = times * 15});
  }
  SECTION("points") {
    check_growth({.points = 8, .realizations = 1}, {.points = times * 8, .realizations = 1});
  }
  SECTION("taps") {
    check_growth({.points = 1, .realizations = 1, .taps = 1000},
                 {.points = 1, .realizations = 1, .taps = times * 1000});
  }
}
