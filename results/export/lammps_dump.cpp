#include "results/export/lammps_dump.hpp"

#include <fmt/format.h>

#include <iterator>

#include "engine/bed/boundary.hpp"

namespace jostle::inline results {
namespace {

std::string header(const ExportedFrame& frame) {
  const Vec3 size = extent(frame.packing.container);
  const double height = size.z > 0 ? size.z : surface_height(frame.packing);
  const Boundary boundary(frame.packing.container);
  const auto ends = [](bool periodic) { return periodic ? "pp" : "ff"; };
  std::string columns;
  for (const ParticleColumn& column : frame.columns) columns.append(1, ' ').append(column.name);
  for (const VectorColumn& column : frame.vectors)
    for (const char* name : column.components) columns.append(1, ' ').append(name);
  return fmt::format(
      "ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS {} {} {}\n0 {}\n0 {}\n0 {}\n"
      "ITEM: ATOMS id type x y z{}\n",
      frame.tap, frame.packing.centres.size(), ends(boundary.periodic_x), ends(boundary.periodic_y),
      ends(boundary.periodic_z), size.x, size.y, height, columns);
}

}  // namespace

std::string lammps_dump_text(std::span<const ExportedFrame> frames) {
  std::string text;
  for (const ExportedFrame& frame : frames) {
    text += header(frame);
    for (std::size_t i = 0; i < frame.packing.centres.size(); ++i) {
      const Vec3 r = frame.packing.centres[i];
      const auto& sizes = frame.packing.sizes;
      fmt::format_to(std::back_inserter(text), "{} {} {} {} {}", i + 1,
                     sizes ? sizes->kind(i) + 1 : 1, r.x, r.y, r.z);
      for (const ParticleColumn& column : frame.columns)
        text.append(1, ' ').append(cell_text(column, i));
      for (const VectorColumn& column : frame.vectors) text += cell_text(column, i);
      text += '\n';
    }
  }
  return text;
}

}  // namespace jostle::inline results
