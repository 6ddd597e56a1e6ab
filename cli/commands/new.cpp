#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/commands/commands.hpp"
#include "cli/files/keep_tables.hpp"
#include "cli/files/output_file.hpp"
#include "cli/options/command_words.hpp"
#include "cli/terminal/standard_streams.hpp"
#include "config/json/json_text.hpp"
#include "config/json/suggestion.hpp"
#include "config/shipped_scenes.hpp"
#include "results/disk/input_file.hpp"
#include "results/disk/output_path.hpp"
#include "study/provenance.hpp"
#include "study/running/scene_file.hpp"

namespace jostle::inline cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* schema_name = "scene.schema.json";

struct NewArguments {
  std::string name, scene = "quickstart";
  bool force = false;
};

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const ShippedScene& scene : shipped_scenes()) names.emplace_back(scene.name);
  return names;
}

std::string text_of(const std::string& name) {
  for (const ShippedScene& scene : shipped_scenes()) {
    if (scene.name == name || fmt::format("{}.json", scene.name) == name) {
      return std::string(scene.text);
    }
  }
  const std::vector<std::string> names = scene_names();
  throw BadInput(fmt::format("--from {}: there is no such scene.{} There are\n  {}", name,
                             did_you_mean(name, names), joined(names, "\n  ")));
}

/// The text of a shipped scene with another string, without escapes, at a key of its outermost
/// object, the first of that name.
std::string with_string(std::string text, const std::string& key, const std::string& value) {
  const std::string prefix = fmt::format("\"{}\": \"", key);
  const std::size_t found = text.find(prefix);
  if (found == std::string::npos) return text;
  const std::size_t begin = found + prefix.size();
  return text.replace(begin, text.find('"', begin) - begin, value);
}

void require_no_stream(const fs::path& path) {
  if (is_stream(path.string()))
    throw BadInput(fmt::format(
        "{} is a pipe or a device: remove it, or take another name or folder", path.string()));
}

/// The schema beside the scene, which editors complete its keys by.
void write_schema(const fs::path& path, bool force) {
  require_no_stream(path);
  require_no_link(path.string());
  if (fs::exists(path) && !force) {
    if (read_text_file(path.string()) == scene_schema()) return;
    print_to_standard_error(fmt::format(
        "jostle: {} is not the schema of this version, and is kept; --force replaces it\n",
        path.string()));
    return;
  }
  write_text(path.string(), scene_schema(), ExistingFile::replaced);
}

int write_new_scene(const NewArguments& arguments) {
  fs::path path = arguments.name;
  if (path.extension() == ".json") path.replace_extension();
  const std::string name = path.filename().string();
  path += ".json";
  std::string text = with_string(text_of(arguments.scene), "name", name);
  text = with_string(text, "$schema", schema_name);
  const ParsedScene parsed = parse_scene(text);
  if (!parsed.scene)
    throw BadInput(fmt::format("{}: {}", arguments.name, fault_lines(parsed.faults)));
  require_folder(path.string());
  output_path(path.string());  // refuses links of others
  require_no_stream(path);
  if (fs::exists(path) && !arguments.force) {
    throw BadInput(
        fmt::format("{} exists and is kept: take another name, or replace it with "
                    "--force",
                    path.string()));
  }
  write_schema(path.parent_path() / schema_name, arguments.force);
  write_text(path.string(), text, existing_files(arguments.force));
  print(fmt::format(
      "{}: a copy of {}; {} estimates its cost, {} writes {}.h5\n", path.string(), arguments.scene,
      shell_words({command_line().front(), "check", operand(path.string())}),
      shell_words({command_line().front(), "run", operand(path.string())}), parsed.scene->name));
  return exit_ok;
}

}  // namespace

void add_new(Command& app, int& code) {
  Command command = app.add_command("new", "Write a scene of your own, from one that is shipped");
  auto arguments = std::make_shared<NewArguments>();
  command.add_option("name", arguments->name, "Name of the scene: NAME.json is written").required();
  command
      .add_option("--from", arguments->scene,
                  "A shipped scene (default: quickstart); an unknown name lists them")
      .offers(scene_names());
  command.add_flag("--force", arguments->force, "Replace files that exist");
  command.footer(
      "Examples:\n"
      "  jostle new my-bed                                     writes my-bed.json\n"
      "  jostle new bell --from philippe-bideau-2001/fig4-bell\n"
      "\n"
      "The results of the scene go to NAME.h5. scene.schema.json is written beside it: editors\n"
      "complete and check keys by it.");
  command.run([arguments, &code] { code = write_new_scene(*arguments); });
}

}  // namespace jostle::inline cli
