#pragma once

#include "results/hdf5/handle.hpp"
#include "results/results_writer.hpp"

// The parts of a results file that describe the study: the root, /h5md, /scene, /sweep,
// /provenance.
namespace jostle {

void write_root(hid_t file);
void write_study(hid_t file, const Study& study);
void write_provenance(hid_t file, const FileContent& content, RunState state);

/// The same read back. Throw Hdf5Error.
Study read_study(hid_t file);
struct FileProvenance {
  std::string run_id;
  RunState state = RunState::running;
  Shard shard;
  std::vector<Provenance> processes;
};
FileProvenance read_provenance(hid_t file);

}  // namespace jostle
