#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "config/scene.hpp"

// A text is a scene, or has faults; a scene is read again from its resolved form.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace jostle;
  const ParsedScene parsed =
      parse_scene(std::string_view(reinterpret_cast<const char*>(bytes), size));
  if (parsed.scene.has_value() != parsed.faults.empty()) std::abort();
  if (!parsed.scene) return 0;
  if (parse_scene(resolved(*parsed.scene).dump()).scene != parsed.scene) std::abort();
  return 0;
}
