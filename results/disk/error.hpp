#pragma once

#include <stdexcept>
#include <string>

namespace jostle::inline results {

/// A results file, a part or the disk below them is not as it must be. what() names the path, the
/// reason and, where there is one, the way out.
class ResultsError : public std::runtime_error {
 public:
  enum class Force { no, helps };

  /// `force`: whether the way out that `reason` ends with is to call again with `force`.
  ResultsError(std::string path, const std::string& reason, Force force = Force::no)
      : std::runtime_error(path + ": " + reason), path_(std::move(path)), force_(force) {}

  const std::string& path() const { return path_; }
  bool force_helps() const { return force_ == Force::helps; }

 private:
  std::string path_;
  Force force_;
};

/// Another process works on the file.
class LockHeld : public ResultsError {
 public:
  using ResultsError::ResultsError;
};

}  // namespace jostle::inline results
