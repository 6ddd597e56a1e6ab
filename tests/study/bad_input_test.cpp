#include "study/bad_input.hpp"

#include <catch2/catch.hpp>

using namespace jostle;

TEST_CASE("A bad argument names argument, value, reason and remedy") {
  const BadArgument plain(Argument::observable, "Z", "there is none; out.h5 has X, Y.");
  CHECK(std::string(plain.what()) == "observable Z: there is none; out.h5 has X, Y.");
  const BadArgument empty(Argument::shard, "", "a share cannot decide");
  CHECK(std::string(empty.what()) == "shard: a share cannot decide");
  const BadArgument second(Argument::observable, "Z", "it is at sweep point 1",
                           Argument::sweep_point);
  CHECK(std::string(second.what()) == "observable Z: it is at sweep point 1: choose a sweep point");
}
