#include "cli/commands/program.hpp"

#include "cli/commands/commands.hpp"
#include "cli/terminal/version.hpp"

namespace jostle::inline cli {

namespace {

constexpr const char* footer =
    "Examples:\n"
    "  jostle new quickstart          writes quickstart.json, a scene to start from\n"
    "  jostle check quickstart.json   what it means and costs\n"
    "  jostle run quickstart.json     writes quickstart.h5\n"
    "  jostle info quickstart.h5      what is in it\n"
    "  jostle fit quickstart.h5 --observable bottom_fraction\n"
    "  jostle analyse quickstart.h5 steady --observable mean_height\n"
    "  jostle structure quickstart.h5 --part profile,voronoi\n"
    "  jostle report quickstart.h5    writes quickstart.html, a page to look at\n"
    "\n"
    "Exit codes: 0 done; 2 bad scene or command line, nothing was run; 3 some realizations "
    "failed,\n"
    "the rest is stored; 4 input or output failed; 75 stopped by a signal or the time limit, "
    "--resume\n"
    "continues the run.";

}  // namespace

void describe_program(CommandLine& line, int& code) {
  line.set_version(version_text());
  Command app = line.program();
  app.footer(footer);
  app.require_command();
  add_new(app, code);
  add_run(app, code);
  add_check(app, code);
  add_cost(app, code);
  add_schema(app, code);
  add_info(app, code);
  add_merge(app, code);
  add_slurm(app, code);
  add_status(app, code);
  add_bench(app, code);
  add_selftest(app, code);
  add_fit(app, code);
  add_analyse(app, code);
  add_structure(app, code);
  add_report(app, code);
  add_export(app, code);
}

}  // namespace jostle::inline cli
