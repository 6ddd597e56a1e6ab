#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace jostle::inline study {

/// A self-check failed; what() gives the check and the reason.
class SelfCheckFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct SelfCheck {
  std::string name;
  std::function<std::string()>
      run;  // description of the check, in numbers; any exception is a failure
  enum class Finds { wrong_numbers, bad_disk } finds;  // the fault where it fails
};

/// Fixed hard cases of the engine, the fits and the results files, of seconds. `folder` exists and
/// is empty: files are written there.
std::vector<SelfCheck> self_checks(const std::string& folder);

}  // namespace jostle::inline study
