#include "study/bad_input.hpp"

namespace jostle::inline study {
namespace {

std::string message(Argument argument, const std::string& value, const std::string& reason,
                    std::optional<Argument> remedy) {
  std::string text = name(argument);
  if (!value.empty()) text += " " + value;
  text += ": " + reason;
  if (remedy) text += std::string(": choose a ") + name(*remedy);
  return text;
}

}  // namespace

const char* name(Argument argument) {
  switch (argument) {
    case Argument::observable:
      return "observable";
    case Argument::equilibrium:
      return "equilibrium";
    case Argument::sweep_point:
      return "sweep point";
    case Argument::shard:
      return "shard";
  }
  return "";
}

BadArgument::BadArgument(Argument argument, const std::string& value, const std::string& reason,
                         std::optional<Argument> remedy)
    : BadInput(message(argument, value, reason, remedy)),
      argument_(argument),
      value_(value),
      reason_(reason),
      remedy_(remedy) {}

}  // namespace jostle::inline study
