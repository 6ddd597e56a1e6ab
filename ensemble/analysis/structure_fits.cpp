#include "ensemble/analysis/structure_fits.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "engine/numbers.hpp"
#include "ensemble/analysis/histogram_fit.hpp"
#include "ensemble/statistics/diverged.hpp"
#include "ensemble/statistics/jackknife.hpp"
#include "ensemble/statistics/resampled_fit.hpp"
#include "fitting/models/models.hpp"
#include "structure/density/gradient.hpp"

namespace jostle::inline ensemble {

namespace {

constexpr double least_depth =
    2;  // least depth of bed between the layers at the floor and the surface

/// Result of a law at one tap.
struct FoundLaw {
  HistogramFit fit;
  std::uint32_t realizations = 0;
};

using Packings = std::vector<const Measurement*>;  // Packings of one tap, [n_realizations]

/// A law, what it is fitted to, and how.
struct FittedLaw {
  std::string quantity;  // quantity of the law
  std::string prefix;    // prefix of the names of parameters in the table
  std::string model;
  std::vector<std::string> units;  // units of the parameters; empty: left out
  std::function<FoundLaw(const Model&, const Packings&)> found;
  bool of_counts = false;
  std::string variable = "";  // meaning of t in the formula, where it is not the quantity's axis
};

const std::vector<double>& places_of(const Measurement& measurement, std::string_view name) {
  const auto found = std::ranges::find(measurement.places, name, &Places::name);
  return std::get<std::vector<double>>(found->values);
}

/// The packings that have the quantity, and the longest list of its places.
struct Values {
  std::vector<const Measurement*> packings;
  std::vector<const MeasuredQuantity*> quantities;
  std::vector<double> places;
};

Values values_of(const std::string& name, const Packings& packings) {
  Values all;
  for (const Measurement* packing : packings) {
    const MeasuredQuantity* quantity = packing != nullptr ? packing->find(name) : nullptr;
    if (quantity == nullptr) continue;
    all.packings.push_back(packing);
    all.quantities.push_back(quantity);
    const std::vector<double>& own = places_of(*packing, quantity->places);
    if (own.size() > all.places.size()) all.places = own;
  }
  return all;
}

/// Least squares to the mean curve, all points alike, where `variable` gives the law's variable.
FoundLaw fitted_curve(const std::string& quantity, const Model& model, const Packings& packings,
                      const std::function<std::optional<double>(double place)>& variable) {
  const Values all = values_of(quantity, packings);
  RealizationCurves curves;
  curves.realizations = static_cast<std::uint32_t>(all.quantities.size());
  for (std::size_t k = 0; k < all.places.size(); ++k) {
    const auto t = variable(all.places[k]);
    if (!t) continue;
    curves.t.push_back(*t);
    for (const MeasuredQuantity* measured_quantity : all.quantities) {
      curves.values.push_back(measured_quantity->value_at(k));
    }
  }
  const std::size_t n = model.parameters().size();
  FoundLaw found{
      {std::vector(n, not_a_number), std::vector(n, not_a_number), not_a_number, "converged"},
      curves.realizations};
  std::string& status = found.fit.status;
  if (curves.realizations == 0) return status = "no packing", found;
  const auto outcome = fit(model, mean_curve(curves), {.profiles = false, .memory = false});
  if (const auto* refusal = std::get_if<Refusal>(&outcome)) return status = refusal->message, found;
  const Fit& result = std::get<Fit>(outcome);
  if (!is_minimum(result.reason)) {
    return status = std::string("did not settle: ") + describe(result.reason), found;
  }
  if (const std::string lost = diverged_parameters(result); !lost.empty())
    return status = lost, found;
  found.fit.values = result.values();
  if (curves.realizations < 2) return found;
  const ResampledErrors errors = resample(model, curves, result, {});
  if (errors.failed == 0) {
    found.fit.errors = errors.errors;
  } else {
    status = std::to_string(errors.failed);
    status.append(" of ").append(std::to_string(errors.resamples));
    status.append(" refits without a realization did not settle: no error");
  }
  return found;
}

/// Counts of a histogram: `bin` gives the law's variable at a place, `number` the count for 1 of
/// the quantity in a packing. Whole numbers beyond the last one found count as empty.
FoundLaw fitted_counts(const std::string& quantity, const Model& model, const Packings& packings,
                       const std::function<std::optional<Bin>(double place)>& bin,
                       const std::function<double(const Measurement&)>& number,
                       std::size_t beyond = 0) {
  Values all = values_of(quantity, packings);
  for (std::size_t i = 0; i < beyond && !all.places.empty(); ++i) {
    all.places.push_back(all.places.back() + 1);
  }
  Histogram histogram;
  histogram.realizations = static_cast<std::uint32_t>(all.quantities.size());
  for (std::size_t k = 0; k < all.places.size(); ++k) {
    const auto place = bin(all.places[k]);
    if (!place) continue;
    histogram.bins.push_back(*place);
    for (std::size_t r = 0; r < all.quantities.size(); ++r) {
      histogram.counts.push_back(all.quantities[r]->value_at(k) * number(*all.packings[r]));
    }
  }
  return {fit_histogram(model, histogram), histogram.realizations};
}

std::string in_lower_case(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c; });
  return text;
}

void add_parameter(const FittedLaw& law, const Model& model, std::size_t j,
                   const std::vector<FoundLaw>& taps, Table& table) {
  const Parameter& parameter = model.parameters()[j];
  // Beyond a parameter's bounds, and below 0 for the amplitude of counts, the truth cannot lie.
  const double least = law.of_counts && parameter.linear ? 0 : parameter.lower;
  std::vector<double> values, errors, dof, low, high;
  for (const FoundLaw& found : taps) {
    const double value = found.fit.values[j], error = found.fit.errors[j];
    const double reach = student_half_width(error, found.realizations, interval_levels[1]);
    values.push_back(value);
    errors.push_back(error);
    dof.push_back(found.realizations > 0 ? static_cast<double>(found.realizations - 1) : 0);
    low.push_back(std::isnan(reach) ? reach : std::max(value - reach, least));
    high.push_back(std::isnan(reach) ? reach : std::min(value + reach, parameter.upper));
  }
  std::string name = law.prefix;
  name.append("_").append(in_lower_case(parameter.name));
  std::string meaning = parameter.meaning;
  meaning.append(", of ").append(law.quantity).append(" = ").append(model.formula());
  if (!law.variable.empty()) meaning.append("; t: ").append(law.variable);
  const auto add = [&](const char* ending, std::vector<double> of_taps, std::string long_name,
                       std::string source) {
    table.quantities.push_back({name + ending,
                                {"tap"},
                                std::move(of_taps),
                                law.units[j],
                                std::move(long_name),
                                std::move(source)});
  };
  add("", std::move(values), std::move(meaning), model.source());
  add("_error", std::move(errors), "standard error by the jackknife over realizations", "");
  table.quantities.push_back(
      {name + "_dof", {"tap"}, std::move(dof), "1", "degrees of freedom of the error", ""});
  add("_low_95", std::move(low), "lower end of the 95 % interval, Student's t over realizations",
      "");
  add("_high_95", std::move(high), "its upper end", "");
}

void add_law(const FittedLaw& law, const PartPackings& part, Table& table) {
  const auto model = make_model(law.model);
  std::vector<FoundLaw> taps;
  std::vector<double> p;
  std::vector<std::string> status;
  for (const Packings& packings : part) {
    taps.push_back(law.found(*model, packings));
    p.push_back(taps.back().fit.p);
    status.push_back(taps.back().fit.status);
  }
  for (std::size_t j = 0; j < law.units.size(); ++j) {
    if (!law.units[j].empty()) add_parameter(law, *model, j, taps, table);
  }
  if (law.of_counts) {
    table.quantities.push_back(
        {law.prefix + "_p",
         {"tap"},
         std::move(p),
         "1",
         "p-value of the law: chi2 over the scatter between realizations (F), of one chi2 alone",
         ""});
  }
  table.quantities.push_back({law.prefix + "_status",
                              {"tap"},
                              std::move(status),
                              "1",
                              "whether the law was found and holds, or why there is no fit",
                              ""});
}

std::optional<Bin> whole_number(double place) {
  return Bin{place, place};
}

// Where there is no number to count by there is nothing to fit.
double single(const Measurement& measurement, std::string_view name) {
  const MeasuredQuantity* quantity = measurement.find(name);
  return quantity != nullptr ? quantity->value_at(0) : 0;
}

/// The normal law of whole numbers, of shares of what `counted` counts.
FittedLaw normal_law(const char* shares, const char* counted) {
  constexpr std::size_t beyond = 20;
  return {shares,
          "normal",
          "normal",
          {"", "1", "1"},
          [shares, counted](const Model& model, const Packings& packings) {
            return fitted_counts(
                shares, model, packings, whole_number,
                [&](const Measurement& packing) { return single(packing, counted); }, beyond);
          },
          true};
}

FittedLaw density_profile(const ProfileSettings& settings) {
  // In R, above the layers at the floor.
  const double low = settings.gradient ? settings.gradient->low : GradientRange{}.low;
  return {"phi",
          "eq7",
          "profile",
          {"1", "1/R", "1/R", "R"},
          [low](const Model& model, const Packings& packings) {
            FoundLaw found = fitted_curve("phi", model, packings, [low](double height) {
              return height >= low ? std::optional(height / sphere_radius) : std::nullopt;
            });
            const double surface = found.fit.values[3] * sphere_radius;  // z*
            if (surface < low + least_depth) {
              std::ranges::fill(found.fit.values, not_a_number);
              std::ranges::fill(found.fit.errors, not_a_number);
              found.fit.status = "the surface is less than 2 d above the layers at the floor";
            }
            return found;
          }};
}

FittedLaw free_volumes(const VoronoiSettings& settings) {
  return {"free_volume_density",
          "k_gamma",
          "k_gamma",
          {"", "sphere volumes", "1"},
          [width = settings.bin_width](const Model& model, const Packings& packings) {
            const auto bin = [width](double middle) -> std::optional<Bin> {
              const double low = middle - 0.5 * width - least_free_volume;
              if (low + width <= 0) return std::nullopt;
              return Bin{std::max(low, 0.0), low + width};
            };
            return fitted_counts(
                "free_volume_density", model, packings, bin,
                [width](const Measurement& packing) { return width * single(packing, "n_cells"); });
          },
          true,
          "the free volume less the least that a cell can have"};
}

FittedLaw pore_tail(const PoresSettings& settings) {
  return {"rho_v",
          "tail",
          "pore_tail",
          {"1", "sphere volumes"},
          [tail_start = settings.tail_from, width = settings.bin_width](const Model& model,
                                                                        const Packings& packings) {
            const auto bin = [tail_start, width](double xi) -> std::optional<Bin> {
              const double low = xi - 0.5 * width, high = xi + 0.5 * width;
              if (xi * xi * xi < tail_start) return std::nullopt;
              return Bin{low * low * low, high * high * high};
            };
            return fitted_counts("rho_xi", model, packings, bin,
                                 [width](const Measurement&) { return width; });
          },
          true};
}

/// The least free volume of a cell, from which the k-gamma law counts, is that of equal spheres.
bool is_of_mixtures(const PartPackings& part) {
  return std::ranges::any_of(part, [](const auto& realizations) {
    return std::ranges::any_of(realizations, [](const Measurement* measurement) {
      return measurement != nullptr && measurement->find("cells_of_kind") != nullptr;
    });
  });
}

}  // namespace

void add_fits(std::string_view part_name, const PartPackings& part,
              const StructureSettings& settings, Table& table) {
  if (part_name == "profile") {
    add_law(density_profile(*settings.profile), part, table);
  } else if (part_name == "coordination") {
    add_law(normal_law("neighbour_share", "n_spheres"), part, table);
  } else if (part_name == "voronoi") {
    add_law(normal_law("face_share", "n_cells"), part, table);
    if (!is_of_mixtures(part)) add_law(free_volumes(*settings.voronoi), part, table);
  } else if (part_name == "pores") {
    add_law(pore_tail(*settings.pores), part, table);
  }
}

}  // namespace jostle::inline ensemble
