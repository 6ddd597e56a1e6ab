#include "cli/terminal/failure.hpp"

#include <fmt/format.h>

#include <new>
#include <string_view>
#include <system_error>

#include "cli/options/command_words.hpp"
#include "results/disk/error.hpp"
#include "results/disk/printable.hpp"
#include "study/provenance.hpp"
#include "study/results_input.hpp"
#include "study/running/run.hpp"

namespace jostle::inline cli {
namespace {

bool is_want_of_threads(const std::exception& error) {
  const auto* system = dynamic_cast<const std::system_error*>(&error);
  if (system != nullptr) return system->code() == std::errc::resource_unavailable_try_again;
  return std::string_view(error.what()).starts_with("pthread_create");  // TBB's, without a code
}

const char* option(Argument argument) {
  switch (argument) {
    case Argument::observable:
      return "--observable";
    case Argument::equilibrium:
      return "--equilibrium";
    case Argument::sweep_point:
      return "--sweep-point";
    case Argument::shard:
      return "--shard";
  }
  return "";
}

std::string text_of(const BadArgument& error) {
  std::string text = option(error.argument());
  if (!error.value().empty()) text += " " + error.value();
  text += ": " + error.reason();
  if (error.remedy()) text += fmt::format(": choose one with {}", option(*error.remedy()));
  return text;
}

std::string text_of(const NoTapsYet& error) {
  return fmt::format("{}{}. Finish it with {} SCENE --resume; {} shows its progress.", error.what(),
                     error.live() == Live::no ? "; --live reads its checkpoints" : "",
                     shell_words({command_line().front(), "run"}),
                     shell_words({command_line().front(), "info", operand(error.path())}));
}

std::string text_of(const OutputExists& error) {
  return fmt::format(
      "{}. Continue it with --resume, write elsewhere with -o FILE, or replace it "
      "with --force.",
      error.what());
}

std::string text_of(const OtherScene& error) {
  return fmt::format("{}\nUndo the change, or write to another file with -o.", error.what());
}

std::string text_of(const OtherShard& error) {
  return fmt::format("{}: resume it with --shard {}/{}", error.what(), error.stored().index,
                     error.stored().count);
}

std::string text_of(const LockHeld& error) {
  return fmt::format("{}{} (--wait DURATION waits longer)", error.what(),
                     error.force_helps() ? " (--force)" : "");
}

std::string text_of(const ResultsError& error) {
  // A name must not look like further lines of the message.
  const std::string reason = std::string(error.what()).substr(error.path().size());
  return printable_name(error.path()) + reason + (error.force_helps() ? " (--force)" : "");
}

/// Nothing for an error of another kind.
template <class Error>
bool tell(const std::exception& error, std::string& text) {
  const auto* const found = dynamic_cast<const Error*>(&error);
  if (found != nullptr) text = text_of(*found);
  return found != nullptr;
}

}  // namespace

std::string failure_text(const std::exception& error) {
  std::string text;
  if (tell<BadArgument>(error, text) || tell<NoTapsYet>(error, text) ||
      tell<OutputExists>(error, text) || tell<OtherScene>(error, text) ||
      tell<OtherShard>(error, text) || tell<LockHeld>(error, text) ||
      tell<ResultsError>(error, text)) {
    return text;
  }
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) {
    return "out of memory; raise the limit (ulimit -v, a job's memory), use fewer --threads, or "
           "keep fewer snapshots";
  }
  if (is_want_of_threads(error)) {
    return fmt::format(
        "cannot start a thread: {}; raise the limit on threads or memory (ulimit -u, ulimit -v), "
        "or use fewer --threads",
        error.what());
  }
  return error.what();
}

}  // namespace jostle::inline cli
