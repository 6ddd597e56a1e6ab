#include "cli/terminal/stop_request.hpp"

#include <csignal>

namespace jostle::inline cli {
namespace {

// A signal handler reaches nothing but statics.
std::atomic<bool> stop_asked{false};
std::atomic<int> asked_by{0};  // a signal number, or time_limit_reached
constexpr int time_limit_reached = -1;
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

constexpr int stop_signals[] = {SIGINT, SIGTERM, SIGUSR1};

void ask(int cause) {
  int nobody = 0;
  asked_by.compare_exchange_strong(nobody, cause);
  stop_asked = true;
}

}  // namespace

StopRequest::StopRequest() {
  stop_asked = false;
  asked_by = 0;
  for (const int signal : stop_signals) {
    struct sigaction action = {};
    action.sa_handler = ask;
    action.sa_flags = SA_RESTART | (signal == SIGINT ? static_cast<int>(SA_RESETHAND) : 0);
    sigaction(signal, &action, nullptr);
  }
}

void StopRequest::stop_after(Seconds limit) {
  clock_.begin([this, limit] {
    if (!clock_.wait(limit)) ask(time_limit_reached);
  });
}

StopRequest::~StopRequest() {
  // Stopped work is stored: a second signal, as batch systems send one, must not change how the
  // process ends.
  for (const int signal : stop_signals)
    std::signal(signal, stop_asked && signal != SIGINT ? SIG_IGN : SIG_DFL);
}

const std::atomic<bool>& StopRequest::flag() const {
  return stop_asked;
}

std::string StopRequest::reason() const {
  switch (asked_by) {
    case 0:
      return "";
    case SIGINT:
      return "SIGINT";
    case SIGTERM:
      return "SIGTERM";
    case SIGUSR1:
      return "SIGUSR1";
    default:
      return "the time limit";
  }
}

}  // namespace jostle::inline cli
