#pragma once

#include "results/file/results_writer.hpp"
#include "results/hdf5/handle.hpp"

// The parts of a results file that describe the study: the root, /h5md, /scene, /sweep,
// /provenance.
namespace jostle::inline results {

void write_root(hid_t file, const Study& study);
/// The group /h5md alone, of any H5MD file.
void write_h5md_root(hid_t file);
void write_study(hid_t file, const Study& study);
void write_provenance(hid_t file, const FileContent& content, RunState state);

/// Read the data back. Throw Hdf5Error.
Study read_study(hid_t file);
/// True if that would give this study. Only the scenes are compared, so that the answer is no where
/// they are not sufficient: for starts from files.
bool has_study(hid_t file, const Study& study);
struct FileProvenance {
  std::string run_id;
  RunState state = RunState::running;
  Shard shard;
  std::vector<Provenance> processes;
};
FileProvenance read_provenance(hid_t file);

}  // namespace jostle::inline results
