#include <catch2/catch.hpp>
#include <fstream>
#include <functional>

#include "results/disk/error.hpp"
#include "results/export/packing_file.hpp"
#include "results/file/tables.hpp"
#include "results/run/live_run.hpp"
#include "study/running/scene_file.hpp"
#include "study/tables/measured/curve_file.hpp"
#include "tests/config/scene_files.hpp"
#include "tests/engine/sample_packings.hpp"
#include "tests/hard_cases/mutations.hpp"
#include "tests/results/runs.hpp"
#include "tests/results/temporary_folder.hpp"

using namespace jostle;
using Catch::Matchers::Contains;

namespace {

void write(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

/// True if a file is read; otherwise the message names it and the reason.
template <class Refusal>
bool is_read(const std::string& path, const std::function<void()>& read) {
  try {
    read();
    return true;
  } catch (const Refusal& refusal) {
    const std::string message = refusal.what();
    CHECK(message.rfind(path, 0) == 0);
    CHECK(message.size() > path.size() + 5);
    return false;
  }
}

}  // namespace

TEST_CASE("extended XYZ changed at random is refused with its line or read") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.xyz";
  RandomStream random = mutation_stream(1);
  int read = 0, n = 0;
  for (const Container& container :
       {Container{PeriodicBox{4, 5}}, Container{Cylinder{4}}, Container{FullyPeriodicBox{}}}) {
    write_extended_xyz(path, random_packing(container, 10, 8, 1));
    const std::string text = text_of(path) + text_of(path);
    for (int k = 0; k < 1000; ++k) {
      const std::string mutated = mutated_bytes(text, random);
      CAPTURE(mutated);
      write(path, mutated);
      read += is_read<ResultsError>(path, [&] { read_packing(path); });
      ++n;
    }
  }
  CHECK(read > 0);
  CHECK(read < n);
}

TEST_CASE("a curve file changed at random is refused with its line or read") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.csv";
  const std::string text =
      "t, X, sigma\n# measured\n1, 0.58, 0.001\n2; 0.59; 0.001\n4\t0.6\t0.001\n\n8 0.61 1e-3\n";
  RandomStream random = mutation_stream(2);
  int read = 0;
  for (int k = 0; k < 3000; ++k) {
    const std::string mutated = mutated_bytes(text, random);
    CAPTURE(mutated);
    write(path, mutated);
    read += is_read<BadInput>(path, [&] {
      const Curve curve = read_curve(path).curve;
      CHECK(curve.x.size() == curve.t.size());
      CHECK((curve.sigma.empty() || curve.sigma.size() == curve.t.size()));
    });
  }
  CHECK(read > 0);
  CHECK(read < 3000);
}

TEST_CASE("a decimal comma is refused, not read as two numbers") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.csv";
  for (const char* line : {"1;2,5", "1,5;2,5", "1 2,5", "1,5 2,5", "1\t2,5", "1,,2", "1;2;;3"}) {
    CAPTURE(line);
    write(path, std::string(line) + "\n2;3\n");
    CHECK_THROWS_AS(read_curve(path), BadInput);
  }
  for (const char* lines :
       {"1;2.5\n2;3\n", "1, 2.5\n2 ,3,\n", "1\t2.5\r\n2 3\r\n", "t;\"X\"\n1;2.5\n2;3"}) {
    CAPTURE(lines);
    write(path, lines);
    CHECK(read_curve(path).curve.x == std::vector<double>{2.5, 3});
  }
}

TEST_CASE("a results file with any byte changed is refused by every reader, with path and reason") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  synthetic::run_to_end(path, {.points = 1, .realizations = 2});
  const std::string sound = text_of(path);
  RandomStream random = mutation_stream(3);
  for (int k = 0; k < 500; ++k) {
    const std::string mutated = mutated_bytes(sound, random);
    if (mutated == sound) continue;
    write(path, mutated);
    const std::vector<std::function<void()>> readers = {
        [&] { ResultsFile{path}; }, [&] { run_status(path); }, [&] { digest_of(path); },
        [&] { table_names(path); }, [&] { read_packing(path); }};
    for (const auto& reader : readers) CHECK_FALSE(is_read<ResultsError>(path, reader));
  }
  write(path, sound);
  CHECK_NOTHROW(ResultsFile{path});
}

TEST_CASE("foreign files under the name of results are refused with path and reason") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  synthetic::run_to_end(path, {.points = 1, .realizations = 2});
  const std::string sound = text_of(path);
  RandomStream random = mutation_stream(4);
  std::string noise(3000, '\0');
  for (char& byte : noise) byte = static_cast<char>(random.integer_below(256));
  const std::vector<std::string> foreign = {
      text_of(shipped_scenes / "quickstart.json"),
      noise,
      sound.substr(0, 8),                  // the signature alone
      sound.substr(0, 8) + noise,          // and noise
      sound.substr(0, sound.size() - 79),  // without its checksum: as other programs write HDF5
      sound + sound,
      sound + "\n",
      std::string(sound.size(), '\0')};
  for (std::size_t k = 0; k < foreign.size(); ++k) {
    CAPTURE(k);
    write(path, foreign[k]);
    CHECK_FALSE(is_read<ResultsError>(path, [&] { ResultsFile{path}; }));
    CHECK_FALSE(is_read<ResultsError>(path, [&] { digest_of(path); }));
  }
  CHECK_THROWS_WITH(ResultsFile{folder.path()}, Contains(folder.path()));
}
