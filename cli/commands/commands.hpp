#pragma once

#include <CLI/CLI.hpp>

#include "cli/terminal/exit_codes.hpp"

// One function a subcommand: it describes its options to the parser, and leaves its exit code in
// `code` once the parser has called it.
namespace jostle {

void add_new(CLI::App& app, int& code);
void add_run(CLI::App& app, int& code);
void add_check(CLI::App& app, int& code);
void add_cost(CLI::App& app, int& code);
void add_schema(CLI::App& app, int& code);
void add_info(CLI::App& app, int& code);
void add_merge(CLI::App& app, int& code);
void add_bench(CLI::App& app, int& code);
void add_selftest(CLI::App& app, int& code);
void add_fit(CLI::App& app, int& code);
void add_analyse(CLI::App& app, int& code);
void add_export(CLI::App& app, int& code);
void add_structure(CLI::App& app, int& code);

}  // namespace jostle
