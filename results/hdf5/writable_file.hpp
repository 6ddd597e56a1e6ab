#pragma once

#include <memory>
#include <string>

#include "results/hdf5/handle.hpp"

namespace jostle::inline results {

/// An HDF5 file, new or to be changed, written through a file driver of our own. HDF5's default
/// driver cannot be brought to an orderly end once a write fails: closing tries again, and the
/// process dies at its exit. This one remembers the first failure, lets HDF5 believe that all went
/// well, and reports it; it also joins neighbouring writes.
class WritableHdf5File {
 public:
  enum class Begin { empty, as_it_is };
  /// Creates or empties the file, or opens one to change it: then whatever follows HDF5's end, as
  /// the checksum does, is cut off. Throws Hdf5Error.
  explicit WritableHdf5File(const std::string& path, Begin begin = Begin::empty);
  ~WritableHdf5File();

  operator hid_t() const { return file_; }
  /// Throws ResultsError if a write has failed.
  void check() const;
  /// Closes the file; throws as check().
  void close();

 private:
  std::string path_;
  std::unique_ptr<int> error_;  // errno of the first failure, 0 if there is none
  Hdf5Handle driver_, file_;
};

}  // namespace jostle::inline results
