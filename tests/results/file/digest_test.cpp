#include <catch2/catch.hpp>
#include <functional>
#include <random>

#include "results/file/contents.hpp"
#include "results/file/results_file.hpp"
#include "results/file/results_writer.hpp"
#include "results/hdf5/writable_file.hpp"
#include "results/hdf5/write.hpp"
#include "tests/results/synthetic.hpp"
#include "tests/results/temporary_folder.hpp"

using namespace jostle;

namespace {

/// Digest of a file of one dataset of 3000 numbers.
std::string digest_of_numbers(std::vector<double> numbers, const Shape& shape, const Shape& chunk,
                              const std::string& name = "numbers",
                              const std::string& units = "diameter") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  WritableHdf5File file(path);
  {
    const Hdf5Handle dataset = write_numbers<double>(file, name, shape, numbers, chunk);
    write_attribute(dataset, "units", units);
  }
  return data_digest(file);
}

std::vector<double> some_numbers() {
  std::mt19937_64 random(1);
  std::vector<double> numbers(3000);
  for (double& number : numbers) number = static_cast<double>(random());
  return numbers;
}

/// Digest of the synthetic study's file, with one thing changed.
std::string digest_with(const std::function<void(Study&)>& change_study,
                        const std::function<void(RealizationRecord&)>& change_record,
                        const std::string& host = "a") {
  const TemporaryFolder folder;
  Study study = synthetic::study({.points = 2, .realizations = 2, .taps = 1, .snapshot_taps = {1}});
  change_study(study);
  const auto record = [&](RealizationId id) {
    RealizationRecord realization_record;
    realization_record.status = RealizationStatus::done;
    realization_record.rows = {1, 2, 3, 4, 0, 0, 7, 8, 9, 10, 0, 0};  // two taps
    realization_record.snapshots = {{1, std::vector<Vec3>(5, {1, 2, 3}), 0.5, {0.25, 0.75}}};
    realization_record.state.emplace();
    realization_record.state->rows = 2;
    realization_record.state->centres = realization_record.snapshots[0].centres;
    if (id == RealizationId{1, 1}) change_record(realization_record);
    return in_memory(realization_record, 6);
  };
  Provenance provenance;
  provenance.host = host;
  write_results(folder / "a.h5", {study, {}, {provenance}, host, record});
  return digest_of(folder / "a.h5");
}

const auto nothing = [](auto&) {};

}  // namespace

TEST_CASE("a digest does not depend on chunks and compression") {
  const auto numbers = some_numbers();
  const std::string expected = digest_of_numbers(numbers, {3000}, {});
  CHECK(digest_of_numbers(numbers, {3000}, {100}) == expected);
  CHECK(digest_of_numbers(numbers, {3000}, {3000}) == expected);
}

TEST_CASE("a digest depends on values, shape, name and attributes") {
  const auto numbers = some_numbers();
  const std::string expected = digest_of_numbers(numbers, {3000}, {});
  CHECK(digest_of_numbers(numbers, {30, 100}, {}) != expected);
  CHECK(digest_of_numbers(numbers, {3000}, {}, "number") != expected);
  CHECK(digest_of_numbers(numbers, {3000}, {}, "numbers", "radius") != expected);
  auto changed = numbers;
  changed[1234] = std::nextafter(changed[1234], 0);
  CHECK(digest_of_numbers(changed, {3000}, {}) != expected);
}

TEST_CASE("a study's digest ignores who computed it and how long it took") {
  const std::string expected = digest_with(nothing, nothing);
  CHECK(digest_with(nothing, nothing, "b") == expected);
  CHECK(digest_with(nothing, [](RealizationRecord& r) { r.work.seconds = 5; }) == expected);
  CHECK(digest_with(nothing, [](RealizationRecord& r) { r.work.effort.units = 5; }) == expected);
}

TEST_CASE("a study's digest notices any change of what was measured or asked") {
  const std::string expected = digest_with(nothing, nothing);
  using Record = RealizationRecord;
  CHECK(digest_with(nothing, [](Record& r) { r.rows[7] += 1; }) != expected);
  CHECK(digest_with(nothing, [](Record& r) { r.snapshots[0].centres[3].y = 2.5; }) != expected);
  CHECK(digest_with(nothing, [](Record& r) { r.snapshots[0].coordination = 0.6; }) != expected);
  CHECK(digest_with(nothing, [](Record& r) { r.snapshots[0].height_histogram[0] = 0; }) !=
        expected);
  CHECK(digest_with(nothing, [](Record& r) { r.state->engine.push_back(std::byte{1}); }) !=
        expected);
  CHECK(digest_with(nothing, [](Record& r) { r.status = RealizationStatus::failed; }) != expected);
  CHECK(digest_with(nothing, [](Record& r) { r.reason = "no reason"; }) != expected);
  CHECK(digest_with([](Study& s) { s.scene.push_back(' '); }, nothing) != expected);
  CHECK(digest_with([](Study& s) { s.points[1].seed = 8; }, nothing) != expected);
  CHECK(digest_with(
            [](Study& s) {
              s.points[1].container = WalledBox{4, 5};
            },
            nothing) != expected);
  CHECK(digest_with([](Study& s) { s.points[1].observables[0].units = "metre"; }, nothing) !=
        expected);
}
