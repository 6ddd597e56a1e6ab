#include "results/export/container_text.hpp"

namespace jostle::inline results {
namespace {

ContainerText text_of(const PeriodicBox& box) {
  return {"periodic", {box.width_x, box.width_y, 0}};
}
ContainerText text_of(const WalledBox& box) {
  return {"walls", {box.width_x, box.width_y, 0}};
}
ContainerText text_of(const Cylinder& tube) {
  return {"cylinder", {tube.diameter, tube.diameter, 0}};
}
ContainerText text_of(const FullyPeriodicBox& box) {
  return {"fully_periodic", {box.width_x, box.width_y, box.height}};
}

}  // namespace

ContainerText container_text(const Container& container) {
  return std::visit([](const auto& one) { return text_of(one); }, container);
}

std::optional<Container> container_from(std::string_view kind,
                                        const std::array<double, 3>& widths) {
  if (kind == "periodic") return PeriodicBox{widths[0], widths[1]};
  if (kind == "walls") return WalledBox{widths[0], widths[1]};
  if (kind == "cylinder") return Cylinder{widths[0]};
  if (kind == "fully_periodic") return FullyPeriodicBox{widths[0], widths[1], widths[2]};
  return std::nullopt;
}

}  // namespace jostle::inline results
