#include "structure/observables.hpp"

#include <algorithm>
#include <cassert>
#include <sstream>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "engine/bed/slab.hpp"
#include "structure/density/layers.hpp"
#include "structure/measure.hpp"
#include "structure/mixing.hpp"
#include "structure/order/ordered_front.hpp"

namespace jostle::inline structure {

namespace {

struct Label {
  Spheres spheres = Spheres::equal;

  Column operator()(const MeanHeight&) const {
    return {std::string(MeanHeight::description.name), "diameter",
            spheres == Spheres::equal
                ? "mean height of the sphere centres <Z>"
                : "mean height of the sphere centres <Z>, weighted by the volumes of the spheres",
            "Philippe & Bideau 2001, sec. II"};
  }
  Column operator()(const BottomFraction&) const {
    return {std::string(BottomFraction::description.name), "1",
            "solids fraction Phi_b between the floor and 2 d", "Philippe & Bideau 2001, sec. III"};
  }
  Column operator()(const CorrectedFraction&) const {
    return {std::string(CorrectedFraction::description.name), "1",
            "solids fraction <Phi_c> of most of the packing, corrected for the floor",
            "Philippe & Bideau 2001, sec. III"};
  }
  Column operator()(const BulkFraction& bulk) const {
    return {bulk.name, "1", "solids fraction of the bulk, between two heights fixed for the run",
            "Rosato et al. 2010, sec. II"};
  }
  Column operator()(const CrystallineFraction&) const {
    return {std::string(CrystallineFraction::description.name), "1",
            "fraction of fcc and hcp spheres in the bulk",
            "Stukowski 2012, doi:10.1088/0965-0393/20/4/045021"};
  }
  Column operator()(const GrownLayers&) const {
    return {std::string(GrownLayers::description.name), "1",
            "ordered layers from the floor up to the first that is not",
            "Rosato et al. 2010, fig. 6"};
  }
  Column operator()(const OrderedHeight&) const {
    return {std::string(OrderedHeight::description.name), "diameter",
            "height up to which half of the spheres, layer by layer, are fcc or hcp",
            "Stukowski 2012, doi:10.1088/0965-0393/20/4/045021"};
  }
  Column operator()(const KindHeight& height) const {
    return {"height_" + height.kind, "diameter",
            "mean height of the spheres of kind " + height.kind + ", weighted by volume", "jostle"};
  }
  Column operator()(const Segregation& s) const {
    return {std::string(Segregation::description.name) + suffix(s.large) + suffix(s.small), "1",
            "segregation S = 2 (z_L - z_S)/H of two kinds", "jostle"};
  }
  Column operator()(const LaceyIndex& index) const {
    std::ostringstream text;
    text << "Lacey's mixing index of "
         << (index.kind ? "kind " + *index.kind : "the kind of the largest mean diameter")
         << " on cells of " << index.cell << " d; its random state has fixed numbers of spheres";
    return {std::string(LaceyIndex::description.name) + suffix(index.kind), "1", text.str(),
            "jostle"};
  }

 private:
  static std::string suffix(const std::optional<std::string>& kind) {
    return kind ? "_" + *kind : "";
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
    return solids_fraction(packing, {0, 4 * sphere_radius});  // in a mixture, too: 2 d
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

  double operator()(const KindHeight& height) const {
    return kind_height(packing, kind_named(*packing.sizes, height.kind));
  }

  double operator()(const Segregation& s) const {
    return segregation(
        packing, s.large ? kind_named(*packing.sizes, *s.large) : largest_kind(*packing.sizes),
        s.small ? kind_named(*packing.sizes, *s.small) : smallest_kind(*packing.sizes));
  }

  double operator()(const LaceyIndex& index) const {
    return lacey_index(
        packing,
        index.kind ? kind_named(*packing.sizes, *index.kind) : largest_kind(*packing.sizes),
        index.cell);
  }
};

template <class Observed>
constexpr bool of_equal_spheres =
    std::is_same_v<Observed, CorrectedFraction> || std::is_same_v<Observed, CrystallineFraction> ||
    std::is_same_v<Observed, GrownLayers> || std::is_same_v<Observed, OrderedHeight>;
template <class Observed>
constexpr bool of_mixtures =
    std::is_same_v<Observed, KindHeight> || std::is_same_v<Observed, Segregation> ||
    std::is_same_v<Observed, LaceyIndex>;

/// The kinds that an observable names.
struct NamedKinds {
  using Names = std::vector<std::optional<std::string>>;
  Names operator()(const KindHeight& height) const { return {height.kind}; }
  Names operator()(const Segregation& s) const { return {s.large, s.small}; }
  Names operator()(const LaceyIndex& index) const { return {index.kind}; }
  template <class Other>
  Names operator()(const Other&) const {
    return {};
  }
};

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// Throws std::invalid_argument, as a caller of the library sees it: scenes are checked when read.
void require_measurable(const Packing& packing, const std::vector<Observable>& observables) {
  std::vector<std::string> kinds;
  if (packing.sizes)
    for (const SphereKind& kind : packing.sizes->kinds()) kinds.push_back(kind.name);
  for (const Observable& observable : observables) {
    const auto fault =
        packing.sizes ? mixture_fault(observable, kinds) : equal_spheres_fault(observable);
    if (fault) throw std::invalid_argument(*fault);
  }
}

}  // namespace

std::optional<std::string> observable_fault(const Observable& observable,
                                            const Container& container) {
  if (has_gravity(container)) return std::nullopt;
  return label(observable).name +
         " is measured from a floor, a fully_periodic container has none: write \"observe\": [] "
         "and keep snapshots";
}

std::optional<std::string> mixture_fault(const Observable& observable,
                                         const std::vector<std::string>& kinds) {
  const bool equal = std::visit(
      []<class Observed>(const Observed&) { return of_equal_spheres<Observed>; }, observable);
  if (equal)
    return label(observable).name +
           " is defined for equal spheres alone: leave it out of what is observed of a mixture";
  for (const auto& name : std::visit(NamedKinds{}, observable)) {
    if (name && std::ranges::find(kinds, *name) == kinds.end())
      return "no kind of spheres is named \"" + *name + "\" (kinds: " + listed(kinds) + ")";
  }
  const bool of_two = std::visit(
      []<class Observed>(const Observed&) {
        return std::is_same_v<Observed, Segregation> || std::is_same_v<Observed, LaceyIndex>;
      },
      observable);
  if (of_two && kinds.size() < 2)
    return label(observable).name + " is that of two kinds of spheres or more, and there is one";
  return std::nullopt;
}

std::optional<std::string> equal_spheres_fault(const Observable& observable) {
  const bool mixtures =
      std::visit([]<class Observed>(const Observed&) { return of_mixtures<Observed>; }, observable);
  if (!mixtures) return std::nullopt;
  return label(observable).name +
         " is measured of kinds of spheres: list kinds under \"spheres\", or leave it out";
}

Column label(const Observable& observable, Spheres spheres) {
  return std::visit(Label{spheres}, observable);
}

std::string_view observable_symbol(std::string_view name) {
  std::string_view symbol;
  [&]<class... Observables>(std::type_identity<std::variant<Observables...>>) {
    ((Observables::description.name == name ? void(symbol = Observables::description.symbol)
                                            : void()),
     ...);
  }(std::type_identity<Observable>{});
  return symbol;
}

std::vector<Observable> with_kinds(std::vector<Observable> observables,
                                   const std::vector<MixtureKind>& kinds) {
  if (kinds.empty()) return observables;
  const MixtureKind *largest = &kinds.front(), *smallest = largest;
  for (const MixtureKind& kind : kinds) {
    const double mean = mean_of(kind.diameter);
    if (mean > mean_of(largest->diameter)) largest = &kind;
    if (mean <= mean_of(smallest->diameter)) smallest = &kind;
  }
  for (Observable& observable : observables) {
    if (auto* s = std::get_if<Segregation>(&observable)) {
      if (!s->large) s->large = largest->name;
      if (!s->small) s->small = smallest->name;
    } else if (auto* index = std::get_if<LaceyIndex>(&observable)) {
      if (!index->kind) index->kind = largest->name;
    }
  }
  return observables;
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
  require_measurable(packing, observables_);
  std::vector<double> values;
  values.reserve(observables_.size());
  Orders orders(packing);
  for (std::size_t i = 0; i < observables_.size(); ++i) {
    values.push_back(std::visit(Measure{packing, windows_[i], orders}, observables_[i]));
  }
  return values;
}

}  // namespace jostle::inline structure
