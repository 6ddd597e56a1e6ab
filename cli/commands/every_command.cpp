// The commands of jostle, in the order of its help.
#include "cli/commands/commands.hpp"
#include "cli/commands/program.hpp"

namespace jostle::inline cli {

namespace {

void add_run_with_tables(Command& app, int& code) {
  add_run(app, code, make_scene_tables);
}

constexpr AddCommand commands[] = {
    add_new,     add_run_with_tables, add_check,  add_cost,  add_schema,   add_info,
    add_merge,   add_slurm,           add_status, add_bench, add_selftest, add_fit,
    add_analyse, add_structure,       add_report, add_export};

}  // namespace

std::span<const AddCommand> every_command() {
  return commands;
}

}  // namespace jostle::inline cli
