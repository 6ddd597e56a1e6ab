#include "ensemble/analysis/motion/motion_tables.hpp"

#include <cmath>
#include <functional>
#include <utility>

#include "ensemble/analysis/motion/motion_curves.hpp"
#include "ensemble/statistics/finite_text.hpp"

namespace jostle::inline ensemble {

namespace {

constexpr const char *rahman = "after Rahman 1964, doi:10.1103/PhysRev.136.A405",
                     *four_point =
                         "after Dauchot et al. 2005, doi:10.1103/PhysRevLett.95.265701; "
                         "Keys et al. 2007, doi:10.1038/nphys572";

struct Label {
  std::string name;
  const char *units, *long_name, *source;
};

/// A table along waiting times, lags and maybe a place.
class MotionTable {
 public:
  using Row = std::function<std::vector<double>(std::size_t, std::size_t, std::size_t)>;

  MotionTable(std::string name, const MotionRecords& records) : records_(records) {
    table_.name = std::move(name);
    table_.axes = {{"waiting_time",
                    {"waiting_time"},
                    records.settings.origins,
                    "taps",
                    "tap that displacements are counted from",
                    ""},
                   {"lag", {"lag"}, records.settings.lags, "taps", "taps after it", ""}};
  }

  template <class Value>
  void add_places(const char* name, std::vector<Value> values, const char* units,
                  const char* long_name) {
    n_places_ = values.size();
    places_ = name;
    table_.axes.push_back({name, {name}, std::move(values), units, long_name, ""});
  }

  /// `estimate`: of an origin, a lag and a place.
  template <class Estimate>
  void add_means(const Label& label, const Estimate& estimate,
                 const char* of_error = "standard error over realizations, jackknife") {
    std::vector<double> values, errors, dof;
    for_all([&](std::size_t o, std::size_t l, std::size_t place) {
      const MeanEstimate mean = estimate(o, l, place);
      values.push_back(mean.value);
      errors.push_back(mean.error);
      dof.push_back(mean.dof);
    });
    add(label, std::move(values));
    add({label.name + "_error", label.units, of_error, ""}, std::move(errors));
    add({label.name + "_dof", "1", "its degrees of freedom", ""}, std::move(dof));
  }
  void add_means_of(const Label& label, const Row& row) {
    add_means(
        label,
        [&](std::size_t o, std::size_t l, std::size_t place) {
          return mean_estimate(row(o, l, place));
        },
        "standard error over realizations");
  }

  template <class Estimate>
  void add_intervals(const Label& label, const char* of_error, const char* of_end,
                     const Estimate& estimate) {
    constexpr std::pair<const char*, double LogEstimate::*> fields[] = {
        {"_low_68", &LogEstimate::low_68},
        {"_high_68", &LogEstimate::high_68},
        {"_low_95", &LogEstimate::low_95},
        {"_high_95", &LogEstimate::high_95}};
    std::vector<LogEstimate> estimates;
    for_all([&](std::size_t o, std::size_t l, std::size_t place) {
      estimates.push_back(estimate(o, l, place));
    });
    const auto values = [&](double LogEstimate::*field) {
      std::vector<double> all;
      for (const LogEstimate& log_estimate : estimates) all.push_back(log_estimate.*field);
      return all;
    };
    add(label, values(&LogEstimate::value));
    add({label.name + "_error", label.units, of_error, ""}, values(&LogEstimate::error));
    for (const auto& [ending, field] : fields)
      add({label.name + ending, label.units, of_end, ""}, values(field));
  }

  void add_count() {
    std::vector<std::uint64_t> counts;
    for (std::size_t o = 0; o < records_.settings.origins.size(); ++o)
      for (std::size_t l = 0; l < records_.settings.lags.size(); ++l) {
        std::uint64_t n = 0;
        for (const double value : records_.row("lateral_quartic", o, l)) n += !std::isnan(value);
        counts.push_back(n);
      }
    table_.quantities.push_back({"realizations",
                                 {"waiting_time", "lag"},
                                 std::move(counts),
                                 "1",
                                 "realizations that reached both taps",
                                 ""});
  }

  Table take() { return std::move(table_); }
  Table& table() { return table_; }

 private:
  template <class Action>
  void for_all(const Action& action) const {
    for (std::size_t o = 0; o < records_.settings.origins.size(); ++o)
      for (std::size_t l = 0; l < records_.settings.lags.size(); ++l)
        for (std::size_t place = 0; place < n_places_; ++place) action(o, l, place);
  }
  void add(const Label& label, std::vector<double> values) {
    std::vector<std::string> axes = {"waiting_time", "lag"};
    if (!places_.empty()) axes.push_back(places_);
    table_.quantities.push_back({label.name, std::move(axes), std::move(values), label.units,
                                 label.long_name, label.source});
  }

  const MotionRecords& records_;
  Table table_;
  std::size_t n_places_ = 1;
  std::string places_;
};

std::vector<double> copy(std::span<const double> row) {
  return {row.begin(), row.end()};
}

/// True if steps through periodic sides were short enough to be unambiguous.
void add_unwrapping(const MotionRecords& records, Table& table) {
  constexpr double sure = 0.25;
  double largest = 0;
  for (const double step : records.largest_step)
    if (step > largest) largest = step;
  if (largest == 0) return;
  table.quantities.push_back({"largest_step",
                              {},
                              std::vector{largest},
                              "1",
                              "largest step of a sphere in one tap along a periodic direction, in "
                              "periods",
                              ""});
  table.notes.emplace_back(
      "unwrapping", largest <= sure
                        ? "sound: no sphere moved more than a quarter of a period in a tap"
                        : "doubtful: a sphere moved more than a quarter of a period in a tap, and "
                          "one that moves more than half is taken for one that moved less the "
                          "other way; a wider container is safe");
}

/// Uses the last waiting time that can be compared, over its longest lag.
void add_age(const MotionRecords& records, Table& table) {
  const auto &origins = records.settings.origins, &lags = records.settings.lags;
  for (std::size_t o = origins.size(); o-- > 1;)
    for (std::size_t l = lags.size(); l-- > 0;) {
      const LogEstimate ratio = lateral_ratio(records, o, l);
      if (!is_limited(ratio)) continue;
      table.notes.emplace_back(
          "age", finite_text(
                     "over {} taps msd_lateral from tap {} is {:.3g} times that from tap {} (95 %: "
                     "{:.3g} to {:.3g})",
                     lags[l], origins[o], ratio.value, origins[0], ratio.low_95, ratio.high_95));
      return;
    }
}

Table displacement_table(const std::string& prefix, const MotionRecords& records) {
  MotionTable table(prefix + "displacement", records);
  const std::pair<const char*, const char*> directions[] = {
      {"msd_x", "mean square displacement along x"},
      {"msd_y", "mean square displacement along y"},
      {"msd_z", "mean square displacement along z, settling included"}};
  std::size_t direction = 0;
  for (const auto& [name, long_name] : directions) {
    table.add_means_of({name, "diameter^2", long_name, ""},
                       [&](std::size_t o, std::size_t l, std::size_t) {
                         return copy(records.row("square_displacement", o, l, direction));
                       });
    ++direction;
  }
  const auto add = [&](const char* name, const char* units, const char* long_name,
                       const char* source, const auto& rows) {
    table.add_means_of(
        {name, units, long_name, source},
        [&](std::size_t o, std::size_t l, std::size_t) { return rows(records, o, l); });
  };
  add("msd_lateral", "diameter^2", "mean square displacement sideways, x and y together", "",
      lateral_squares);
  table.add_means_of({"settling", "diameter",
                      "mean vertical displacement upwards: negative where spheres settle", ""},
                     [&](std::size_t o, std::size_t l, std::size_t) {
                       return copy(records.row("mean_displacement", o, l, 2));
                     });
  add("msd_z_about_mean", "diameter^2",
      "mean square vertical displacement about the mean of all spheres", "", vertical_squares);
  table.add_means(
      {"lateral_exponent", "1", "d ln msd_lateral / d ln lag, over a factor of four", ""},
      [&](std::size_t o, std::size_t l, std::size_t) { return lateral_exponent(records, o, l); });
  const auto add_estimates = [&](const char* name, const char* long_name, const auto& estimate) {
    table.add_means({name, "1", long_name, rahman}, [&](std::size_t o, std::size_t l, std::size_t) {
      return estimate(records, o, l);
    });
  };
  add_estimates("lateral_non_gaussian",
                "<r^4> / (2 <r^2>^2) - 1, sideways; < > over spheres and realizations",
                lateral_non_gaussian);
  add_estimates("vertical_non_gaussian",
                "<z^4> / (3 <z^2>^2) - 1, about each mean; < > over spheres and realizations",
                vertical_non_gaussian);
  table.add_intervals(
      {"lateral_ratio", "1", "msd_lateral over that of the first waiting time, geometric mean", ""},
      "standard error over realizations of ln of the value, times the value",
      "end of the interval, Student's t of ln of the value",
      [&](std::size_t o, std::size_t l, std::size_t) { return lateral_ratio(records, o, l); });
  table.add_count();
  add_age(records, table.table());
  add_unwrapping(records, table.table());
  return table.take();
}

Table overlap_table(const std::string& prefix, const MotionRecords& records) {
  MotionTable table(prefix + "overlap", records);
  table.add_places("overlap_length", records.settings.overlap_lengths, "diameter",
                   "largest displacement a");
  struct Kind {
    const char *row, *row_text, *chi_4, *of_chi_4, *independent, *of_layers;
  };
  constexpr Kind kinds[] = {
      {"lateral_overlap", "fraction of spheres that moved less than a sideways", "lateral_chi_4",
       "N times the variance over realizations of lateral_overlap", "lateral_chi_4_independent",
       "layer_lateral_overlap"},
      {"overlap", "fraction of spheres that moved less than a, settling included", "chi_4",
       "N times the variance over realizations of overlap", "chi_4_independent", "layer_overlap"}};
  for (const Kind& kind : kinds) {
    const auto row = [&](std::size_t o, std::size_t l, std::size_t length) {
      return records.row(kind.row, o, l, length);
    };
    table.add_means_of(
        {kind.row, "1", kind.row_text, four_point},
        [&](std::size_t o, std::size_t l, std::size_t length) { return copy(row(o, l, length)); });
    table.add_intervals({kind.chi_4, "1", kind.of_chi_4, four_point},
                        "value (2 / (M - 1))^(1/2), M realizations with normal overlaps",
                        "end of the interval, chi2 of normal overlaps",
                        [&](std::size_t o, std::size_t l, std::size_t length) {
                          return four_point_susceptibility(row(o, l, length), records.n_spheres);
                        });
    table.add_means_of(
        {kind.independent, "1",
         "chi_4 of spheres that move independently, and alike within layers: mean of Q_l (1 - Q_l)",
         ""},
        [&](std::size_t o, std::size_t l, std::size_t length) {
          return independent_susceptibility(records, kind.of_layers, o, l, length);
        });
  }
  table.add_count();
  return table.take();
}

Table layer_table(const std::string& prefix, const MotionRecords& records) {
  MotionTable table(prefix + "layers", records);
  std::vector<std::uint64_t> numbers;
  for (std::uint64_t k = 0; k < records.settings.layers; ++k) numbers.push_back(k);
  table.add_places("layer", std::move(numbers), "1",
                   "spheres in equal numbers by height at waiting_time, 0 lowest");
  table.add_means_of({"height", "diameter", "mean height of the layer at waiting_time", ""},
                     [&](std::size_t o, std::size_t, std::size_t layer) {
                       return copy(records.layer_heights(o, layer));
                     });
  table.add_means_of({"msd_lateral", "diameter^2", "mean square displacement sideways", ""},
                     [&](std::size_t o, std::size_t l, std::size_t layer) {
                       return layer_lateral_squares(records, o, l, layer);
                     });
  table.add_means_of({"settling", "diameter",
                      "mean vertical displacement upwards: negative where spheres settle", ""},
                     [&](std::size_t o, std::size_t l, std::size_t layer) {
                       return copy(records.row("layer_settling", o, l, layer));
                     });
  table.add_means_of({"msd_z_about_mean", "diameter^2",
                      "mean square vertical displacement about the layer's mean", ""},
                     [&](std::size_t o, std::size_t l, std::size_t layer) {
                       return layer_vertical_squares(records, o, l, layer);
                     });
  table.add_means(
      {"lateral_non_gaussian", "1",
       "<r^4> / (2 <r^2>^2) (1 + 1/(n M)) - 1, sideways; < > over the layer's n spheres and M "
       "realizations",
       rahman},
      [&](std::size_t o, std::size_t l, std::size_t layer) {
        return layer_lateral_non_gaussian(records, o, l, layer);
      });
  table.add_means(
      {"vertical_non_gaussian", "1",
       "<z^4> / (3 <z^2>^2) (1 + 2/((n - 1) M)) - 1, about each layer's mean; < > over the "
       "layer's n spheres and M realizations",
       rahman},
      [&](std::size_t o, std::size_t l, std::size_t layer) {
        return layer_vertical_non_gaussian(records, o, l, layer);
      });
  return table.take();
}

/// <dx^2 + dy^2> over 4 t of each realization, t being the lag.
std::vector<double> kind_diffusivities(const MotionRecords& records, std::size_t origin,
                                       std::size_t lag, std::size_t kind) {
  std::vector<double> values = kind_lateral_squares(records, origin, lag, kind);
  for (double& value : values) value /= 4 * static_cast<double>(records.settings.lags[lag]);
  return values;
}

Table kind_table(const std::string& prefix, const MotionRecords& records,
                 std::vector<std::string> kinds) {
  MotionTable table(prefix + "kinds", records);
  table.add_places("kind", std::move(kinds), "1", "kind of spheres");
  const auto add = [&](const char* name, const char* units, const char* long_name,
                       const auto& rows) {
    table.add_means_of(
        {name, units, long_name, ""},
        [&](std::size_t o, std::size_t l, std::size_t kind) { return rows(records, o, l, kind); });
  };
  add("rise", "diameter",
      "mean vertical displacement of the kind less that of all spheres: positive where the kind "
      "rises in the bed",
      kind_rise);
  add("msd_lateral", "diameter^2", "mean square displacement sideways, x and y together",
      kind_lateral_squares);
  add("msd_z_about_bed", "diameter^2",
      "mean square vertical displacement about the mean of all spheres", kind_vertical_squares);
  add("lateral_diffusivity", "diameter^2/tap",
      "msd_lateral over 4 lags: a diffusion coefficient where lateral_exponent is 1",
      kind_diffusivities);
  table.add_means(
      {"lateral_exponent", "1", "d ln msd_lateral / d ln lag, over a factor of four", ""},
      [&](std::size_t o, std::size_t l, std::size_t kind) {
        return kind_lateral_exponent(records, o, l, kind);
      });
  return table.take();
}

}  // namespace

std::vector<Table> motion_tables(const std::string& prefix, const MotionRecords& records,
                                 const std::vector<std::string>& kinds) {
  std::vector<Table> tables{displacement_table(prefix, records), overlap_table(prefix, records),
                            layer_table(prefix, records)};
  if (records.settings.kinds > 0) tables.push_back(kind_table(prefix, records, kinds));
  return tables;
}

}  // namespace jostle::inline ensemble
