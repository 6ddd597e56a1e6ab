#include "results/groups/mixtures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

#include "engine/numbers.hpp"
#include "results/groups/axes.hpp"
#include "results/groups/layout.hpp"
#include "results/hdf5/read.hpp"

namespace jostle::inline results {
namespace {

std::string group_name(std::uint32_t point) {
  return std::string(spheres_folder) + "/" + point_name(point);
}

constexpr const char* diameters_drawn = "diameters_drawn";
constexpr const char* sphere_axis = "sphere";
constexpr const char* has_spheres_of = "has_spheres_of_point";

const Column& diameter_label() {
  static const Column label{sphere_diameters, "diameter",
                            "diameters of the spheres, in units of length", "jostle"};
  return label;
}

void write_kinds(hid_t group, const std::vector<SphereKind>& kinds) {
  std::vector<std::string> names;
  std::vector<double> densities;
  for (const SphereKind& kind : kinds) {
    names.push_back(kind.name);
    densities.push_back(kind.density);
  }
  const Hdf5Handle axis = write_texts(group, kind_names, {names.size()}, names);
  make_axis(axis, kind_names);
  write_attribute(axis, "long_name", std::string("kinds of spheres"));
  const Hdf5Handle* const axes[] = {&axis};
  const Hdf5Handle density = write_numbers(group, kind_densities, densities);
  write_label(density, {kind_densities, "1", "density relative to a sphere of mass 1", "jostle"});
  attach_axes(density, axes);
}

void write_mixture(hid_t group, const PointSpheres& mixture) {
  write_kinds(group, mixture.kinds);
  const Shape shape{mixture.kind_of.size()};
  const Hdf5Handle spheres = write_bare_axis(group, sphere_axis, shape[0]);
  const Hdf5Handle* const axes[] = {&spheres};
  const Hdf5Handle kind = write_numbers<std::uint32_t>(group, sphere_kinds, shape, mixture.kind_of,
                                                       chunk_along_first(shape));
  write_label(kind, {sphere_kinds, "1", "number of the kind of every sphere, an index of `name`",
                     "jostle"});
  attach_axes(kind, axes);
  if (mixture.drawn()) return;
  const Hdf5Handle diameter = write_numbers<double>(group, sphere_diameters, shape,
                                                    mixture.diameters, chunk_along_first(shape));
  write_label(diameter, diameter_label());
  attach_axes(diameter, axes);
}

void require(bool sound, std::uint32_t point, const std::string& requirement) {
  if (!sound)
    throw Hdf5Error("/" + group_name(point) + " " + requirement + ": not written by jostle");
}

/// Limits the spheres of all points together, so that a small file does not fill the memory.
void require_few(const std::vector<StudyPoint>& earlier, std::uint32_t n_spheres) {
  std::uint64_t spheres = n_spheres;
  for (std::size_t p = 0; p < earlier.size(); ++p) {
    const auto& mixture = earlier[p].mixture;
    const bool shared = p > 0 && mixture == earlier[p - 1].mixture;
    if (mixture && !shared) spheres += mixture->kind_of.size();
  }
  if (spheres > most_mixed_spheres_in_all)
    throw Hdf5Error("the sweep points have more spheres of mixtures than jostle writes");
}

}  // namespace

void write_mixtures(hid_t file, const Study& study) {
  Hdf5Handle folder;
  for (std::uint32_t p = 0; p < study.points.size(); ++p) {
    const auto& mixture = study.points[p].mixture;
    if (!mixture) continue;
    if (!exists(file, spheres_folder)) folder = create_group(file, spheres_folder);
    const Hdf5Handle group = create_group(file, group_name(p));
    write_attribute<std::uint8_t>(group, diameters_drawn, mixture->drawn() ? 1 : 0);
    std::uint32_t as = 0;
    while (study.points[as].mixture != mixture) ++as;
    if (as < p)
      write_attribute(group, has_spheres_of, as);
    else
      write_mixture(group, *mixture);
  }
}

DrawnDiameters::DrawnDiameters(hid_t file, std::uint32_t point, std::uint32_t n_realizations,
                               std::uint32_t n_spheres)
    : n_spheres_(n_spheres),
      written_(n_realizations, false),
      dataset_(Hdf5Handle(open_group(file, group_name(point))), sphere_diameters,
               {n_realizations, n_spheres}, {1, n_spheres}) {
  write_label(dataset_.dataset(), diameter_label());
  const Hdf5Handle group = open_group(file, group_name(point));
  const Hdf5Handle realizations = write_realization_axis(group, n_realizations);
  const Hdf5Handle spheres = exists(group, sphere_axis)
                                 ? open_dataset(group, sphere_axis)
                                 : write_bare_axis(group, sphere_axis, n_spheres);
  const Hdf5Handle* const axes[] = {&realizations, &spheres};
  attach_axes(dataset_.dataset(), axes);
}

void DrawnDiameters::write(std::uint32_t realization, const std::vector<double>& diameters) {
  if (diameters.size() != n_spheres_)
    throw Hdf5Error(fmt::format("{} diameters of {} spheres", diameters.size(), n_spheres_));
  dataset_.write(realization, diameters);
  written_[realization] = true;
}

void DrawnDiameters::finish() {
  const std::vector<double> none(n_spheres_, not_a_number);
  for (std::uint32_t r = 0; r < written_.size(); ++r) {
    if (!written_[r]) dataset_.write(r, none);
  }
}

std::shared_ptr<const PointSpheres> read_mixture(hid_t file, const std::vector<StudyPoint>& earlier,
                                                 std::uint32_t n_spheres) {
  const auto number = static_cast<std::uint32_t>(earlier.size());
  if (!exists(file, group_name(number))) return nullptr;
  const Hdf5Handle group = open_group(file, group_name(number));
  if (checked(H5Aexists(group, has_spheres_of)) > 0) {
    const auto as = read_number_attribute<std::uint32_t>(group, has_spheres_of);
    require(as < number && earlier[as].mixture && earlier[as].n_spheres == n_spheres, number,
            "has the spheres of a point that has none such");
    return earlier[as].mixture;
  }
  require_few(earlier, n_spheres);
  PointSpheres mixture;
  const auto names = read_texts(group, kind_names);
  require(!names.empty() && names.size() <= n_spheres, number, "has no kinds of spheres");
  const Shape of_kinds{names.size()}, of_spheres{n_spheres};
  const auto densities = read_numbers<double>(group, kind_densities, &of_kinds);
  for (std::size_t k = 0; k < names.size(); ++k) mixture.kinds.push_back({names[k], densities[k]});
  mixture.kind_of = read_numbers<std::uint32_t>(group, sphere_kinds, &of_spheres);
  const bool drawn = read_number_attribute<std::uint8_t>(group, diameters_drawn) != 0;
  if (!drawn) mixture.diameters = read_numbers<double>(group, sphere_diameters, &of_spheres);
  // Drawn diameters are read later: any will do to look at the kinds.
  const std::vector<double> any(n_spheres, 2 * sphere_radius);
  const auto fault = sizes_fault(drawn ? any : mixture.diameters, mixture.kind_of, mixture.kinds);
  require(!fault, number, "has spheres that are none: " + fault.value_or(""));
  return std::make_shared<const PointSpheres>(std::move(mixture));
}

std::vector<double> read_drawn_diameters(hid_t file, const StudyPoint& point, RealizationId id,
                                         std::uint32_t n_realizations) {
  const Hdf5Handle group = open_group(file, group_name(id.point));
  require_shape(group, sphere_diameters, {n_realizations, point.n_spheres});
  return read_block(group, sphere_diameters, {id.realization, 0}, {1, point.n_spheres});
}

}  // namespace jostle::inline results
