#include "cli/terminal/standard_streams.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <initializer_list>
#include <iostream>

#include "results/disk/printable.hpp"
#include "study/provenance.hpp"

namespace jostle::inline cli {
namespace {

/// Whatever interrupts or shortens a write. Returns errno of what failed, 0 if nothing did.
int write_whole(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return written < 0 ? errno : ENOSPC;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

}  // namespace

void reserve_standard_fds() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    // open() takes the lowest number that is free: this one.
    if (fcntl(stream, F_GETFD) < 0 && open("/dev/null", O_RDONLY) < 0) return;
  }
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
}

void print(std::string_view text) {
  print_exactly(printable(text));
}

// std::cout holds the state of standard output (bad: closed, fail: an error of it); nothing is
// written through it.
void print_json(const Json& json) {
  print_exactly(printable_json(json.dump(2)) + "\n");
}

void print_exactly(std::string_view text) {
  if (std::cout.bad()) return;
  const int error = write_whole(STDOUT_FILENO, text);
  if (error == 0) return;
  std::cout.setstate(std::ios::badbit);
  if (error == EPIPE) return;  // the reader, as `head`, has enough
  std::cout.setstate(std::ios::failbit);
  print_to_standard_error(
      fmt::format("jostle: cannot write to standard output: {}\n", std::strerror(error)));
}

bool output_is_lost() {
  return (std::cout.rdstate() & std::ios::failbit) != 0;
}

std::string with_words_on_one_line(std::string message, std::span<const std::string> words) {
  const auto replace = [&](const std::string& part) {
    if (part.find('\n') == std::string::npos) return;
    const std::string shown = printable_name(part);
    for (std::size_t i = message.find(part); i != std::string::npos;
         i = message.find(part, i + shown.size()))
      message.replace(i, part.size(), shown);
  };
  for (const std::string& word : words) {
    replace(word);
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos) continue;
    replace(word.substr(0, equals));
    replace(word.substr(equals + 1));
  }
  return message;
}

void print_to_standard_error(std::string_view text) {
  print_to_standard_error_exactly(
      printable(with_words_on_one_line(std::string(text), command_line())));
}

void print_to_standard_error_exactly(std::string_view text) {
  write_whole(STDERR_FILENO, text);
}

}  // namespace jostle::inline cli
