#include "results/hdf5/write.hpp"

#include <fmt/format.h>
#include <hdf5_hl.h>

namespace jostle::inline results {
namespace {

Hdf5Handle space_of(const Shape& shape) {
  if (shape.empty()) return {H5Screate(H5S_SCALAR), H5Sclose};
  return {H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose};
}

std::vector<const char*> pointers(std::span<const std::string> texts) {
  std::vector<const char*> all;
  for (const std::string& text : texts) all.push_back(text.c_str());
  return all;
}

Hdf5Handle dataset_properties(const Shape& chunk) {
  constexpr unsigned deflate_level = 4;
  Hdf5Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  checked(H5Pset_obj_track_times(properties, false));
  if (chunk.empty()) return properties;
  checked(H5Pset_chunk(properties, static_cast<int>(chunk.size()), chunk.data()));
  checked(H5Pset_shuffle(properties));
  checked(H5Pset_deflate(properties, deflate_level));
  return properties;
}

void write_text_attribute(hid_t object, const std::string& name, const Shape& shape,
                          std::span<const std::string> texts) {
  const Hdf5Handle type = text_type(), space = space_of(shape);
  const Hdf5Handle attribute(
      H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (!texts.empty()) checked(H5Awrite(attribute, type, pointers(texts).data()));
}

}  // namespace

std::size_t n_elements(const Shape& shape) {
  std::size_t n = 1;
  for (const hsize_t extent : shape) n *= extent;
  return n;
}

Hdf5Handle text_type() {
  Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  checked(H5Tset_size(type, H5T_VARIABLE));
  checked(H5Tset_cset(type, H5T_CSET_UTF8));
  return type;
}

Hdf5Handle transfer_properties() {
  constexpr std::size_t conversion_buffer = 1 << 14;
  Hdf5Handle properties(H5Pcreate(H5P_DATASET_XFER), H5Pclose);
  checked(H5Pset_buffer(properties, conversion_buffer, nullptr, nullptr));
  return properties;
}

Hdf5Handle create_group(hid_t parent, const std::string& name) {
  const Hdf5Handle properties(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
  checked(H5Pset_obj_track_times(properties, false));
  return {H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, properties, H5P_DEFAULT), H5Gclose};
}

Hdf5Handle create_dataset(hid_t parent, const std::string& name, hid_t file_type,
                          const Shape& shape, const Shape& chunk) {
  // The index of a chunked dataset takes more room than so few numbers.
  constexpr std::size_t smallest_chunked = 512;
  const bool small = n_elements(shape) <= smallest_chunked;
  const Hdf5Handle space = space_of(shape),
                   properties = dataset_properties(small ? Shape{} : chunk);
  return {H5Dcreate2(parent, name.c_str(), file_type, space, H5P_DEFAULT, properties, H5P_DEFAULT),
          H5Dclose};
}

void write_rows(hid_t dataset, hid_t memory_type, Shape shape, hsize_t first, const void* values) {
  const Hdf5Handle file_space(H5Dget_space(dataset), H5Sclose), memory_space = space_of(shape);
  Shape offset(shape.size(), 0);
  offset[0] = first;
  checked(H5Sselect_hyperslab(file_space, H5S_SELECT_SET, offset.data(), nullptr, shape.data(),
                              nullptr));
  checked(H5Dwrite(dataset, memory_type, memory_space, file_space, transfer_properties(), values));
}

Hdf5Handle write_raw(hid_t parent, const std::string& name, hid_t file_type, hid_t memory_type,
                     const Shape& shape, const void* values, const Shape& chunk) {
  Hdf5Handle dataset = create_dataset(parent, name, file_type, shape, chunk);
  if (n_elements(shape) > 0)
    checked(H5Dwrite(dataset, memory_type, H5S_ALL, H5S_ALL, transfer_properties(), values));
  return dataset;
}

Hdf5Handle write_texts(hid_t parent, const std::string& name, const Shape& shape,
                       std::span<const std::string> texts) {
  const Hdf5Handle type = text_type();
  return write_raw(parent, name, type, type, shape, pointers(texts).data(), {});
}

void write_attribute(hid_t object, const std::string& name, const std::string& text) {
  write_text_attribute(object, name, {}, {&text, 1});
}

void write_attribute(hid_t object, const std::string& name, std::span<const std::string> texts) {
  write_text_attribute(object, name, {texts.size()}, texts);
}

void make_axis(hid_t dataset, const std::string& name) {
  checked(H5DSset_scale(dataset, name.c_str()));
}

Hdf5Handle write_bare_axis(hid_t parent, const std::string& name, hsize_t size) {
  const Hdf5Handle space = space_of({size}), properties = dataset_properties({});
  Hdf5Handle dataset(
      H5Dcreate2(parent, name.c_str(), H5T_IEEE_F32BE, space, H5P_DEFAULT, properties, H5P_DEFAULT),
      H5Dclose);
  make_axis(dataset,
            fmt::format("This is a netCDF dimension but not a netCDF variable.{:10}", size));
  return dataset;
}

void attach_axes(hid_t dataset, std::span<const Hdf5Handle* const> axes) {
  for (unsigned dimension = 0; dimension < axes.size(); ++dimension)
    checked(H5DSattach_scale(dataset, *axes[dimension], dimension));
}

}  // namespace jostle::inline results
