#include "cli/commands/commands.hpp"
#include "cli/terminal/standard_streams.hpp"
#include "config/scene.hpp"

namespace jostle {

void add_schema(CLI::App& app, int& code) {
  auto* command = app.add_subcommand("schema", "Print the JSON Schema of scenes (draft-07)");
  command->footer(
      "Example:\n"
      "  jostle schema > scene.schema.json\n"
      "and \"$schema\": \"scene.schema.json\" in a scene lets an editor complete and check it.");
  command->callback([&code] {
    print_exactly(scene_schema());
    if (!scene_schema().ends_with('\n')) print_exactly("\n");
    code = exit_ok;
  });
}

}  // namespace jostle
