#pragma once

#include <memory>
#include <string>

#include "results/hdf5_handle.hpp"

namespace jostle {

/// A new HDF5 file, written through a file driver of our own. HDF5's default driver cannot be
/// brought to an orderly end once a write fails: closing tries again, and the process dies at its
/// exit. This one remembers the first failure, lets HDF5 believe that all went well, and reports
/// it; it also joins neighbouring writes.
class NewHdf5File {
 public:
  /// Creates or empties the file. Throws Hdf5Error.
  explicit NewHdf5File(const std::string& path);
  ~NewHdf5File();

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

}  // namespace jostle
