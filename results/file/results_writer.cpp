#include "results/file/results_writer.hpp"

#include "results/disk/seal.hpp"
#include "results/disk/temporary_file.hpp"
#include "results/file/contents.hpp"
#include "results/file/study_writer.hpp"
#include "results/file/tables.hpp"
#include "results/groups/layout.hpp"
#include "results/groups/point_writer.hpp"
#include "results/hdf5/writable_file.hpp"

namespace jostle::inline results {
namespace {

/// Writes every realization; returns whether all of the shard are done or failed.
bool write_points(const WritableHdf5File& file, const FileContent& content) {
  bool complete = true;
  const Study& study = content.study;
  create_point_folders(file);
  const std::uint64_t all = study.points.size() * std::uint64_t{study.realizations};
  for (std::uint32_t p = 0; p < study.points.size(); ++p) {
    PointWriter writer(file, study, p);
    for (std::uint32_t r = 0; r < study.realizations; ++r) {
      const RealizationStatus status = writer.add(content.realization({p, r}));
      const bool ended = status == RealizationStatus::done || status == RealizationStatus::failed;
      if (in_share(content.shard, study, {p, r}) && !ended) complete = false;
      file.check();
      if (content.progress) content.progress(p * std::uint64_t{study.realizations} + r + 1, all);
    }
    writer.finish();
  }
  return complete;
}

void write_hdf5(const std::string& path, const FileContent& content) {
  WritableHdf5File file(path);
  write_root(file, content.study);
  write_study(file, content.study);
  RunState state = RunState::running;
  if (content.realization)
    state = write_points(file, content) ? RunState::complete : RunState::interrupted;
  write_provenance(file, content, state);
  if (content.tables_of != nullptr) copy_tables(*content.tables_of, file);
  write_contents(file);
  file.close();
}

}  // namespace

void write_results(const std::string& path, const FileContent& content,
                   const std::function<void()>& prepare) {
  TemporaryFile temporary(path);
  naming_file(temporary.name(), [&] { write_hdf5(temporary.name(), content); });
  seal(temporary.name());
  temporary.publish(prepare);
}

}  // namespace jostle::inline results
