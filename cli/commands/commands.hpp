#pragma once

#include "cli/options/command.hpp"
#include "cli/tables/scene_tables.hpp"
#include "cli/terminal/exit_codes.hpp"

// One function a subcommand: it describes its options to the parser, and leaves its exit code in
// `code` once the parser has called it.
namespace jostle::inline cli {

void add_new(Command& app, int& code);
/// Without `make_tables`, `run` refuses scenes that the program of a first run cannot run.
void add_run(Command& app, int& code, SceneTablesMaker* make_tables);
void add_check(Command& app, int& code);
void add_cost(Command& app, int& code);
void add_schema(Command& app, int& code);
void add_info(Command& app, int& code);
void add_merge(Command& app, int& code);
void add_bench(Command& app, int& code);
void add_slurm(Command& app, int& code);
void add_status(Command& app, int& code);
void add_selftest(Command& app, int& code);
void add_fit(Command& app, int& code);
void add_analyse(Command& app, int& code);
void add_export(Command& app, int& code);
void add_structure(Command& app, int& code);
void add_report(Command& app, int& code);
/// `requests run`, `requests check`: of the program of a first run alone.
void add_requests(Command& app, int& code);
void add_run_requests(Command& requests, int& code);
void add_check_requests(Command& requests, int& code);

}  // namespace jostle::inline cli
