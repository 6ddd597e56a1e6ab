#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>

#include "results/disk/output_path.hpp"
#include "results/disk/publish.hpp"
#include "results/export/extended_xyz.hpp"
#include "results/export/extended_xyz_header.hpp"
#include "results/export/packing_file.hpp"

namespace jostle::inline results {
namespace {

struct Columns {
  std::span<const ParticleColumn> numbers;
  std::span<const VectorColumn> vectors;
};

/// Without it the sizes of a mixture would not read back.
bool lacks_radius(const Packing& packing, const Columns& columns) {
  return packing.sizes && std::ranges::find(columns.numbers, "radius", &ParticleColumn::name) ==
                              columns.numbers.end();
}

std::string kinds(const Packing& packing) {
  if (!packing.sizes) return "";
  std::string names, densities;
  for (const SphereKind& kind : packing.sizes->kinds()) {
    names += (names.empty() ? "" : " ") + kind.name;
    densities += fmt::format("{}{}", densities.empty() ? "" : " ", kind.density);
  }
  return fmt::format(" kinds=\"{}\" densities=\"{}\"", names, densities);
}

std::string comment(const Packing& packing, const Columns& columns) {
  const Vec3 size = extent(packing.container);
  const double height = size.z > 0 ? size.z : surface_height(packing);
  std::string properties = "species:S:1:pos:R:3";
  if (lacks_radius(packing, columns)) properties += ":radius:R:1";
  for (const ParticleColumn& column : columns.numbers) {
    const bool real = std::holds_alternative<std::vector<double>>(column.values);
    properties += fmt::format(":{}:{}:1", column.name, real ? "R" : "I");
  }
  for (const VectorColumn& column : columns.vectors)
    properties += fmt::format(":{}:R:3", column.xyz_name);
  return fmt::format("Lattice=\"{} 0 0 0 {} 0 0 0 {}\" Properties={} pbc=\"{}\" container={}",
                     size.x, size.y, height, properties,
                     periodic_directions(Boundary(packing.container)), name_of(packing.container)) +
         kinds(packing);
}

void append_frame(std::string& text, const Packing& packing, const Columns& columns,
                  std::optional<std::uint64_t> tap) {
  text += fmt::format("{}\n{}", packing.centres.size(), comment(packing, columns));
  text += tap ? fmt::format(" tap={}\n", *tap) : "\n";
  for (std::size_t i = 0; i < packing.centres.size(); ++i) {
    const Vec3 r = packing.centres[i];
    const auto& sizes = packing.sizes;
    fmt::format_to(std::back_inserter(text), "{} {} {} {}",
                   sizes ? sizes->kinds()[sizes->kind(i)].name : "X", r.x, r.y, r.z);
    if (lacks_radius(packing, columns))
      fmt::format_to(std::back_inserter(text), " {}", sizes->radius(i));
    for (const ParticleColumn& column : columns.numbers)
      text.append(1, ' ').append(cell_text(column, i));
    for (const VectorColumn& column : columns.vectors) text += cell_text(column, i);
    text += '\n';
  }
}

}  // namespace

std::string extended_xyz_text(std::span<const ExportedFrame> frames) {
  std::string text;
  for (const ExportedFrame& frame : frames)
    append_frame(text, frame.packing, {frame.columns, frame.vectors}, frame.tap);
  return text;
}

void write_extended_xyz(const std::string& path, const Packing& packing) {
  std::string text;
  append_frame(text, packing, {}, std::nullopt);
  publish(output_path(path), std::as_bytes(std::span(text)));
}

}  // namespace jostle::inline results
