#include "cli/terminal/failure.hpp"

#include <catch2/catch.hpp>
#include <new>

#include "cli/terminal/standard_streams.hpp"
#include "results/disk/error.hpp"
#include "study/running/run.hpp"

using namespace jostle;

TEST_CASE("Errors of the library name options") {
  CHECK(failure_text(BadInput("a sentence")) == "a sentence");
  CHECK(failure_text(BadArgument(Argument::observable, "Z", "there is none.")) ==
        "--observable Z: there is none.");
  CHECK(failure_text(BadArgument(Argument::shard, "", "no share can decide.")) ==
        "--shard: no share can decide.");
  CHECK(failure_text(BadArgument(Argument::observable, "Z", "it is at sweep point 1",
                                 Argument::sweep_point)) ==
        "--observable Z: it is at sweep point 1: choose one with --sweep-point");
  CHECK(failure_text(OutputExists("out.h5")) ==
        "out.h5 exists and is kept. Continue it with --resume, write elsewhere with -o FILE, or "
        "replace it with --force.");
  CHECK(failure_text(OtherShard("out.h5", {1, 2}, {2, 2})) ==
        "out.h5 holds shard 1/2, not 2/2: resume it with --shard 1/2");
  CHECK(failure_text(OtherScene("out.h5", "/seed: changed")) ==
        "out.h5 was begun with another scene and cannot be resumed with this one:\n/seed: changed\n"
        "Undo the change, or write to another file with -o.");
  CHECK(failure_text(ResultsError("out.h5", "is gone; restore it")) ==
        "out.h5: is gone; restore it");
  CHECK(failure_text(ResultsError("out.h5", "exists already; choose another name, or replace it",
                                  ResultsError::Force::helps)) ==
        "out.h5: exists already; choose another name, or replace it (--force)");
}

TEST_CASE("A message of exhausted memory contains a remedy") {
  CHECK(failure_text(std::bad_alloc()).starts_with("out of memory; raise the limit"));
}

TEST_CASE("A word of the command line begins no line of a message") {
  const std::vector<std::string> words = {"jostle", "fit", "a\nb", "--fix=c\nd=1", "plain"};
  CHECK(with_words_on_one_line("--observable a\nb: there is none", words) ==
        "--observable a\\x0ab: there is none");
  CHECK(with_words_on_one_line("no c\nd=1:\n  plain\n", words) == "no c\\x0ad=1:\n  plain\n");
  CHECK(with_words_on_one_line("a\nb, a\nb", words) == "a\\x0ab, a\\x0ab");
}
