#include "engine/starts/starts.hpp"

#include <utility>

#include "engine/starts/parts.hpp"

namespace jostle {

namespace {

struct Builder {
  const Container& container;
  std::uint32_t n_spheres;
  RandomStream& random;
  const StopAsked& stop;
  Packing* before_fitting;

  std::vector<Vec3> operator()(const SteepestDescentPour&) const {
    return pour(container, n_spheres, random, stop);
  }
  std::vector<Vec3> operator()(const FittedPour&) const {
    const auto* box = std::get_if<WalledBox>(&container);
    if (box == nullptr) {
      throw StartError(
          "fitted pour: it fits a periodic pour between four flat walls, and this container has "
          "none; use a steepest-descent pour");
    }
    const PeriodicBox sides{box->width_x, box->width_y};
    if (const auto fault = width_fault(sides)) {
      throw StartError("fitted pour: the pour before the fitting needs periodic sides, and their " +
                       *fault + "; widen the box or use a steepest-descent pour");
    }
    std::vector<Vec3> poured = pour(sides, n_spheres, random, stop);
    if (before_fitting != nullptr) *before_fitting = {sides, poured};
    return fit_pour(*box, std::move(poured), random, stop);
  }
  std::vector<Vec3> operator()(const RandomSettle& start) const {
    return scatter(start, container, n_spheres, random);
  }
  std::vector<Vec3> operator()(const Crystal& start) const {
    return build_crystal(start, container, n_spheres);
  }
  std::vector<Vec3> operator()(const Grow& start) const {
    const auto* box = std::get_if<FullyPeriodicBox>(&container);
    if (box == nullptr) {
      throw StartError(
          "grow: it fills a fully periodic box, and this container has a floor; use a pour, a "
          "random settle or a crystal");
    }
    return grow(start, *box, n_spheres, random, stop);
  }
  std::vector<Vec3> operator()(const GivenPacking& start) const {
    return check_given(start, container, n_spheres);
  }
};

}  // namespace

Packing make_start(const Start& start, const Container& container, std::uint32_t n_spheres,
                   RandomStream& random, const StopAsked& stop, Packing* before_fitting) {
  if (n_spheres == 0) throw StartError("start: no spheres are asked for; ask for at least one");
  if (const auto fault = width_fault(container)) throw StartError("start: " + *fault);
  const Builder build{container, n_spheres, random, stop, before_fitting};
  return {container, std::visit(build, start)};
}

}  // namespace jostle
