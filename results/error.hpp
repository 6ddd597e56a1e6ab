#pragma once

#include <stdexcept>
#include <string>

namespace jostle::inline results {

/// A results file, a part or the disk below them is not as it must be. what() names the path, the
/// reason and, where there is one, the way out.
class ResultsError : public std::runtime_error {
 public:
  ResultsError(std::string path, const std::string& reason)
      : std::runtime_error(path + ": " + reason), path_(std::move(path)) {}

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace jostle::inline results
