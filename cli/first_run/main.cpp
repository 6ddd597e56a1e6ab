// The commands of a first run: ./dev builds this program until it builds jostle. Not installed.
#include "cli/commands/commands.hpp"
#include "cli/commands/program.hpp"

namespace {

void add_run_without_tables(jostle::Command& app, int& code) {
  jostle::add_run(app, code, nullptr);
}

constexpr jostle::AddCommand commands[] = {
    jostle::add_new,    add_run_without_tables, jostle::add_requests, jostle::add_check,
    jostle::add_schema, jostle::add_info,       jostle::add_status};

}  // namespace

int main(int argc, char** argv) {
  return jostle::run_program(argc, argv, commands);
}
