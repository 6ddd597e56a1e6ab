#include "structure/observables.hpp"

#include <algorithm>
#include <cassert>
#include <type_traits>
#include <utility>

#include "engine/bed/slab.hpp"
#include "structure/density/layers.hpp"
#include "structure/measure.hpp"
#include "structure/order/ordered_front.hpp"

namespace jostle::inline structure {

namespace {

struct Label {
  Column operator()(const MeanHeight&) const {
    return {std::string(MeanHeight::about.name), "diameter",
            "mean height of the sphere centres <Z>", "Philippe & Bideau 2001, sec. II"};
  }
  Column operator()(const BottomFraction&) const {
    return {std::string(BottomFraction::about.name), "1",
            "solids fraction Phi_b between the floor and 2 d", "Philippe & Bideau 2001, sec. III"};
  }
  Column operator()(const CorrectedFraction&) const {
    return {std::string(CorrectedFraction::about.name), "1",
            "solids fraction <Phi_c> of most of the packing, corrected for the floor",
            "Philippe & Bideau 2001, sec. III"};
  }
  Column operator()(const BulkFraction& bulk) const {
    return {bulk.name, "1", "solids fraction of the bulk, between two heights fixed for the run",
            "Rosato et al. 2010, sec. II"};
  }
  Column operator()(const CrystallineFraction&) const {
    return {std::string(CrystallineFraction::about.name), "1",
            "fraction of fcc and hcp spheres in the bulk",
            "Stukowski 2012, doi:10.1088/0965-0393/20/4/045021"};
  }
  Column operator()(const GrownLayers&) const {
    return {std::string(GrownLayers::about.name), "1",
            "ordered layers from the floor up to the first that is not",
            "Rosato et al. 2010, fig. 6"};
  }
  Column operator()(const OrderedHeight&) const {
    return {std::string(OrderedHeight::about.name), "diameter",
            "height up to which half of the spheres, layer by layer, are fcc or hcp",
            "Stukowski 2012, doi:10.1088/0965-0393/20/4/045021"};
  }
};

// The window an observable keeps for the whole run; {0, 0} where it needs none.
HeightWindow fixed_window(const Observable& observable, const Packing& start) {
  const auto* bulk = std::get_if<BulkFraction>(&observable);
  return bulk != nullptr ? resolve(bulk->window, start) : HeightWindow{0, 0};
}

/// Common-neighbour analysis is made once where several observables need it.
class Orders {
 public:
  explicit Orders(const Packing& packing) : packing_(packing) {}

  const std::vector<CrystalOrder>& operator()() {
    if (orders_.empty()) orders_ = crystal_order(packing_);
    return orders_;
  }

 private:
  const Packing& packing_;
  std::vector<CrystalOrder> orders_;
};

struct Measure {
  const Packing& packing;
  HeightWindow window;
  Orders& orders;

  double operator()(const MeanHeight&) const { return mean_height(packing); }

  double operator()(const BottomFraction&) const {
    return solids_fraction(packing, {0, 4 * sphere_radius});
  }

  double operator()(const CorrectedFraction& corrected) const {
    // A plane wall thins the first radius to 11/16 of the bulk (Philippe & Bideau 2001, sec. III):
    // the solid volume there counts 16/11 times, that is, 5/11 more.
    const double top = corrected.depth * 2 * mean_height(packing);
    const double thinned = std::min(sphere_radius, top);
    return solids_fraction(packing, {0, top}) +
           5.0 / 11.0 * solids_fraction(packing, {0, thinned}) * (thinned / top);
  }

  double operator()(const BulkFraction& bulk) const {
    return tapered_solids_fraction(packing, window, bulk.taper);
  }

  double operator()(const CrystallineFraction&) const {
    return crystalline_fraction(packing, orders(), bulk_of(packing));
  }

  double operator()(const GrownLayers&) const { return static_cast<double>(grown_layers(packing)); }

  double operator()(const OrderedHeight&) const { return ordered_height(packing, orders()); }
};

}  // namespace

std::optional<std::string> observable_fault(const Observable& observable,
                                            const Container& container) {
  if (has_gravity(container)) return std::nullopt;
  return label(observable).name +
         " is measured from a floor, a fully_periodic container has none: write \"observe\": [] "
         "and keep snapshots";
}

Column label(const Observable& observable) {
  return std::visit(Label{}, observable);
}

std::string_view observable_symbol(std::string_view name) {
  std::string_view symbol;
  [&]<class... Observables>(std::type_identity<std::variant<Observables...>>) {
    ((Observables::about.name == name ? void(symbol = Observables::about.symbol) : void()), ...);
  }(std::type_identity<Observable>{});
  return symbol;
}

Observer::Observer(const std::vector<Observable>& observables, const Packing& start)
    : observables_(observables) {
  windows_.reserve(observables.size());
  for (const Observable& observable : observables) {
    windows_.push_back(fixed_window(observable, start));
  }
}

Observer::Observer(const std::vector<Observable>& observables, std::vector<HeightWindow> windows)
    : observables_(observables), windows_(std::move(windows)) {
  assert(windows_.size() == observables_.size());
}

std::vector<double> Observer::operator()(const Packing& packing) const {
  require_equal_spheres(packing, "observables");
  std::vector<double> values;
  values.reserve(observables_.size());
  Orders orders(packing);
  for (std::size_t i = 0; i < observables_.size(); ++i) {
    values.push_back(std::visit(Measure{packing, windows_[i], orders}, observables_[i]));
  }
  return values;
}

}  // namespace jostle::inline structure
