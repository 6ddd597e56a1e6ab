#include "ensemble/structure_fits.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "ensemble/resampled_fit.hpp"
#include "fitting/models.hpp"
#include "structure/gradient.hpp"

namespace jostle {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A law and where it is sought.
struct FittedLaw {
  std::string quantity;  // fitted, along its places
  std::string prefix;    // of the parameters' names in the table
  std::string model;
  std::vector<std::string> units;  // of its parameters
  /// The law's variable at a place; nothing where the law does not hold.
  std::function<std::optional<double>(double place)> variable;
  /// What a value is multiplied by to become a count, whose error is its root; none: all alike.
  std::function<double(double place)> width{};
};

const std::vector<double>& places_of(const Measurement& measurement, std::string_view name) {
  const auto found = std::ranges::find(measurement.places, name, &Places::name);
  return std::get<std::vector<double>>(found->values);
}

/// The curves of one tap, up to the longest.
RealizationCurves curves_of(const FittedLaw& law, const std::vector<const Measurement*>& packings) {
  RealizationCurves curves;
  std::vector<const MeasuredQuantity*> quantities;
  const std::vector<double>* places = nullptr;
  for (const Measurement* packing : packings) {
    const MeasuredQuantity* quantity = packing != nullptr ? packing->find(law.quantity) : nullptr;
    if (quantity == nullptr) continue;
    quantities.push_back(quantity);
    const std::vector<double>& own = places_of(*packing, quantity->places);
    if (places == nullptr || own.size() > places->size()) places = &own;
  }
  curves.realizations = static_cast<std::uint32_t>(quantities.size());
  std::vector<double> counts, widths;
  for (std::size_t k = 0; places != nullptr && k < places->size(); ++k) {
    const auto t = law.variable((*places)[k]);
    if (!t) continue;
    curves.t.push_back(*t);
    double mean = 0;
    for (const MeasuredQuantity* quantity : quantities) {
      const double value = quantity->at(k);
      curves.values.push_back(value);
      mean += value / static_cast<double>(quantities.size());
    }
    if (law.width) {
      widths.push_back(law.width((*places)[k]));
      counts.push_back(mean * widths.back());
    }
  }
  double least = std::numeric_limits<double>::infinity();  // an empty bin could hold so much
  for (const double count : counts) least = count > 0 ? std::min(least, count) : least;
  for (std::size_t k = 0; k < counts.size() && std::isfinite(least); ++k) {
    curves.sigma.push_back(std::sqrt(std::max(counts[k], least)) / widths[k]);
  }
  return curves;
}

struct FoundLaw {
  std::vector<double> values, errors;  // [n_parameters]
  std::string status;
};

/// Whether there are more points that say something than parameters: bins that hold anything, where
/// the curve is one of counts.
bool has_points(const RealizationCurves& curves, std::size_t n_parameters) {
  const Curve mean = mean_curve(curves);
  const auto filled = std::ranges::count_if(mean.x, [](double x) { return x != 0; });
  return static_cast<std::size_t>(filled) > n_parameters;
}

FoundLaw fitted(const Model& model, const RealizationCurves& curves) {
  const std::size_t n = model.parameters().size();
  FoundLaw found{std::vector(n, nan), std::vector(n, nan), "converged"};
  if (curves.realizations == 0) return found.status = "no packing", found;
  if (!has_points(curves, n)) return found.status = "too few places that hold anything", found;
  const auto outcome = fit(model, mean_curve(curves), {.profiles = false, .memory = false});
  if (const auto* refusal = std::get_if<Refusal>(&outcome)) {
    return found.status = refusal->message, found;
  }
  const Fit& result = std::get<Fit>(outcome);
  if (!is_minimum(result.reason)) {
    return found.status = std::string("did not settle: ") + describe(result.reason), found;
  }
  found.values = result.values();
  if (curves.realizations < 2) return found;
  const ResampledErrors errors = resample(model, curves, result, {});
  if (errors.failed == 0) {
    found.errors = errors.errors;
  } else {
    found.status = std::to_string(errors.failed);
    found.status.append(" of ").append(std::to_string(errors.resamples));
    found.status.append(" refits without a realization did not settle: no error");
  }
  return found;
}

std::string in_lower_case(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c; });
  return text;
}

void add_law(const FittedLaw& law, const PartPackings& part, Table& table) {
  const auto model = make_model(law.model);
  const auto& parameters = model->parameters();
  std::vector<std::vector<double>> values(parameters.size()), errors(parameters.size());
  std::vector<std::string> status;
  for (const auto& packings : part) {
    const FoundLaw found = fitted(*model, curves_of(law, packings));
    for (std::size_t j = 0; j < parameters.size(); ++j) {
      values[j].push_back(found.values[j]);
      errors[j].push_back(found.errors[j]);
    }
    status.push_back(found.status);
  }
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    std::string name = law.prefix;
    name.append("_").append(in_lower_case(parameters[j].name));
    std::string meaning = parameters[j].meaning;
    meaning.append(", of ").append(law.quantity).append(" = ").append(model->formula());
    table.quantities.push_back(
        {name, {"tap"}, std::move(values[j]), law.units[j], std::move(meaning), model->source()});
    name.append("_error");
    table.quantities.push_back({std::move(name),
                                {"tap"},
                                std::move(errors[j]),
                                law.units[j],
                                "standard error by the jackknife over realizations",
                                ""});
  }
  table.quantities.push_back({law.prefix + "_status",
                              {"tap"},
                              std::move(status),
                              "1",
                              "converged, or why there is no fit",
                              ""});
}

std::optional<double> itself(double place) {
  return place;
}
double one(double) {
  return 1;
}
double pore_volume(double xi) {
  return xi * xi * xi;
}

}  // namespace

void add_fits(std::string_view part_name, const PartPackings& part,
              const StructureSettings& settings, Table& table) {
  if (part_name == "profile") {
    // In R, above the layers at the floor.
    const double low =
        settings.profile->gradient ? settings.profile->gradient->low : GradientRange{}.low;
    const auto in_radii = [low](double height) {
      return height >= low ? std::optional(height / sphere_radius) : std::nullopt;
    };
    add_law({"phi", "eq7", "profile", {"1", "1/R", "1/R", "R"}, in_radii}, part, table);
  } else if (part_name == "coordination") {
    add_law({"neighbour_share", "normal", "normal", {"1", "1", "1"}, itself, one}, part, table);
  } else if (part_name == "voronoi") {
    add_law({"face_share", "normal", "normal", {"1", "1", "1"}, itself, one}, part, table);
    const auto above_least = [](double free_volume) {
      const double t = free_volume - least_free_volume;
      return t > 0 ? std::optional(t) : std::nullopt;
    };
    add_law({"free_volume_density",
             "k_gamma",
             "k_gamma",
             {"1", "sphere volumes", "1"},
             above_least,
             one},
            part, table);
  } else if (part_name == "pores") {
    const auto tail = [from = settings.pores->tail_from](double xi) {
      return pore_volume(xi) >= from ? std::optional(pore_volume(xi)) : std::nullopt;
    };
    const auto width = [bin = settings.pores->bin_width](double xi) {
      return pore_volume(xi + 0.5 * bin) - pore_volume(xi - 0.5 * bin);
    };
    add_law({"rho_v", "tail", "pore_tail", {"1", "R^3"}, tail, width}, part, table);
  }
}

}  // namespace jostle
