#include "cli/commands/commands.hpp"
#include "cli/terminal/standard_streams.hpp"
#include "config/scene.hpp"

namespace jostle::inline cli {

void add_schema(Command& app, int& code) {
  Command command = app.add_command("schema", "Print the JSON Schema of scenes (draft-07)");
  command.footer(
      "Example:\n"
      "  jostle schema > scene.schema.json\n"
      "and \"$schema\": \"scene.schema.json\" in a scene lets an editor complete and check it.");
  command.run([&code] {
    print_exactly(scene_schema());
    code = exit_ok;
  });
}

}  // namespace jostle::inline cli
