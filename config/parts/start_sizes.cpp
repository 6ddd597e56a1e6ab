#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/parts/parts.hpp"
#include "ensemble/statistics/counted.hpp"
#include "ensemble/statistics/finite_text.hpp"

namespace jostle::inline config {

namespace {

std::vector<std::string> kind_names(const Sizes& sizes) {
  std::vector<std::string> names;
  for (const SphereKind& kind : sizes.kinds()) names.push_back(kind.name);
  return names;
}

/// The kind of every sphere of a file among those that a scene lists. A file with kinds of other
/// names is refused; one with a single kind is numbered as the scene lists its kinds.
std::vector<std::uint32_t> listed_kinds(const Sizes* sizes, const Scene& scene,
                                        const std::string& path) {
  std::vector<std::uint32_t> kinds;
  if (sizes == nullptr || sizes->kinds().size() == 1) {
    for (std::uint32_t k = 0; k < scene.kinds.size(); ++k)
      kinds.insert(kinds.end(), scene.kinds[k].count, k);
    return kinds;
  }
  const std::vector<std::string> names = kind_names(*sizes);
  std::vector<std::uint32_t> number;  // place in the scene of the file's kinds
  for (const std::string& name : names) {
    const auto found = std::ranges::find(scene.kinds, name, &MixtureKind::name);
    if (found == scene.kinds.end())
      throw StartError(
          fmt::format("{} holds spheres of kind \"{}\", which the scene does not "
                      "list: list the kinds of the file ({}), or give \"spheres\" as "
                      "a number",
                      path, name, listed(names)));
    number.push_back(static_cast<std::uint32_t>(found - scene.kinds.begin()));
  }
  for (const std::uint32_t kind : sizes->kind_of()) kinds.push_back(number[kind]);
  return kinds;
}

/// Throws StartError where the spheres of a kind are not as many, or not as large, in the scene's
/// order.
void require_listed(const MixtureKind& kind, const std::vector<double>& diameters,
                    const std::string& path) {
  if (diameters.size() != kind.count)
    throw StartError(fmt::format(
        "{} holds {} of kind \"{}\", the scene lists {}: set its "
        "\"count\" to {}",
        path, counted(diameters.size(), "sphere"), kind.name, kind.count, diameters.size()));
  constexpr double rounding = 1e-6;  // digits that another program did not write
  const DiameterRange range = range_of(kind.diameter);
  const auto* list = std::get_if<ListedDiameters>(&kind.diameter);
  for (std::size_t i = 0; i < diameters.size(); ++i) {
    const double least = list ? list->values[i] : range.least,
                 greatest = list ? list->values[i] : range.greatest, d = diameters[i];
    if (d >= least * (1 - rounding) && d <= greatest * (1 + rounding)) continue;
    throw StartError(
        finite_text("{} holds a sphere of kind \"{}\" of diameter {:.6g}, the scene "
                    "lists diameters from {:.6g} to {:.6g}: correct \"diameter\", or "
                    "give \"spheres\" as a number",
                    path, kind.name, d, least, greatest));
  }
}

std::shared_ptr<const Sizes> with_listed_kinds(const Sizes* of_file, const Scene& scene,
                                               const std::string& path) {
  const std::vector<double> diameters =
      of_file ? diameters_of(*of_file) : std::vector<double>(scene.n_spheres, 2 * sphere_radius);
  std::vector<std::uint32_t> kind_of = listed_kinds(of_file, scene, path);
  std::vector<SphereKind> kinds;
  for (std::uint32_t k = 0; k < scene.kinds.size(); ++k) {
    std::vector<double> of_kind;
    for (std::size_t i = 0; i < diameters.size(); ++i)
      if (kind_of[i] == k) of_kind.push_back(diameters[i]);
    require_listed(scene.kinds[k], of_kind, path);
    kinds.push_back({scene.kinds[k].name, scene.kinds[k].density});
  }
  return std::make_shared<const Sizes>(diameters, std::move(kind_of), std::move(kinds));
}

}  // namespace

std::shared_ptr<const Sizes> sizes_for(const std::shared_ptr<const Sizes>& of_file,
                                       const Scene& scene, const std::string& path) {
  if (!scene.kinds.empty()) return with_listed_kinds(of_file.get(), scene, path);
  if (!of_file) {
    for (const Observable& observable : scene.observables) {
      if (const auto fault = equal_spheres_fault(observable))
        throw StartError(path + ": " + *fault);
    }
    return nullptr;
  }
  std::vector<Fault> faults;
  check_mixture(scene, {2 * of_file->smallest_radius(), 2 * of_file->largest_radius()},
                kind_names(*of_file), faults);
  if (faults.empty()) return of_file;
  std::string text = path + " holds spheres of several sizes";
  for (const Fault& fault : faults) text += fmt::format("; {}: {}", fault.pointer, fault.message);
  throw StartError(text);
}

}  // namespace jostle::inline config
