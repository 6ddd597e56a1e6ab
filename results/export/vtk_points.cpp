#include "results/export/vtk_points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <numeric>

namespace jostle::inline results {
namespace {

static_assert(std::endian::native == std::endian::little, "arrays are written as they are");

constexpr const char* file_header =
    "<?xml version=\"1.0\"?>\n"
    "<VTKFile type=\"{}\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n";

std::string base64(const std::string& bytes) {
  constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = i; k < i + 3; ++k)
      group = group << 8 | (k < bytes.size() ? static_cast<unsigned char>(bytes[k]) : 0U);
    for (const int shift : {18, 12, 6, 0}) text += digits[group >> shift & 63U];
  }
  const std::size_t padding = (3 - bytes.size() % 3) % 3;
  std::fill_n(text.end() - static_cast<std::ptrdiff_t>(padding), padding, '=');
  return text;
}

/// The number of bytes, then the numbers.
template <class T>
std::string encoded(const std::vector<T>& values) {
  const std::uint64_t size = values.size() * sizeof(T);
  std::string bytes(sizeof size + size, '\0');
  std::memcpy(bytes.data(), &size, sizeof size);
  if (size > 0) std::memcpy(bytes.data() + sizeof size, values.data(), size);
  return base64(bytes);
}

const char* type_name(double) {
  return "Float64";
}
const char* type_name(std::uint32_t) {
  return "UInt32";
}
const char* type_name(std::int64_t) {
  return "Int64";
}

template <class T>
std::string array(const std::string& name, const std::vector<T>& values, int components = 1) {
  return fmt::format(
      "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"binary\">\n{}\n"
      "</DataArray>\n",
      type_name(T{}), name, components, encoded(values));
}

std::string escaped(const std::string& name) {
  std::string text;
  for (const char c : name) {
    if (c == '&')
      text += "&amp;";
    else if (c == '<')
      text += "&lt;";
    else if (c == '"')
      text += "&quot;";
    else
      text += c;
  }
  return text;
}

}  // namespace

std::string vtk_points_text(const ExportedFrame& frame) {
  const std::size_t n = frame.packing.centres.size();
  std::vector<std::int64_t> connectivity(n), offsets(n);
  std::iota(connectivity.begin(), connectivity.end(), 0);
  std::iota(offsets.begin(), offsets.end(), 1);
  std::string text = fmt::format(file_header, "PolyData");
  text += fmt::format(
      "<PolyData>\n<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" "
      "NumberOfTuples=\"1\" format=\"ascii\">{}</DataArray>\n</FieldData>\n"
      "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"0\" "
      "NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n",
      frame.tap, n, n);
  text += "<PointData>\n";
  for (const ParticleColumn& column : frame.columns)
    text +=
        std::visit([&](const auto& values) { return array(column.name, values); }, column.values);
  for (const VectorColumn& column : frame.vectors)
    text += array(column.name, components_of(column.values), 3);
  text += "</PointData>\n<Points>\n" + array("Points", components_of(frame.packing.centres), 3) +
          "</Points>\n<Verts>\n";
  text += array("connectivity", connectivity) + array("offsets", offsets);
  return text + "</Verts>\n</Piece>\n</PolyData>\n</VTKFile>\n";
}

std::string vtk_collection_text(std::span<const std::pair<std::uint64_t, std::string>> files) {
  std::string text = fmt::format(file_header, "Collection") + "<Collection>\n";
  for (const auto& [tap, name] : files)
    text += fmt::format("<DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", tap, escaped(name));
  return text + "</Collection>\n</VTKFile>\n";
}

}  // namespace jostle::inline results
