#include "cli/terminal/stop_request.hpp"

#include <catch2/catch.hpp>
#include <csignal>
#include <utility>

using namespace jostle;

TEST_CASE("Each stop signal sets the flag and is named") {
  for (const auto& [signal, name] :
       {std::pair{SIGINT, "SIGINT"}, {SIGTERM, "SIGTERM"}, {SIGUSR1, "SIGUSR1"}}) {
    const StopRequest stop;
    CHECK_FALSE(stop.flag());
    CHECK(stop.reason().empty());
    std::raise(signal);
    CHECK(stop.flag());
    CHECK(stop.reason() == name);
  }
}

TEST_CASE("The first cause of a stop is the one named") {
  const StopRequest stop;
  std::raise(SIGUSR1);
  std::raise(SIGTERM);
  CHECK(stop.reason() == "SIGUSR1");
}

TEST_CASE("A signal after a stop does not end the process") {
  {
    const StopRequest stop;
    std::raise(SIGTERM);
  }
  std::raise(SIGUSR1);
  std::raise(SIGTERM);
  std::signal(SIGUSR1, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
  SUCCEED();
}

TEST_CASE("The time limit sets the flag and is named") {
  StopRequest stop;
  stop.stop_after(Seconds(0.01));
  while (!stop.flag()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  CHECK(stop.reason() == "the time limit");
}

TEST_CASE("A time limit far ahead neither stops nor delays the end") {
  StopRequest stop;
  stop.stop_after(Seconds(3600));
  CHECK_FALSE(stop.flag());
}
