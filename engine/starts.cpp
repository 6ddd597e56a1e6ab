#include "engine/starts.hpp"

#include "engine/start_parts.hpp"

namespace jostle {

namespace {

struct Builder {
  const Container& container;
  std::uint32_t n_spheres;
  RandomStream& random;
  const StopAsked& stop;

  std::vector<Vec3> operator()(const SteepestDescentPour&) const {
    return pour(container, n_spheres, random, stop);
  }
  std::vector<Vec3> operator()(const FittedPour& start) const {
    const auto* box = std::get_if<WalledBox>(&container);
    if (box == nullptr) {
      throw StartError(
          "fitted pour: it fits a periodic pour between four flat walls, and this container has "
          "none; use a steepest-descent pour");
    }
    return fit_pour(start, *box, n_spheres, random, stop);
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
                   RandomStream& random, const StopAsked& stop) {
  if (n_spheres == 0) throw StartError("start: no spheres are asked for; ask for at least one");
  if (const auto fault = width_fault(container)) throw StartError("start: " + *fault);
  return {container, std::visit(Builder{container, n_spheres, random, stop}, start)};
}

bool relaxes_before_recording(const Start& start) {
  return std::holds_alternative<RandomSettle>(start) || std::holds_alternative<FittedPour>(start);
}

}  // namespace jostle
