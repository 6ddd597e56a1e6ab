#pragma once

#include <optional>
#include <stdexcept>
#include <string>

// Errors of the functions of study/. They know no command line: where a message must name an
// option, the caller makes it from the fields below.
namespace jostle::inline study {

/// The request is invalid; what() gives the fault, the reason and what to do.
class BadInput : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An argument that several functions take.
enum class Argument { observable, equilibrium, sweep_point, shard };
const char* name(Argument argument);  // "observable", "equilibrium", "sweep point", "shard"

/// One argument is at fault: what() is "observable X: there is none; ...".
class BadArgument : public BadInput {
 public:
  /// `value` as it was given; may be empty. `remedy`: the argument that would choose among what
  /// there is.
  BadArgument(Argument argument, const std::string& value, const std::string& reason,
              std::optional<Argument> remedy = std::nullopt);

  Argument argument() const { return argument_; }
  const std::string& value() const { return value_; }
  const std::string& reason() const { return reason_; }
  std::optional<Argument> remedy() const { return remedy_; }

 private:
  Argument argument_;
  std::string value_, reason_;
  std::optional<Argument> remedy_;
};

}  // namespace jostle::inline study
