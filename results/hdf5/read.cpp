#include "results/hdf5/read.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "results/hdf5/policy.hpp"

namespace jostle::inline results {
namespace {

constexpr std::size_t most_texts_of_an_attribute = 1000;

/// Texts of any length come as pointers that HDF5 owns until they are reclaimed. `space`: of what
/// is read at once.
template <class Read>
void collect_texts(hid_t space, std::size_t n, std::vector<std::string>& texts, Read&& read) {
  const Hdf5Handle type = text_type();
  std::vector<char*> pointers(n, nullptr);
  checked(read(type, pointers.data()));
  for (const char* text : pointers) texts.emplace_back(text ? text : "");
  H5Dvlen_reclaim(type, space, H5P_DEFAULT, pointers.data());
}

hsize_t size_of_file(hid_t object) {
  const Hdf5Handle file(H5Iget_file_id(object), H5Fclose);
  hsize_t bytes = 0;
  checked(H5Fget_filesize(file, &bytes));
  return bytes;
}

/// Selects up to `most` values from the one with number `first` on, whole rows where they fit, else
/// a piece of a row of a table; how many they are.
hsize_t select_from(hid_t space, const Shape& shape, std::size_t first, hsize_t most) {
  if (shape.empty()) return 1;
  const hsize_t row = n_elements(shape) / shape[0];
  Shape offset(shape.size(), 0), count = shape;
  offset[0] = first / row;
  if (first % row == 0 && row <= most) {
    count[0] = std::min(most / row, shape[0] - offset[0]);
  } else if (shape.size() == 2) {
    offset[1] = first % row;
    count = {1, std::min(most, row - offset[1])};
  } else {
    throw Hdf5Error("texts in more than two dimensions: not written by jostle");
  }
  checked(
      H5Sselect_hyperslab(space, H5S_SELECT_SET, offset.data(), nullptr, count.data(), nullptr));
  return n_elements(count);
}

std::string only(const std::string& name, const std::vector<std::string>& texts) {
  if (texts.size() != 1) throw Hdf5Error(name + " is not one text");
  return texts.front();
}

}  // namespace

Hdf5Handle open_to_read(const std::string& path) {
  const Hdf5Handle access = file_access();
  // Files that are read are never written in place; without flock, HDF5 would not open them.
  checked(H5Pset_file_locking(access, false, true));
  return {H5Fopen(path.c_str(), H5F_ACC_RDONLY, access), H5Fclose};
}

Hdf5Handle open_group(hid_t parent, const std::string& name) {
  if (!exists(parent, name)) throw Hdf5Error("there is no group " + name);
  return {H5Gopen2(parent, name.c_str(), H5P_DEFAULT), H5Gclose};
}

Hdf5Handle open_dataset(hid_t parent, const std::string& name) {
  if (!exists(parent, name)) throw Hdf5Error("there is no dataset " + name);
  Hdf5Handle dataset(H5Dopen2(parent, name.c_str(), H5P_DEFAULT), H5Dclose);
  require_plain_dataset(dataset, name);
  return dataset;
}

bool exists(hid_t parent, const std::string& path) {
  for (std::size_t end = 0; end != std::string::npos;) {
    end = path.find('/', end + 1);
    const std::string ancestor = path.substr(0, end);
    if (checked(H5Lexists(parent, ancestor.c_str(), H5P_DEFAULT)) == 0) return false;
    require_hard_link(parent, ancestor);
  }
  return true;
}

Shape shape_of(hid_t dataset) {
  return shape_of_space(Hdf5Handle(H5Dget_space(dataset), H5Sclose));
}

Shape shape_of_space(hid_t space) {
  if (H5Sget_simple_extent_type(space) == H5S_NULL) return {0};
  Shape shape(static_cast<std::size_t>(checked(H5Sget_simple_extent_ndims(space))));
  if (!shape.empty()) checked(H5Sget_simple_extent_dims(space, shape.data(), nullptr));
  require_plausible_shape(shape);
  return shape;
}

void require_shape(hid_t parent, const std::string& name, const Shape& shape) {
  const auto text = [](const Shape& extents_of) {
    std::string extents;
    for (const hsize_t extent : extents_of)
      extents.append(extents.empty() ? "" : ", ").append(std::to_string(extent));
    return extents;
  };
  const Shape found = shape_of(open_dataset(parent, name));
  if (found != shape)
    throw Hdf5Error(fmt::format("{} has the shape [{}], not [{}]", name, text(found), text(shape)));
}

void read_rows(hid_t dataset, hid_t memory_type, const Shape& shape, hsize_t first, void* values) {
  const Hdf5Handle space(H5Dget_space(dataset), H5Sclose);
  const Hdf5Handle memory(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
                          H5Sclose);
  Shape offset(shape.size(), 0);
  offset[0] = first;
  checked(
      H5Sselect_hyperslab(space, H5S_SELECT_SET, offset.data(), nullptr, shape.data(), nullptr));
  checked(H5Dread(dataset, memory_type, memory, space, transfer_properties(), values));
}

std::vector<double> read_block(hid_t parent, const std::string& name, const Shape& offset,
                               const Shape& shape) {
  const Hdf5Handle dataset = open_dataset(parent, name);
  std::vector<double> values(n_elements(shape));
  if (values.empty()) return values;
  const Hdf5Handle space(H5Dget_space(dataset), H5Sclose);
  checked(
      H5Sselect_hyperslab(space, H5S_SELECT_SET, offset.data(), nullptr, shape.data(), nullptr));
  const Hdf5Handle memory(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
                          H5Sclose);
  checked(
      H5Dread(dataset, Hdf5Number<double>::memory(), memory, space, H5P_DEFAULT, values.data()));
  return values;
}

std::vector<std::string> read_texts(hid_t parent, const std::string& name) {
  return texts_of_dataset(open_dataset(parent, name), name);
}

std::vector<std::string> texts_of_dataset(hid_t dataset, const std::string& name) {
  const Hdf5Handle space(H5Dget_space(dataset), H5Sclose);
  const Shape shape = shape_of_space(space);
  const std::size_t n = n_elements(shape);
  if (n == 0) return {};
  // Each text is stored separately. Repeated references to one text can expand it: the number read
  // at once is limited by memory, and counted.
  constexpr hsize_t most_bytes_at_once = 256u << 20, fewest_at_once = 16;
  const hsize_t bytes_there = size_of_file(dataset);
  const hsize_t at_once = std::max(fewest_at_once, most_bytes_at_once / bytes_there);
  hsize_t bytes = 0;
  std::vector<std::string> texts;
  while (texts.size() < n) {
    const hsize_t count = select_from(space, shape, texts.size(), at_once);
    const Hdf5Handle memory(H5Screate_simple(1, &count, nullptr), H5Sclose);
    collect_texts(memory, count, texts, [&](hid_t type, char** pointers) {
      return H5Dread(dataset, type, memory, space, transfer_properties(), pointers);
    });
    for (auto text = texts.end() - static_cast<std::ptrdiff_t>(count); text != texts.end(); ++text)
      bytes += text->size();
    if (bytes > bytes_there)
      throw Hdf5Error(name + " has longer texts than the file has room for: not written by jostle");
  }
  return texts;
}

std::string read_text(hid_t parent, const std::string& name) {
  return only(name, read_texts(parent, name));
}

std::vector<std::string> read_texts_attribute(hid_t object, const std::string& name) {
  return texts_of_attribute(Hdf5Handle(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose), name);
}

std::vector<std::string> texts_of_attribute(hid_t attribute, const std::string& name) {
  const Hdf5Handle space(H5Aget_space(attribute), H5Sclose);
  const std::size_t n = n_elements(shape_of_space(space));
  if (n > most_texts_of_an_attribute) throw Hdf5Error("attribute " + name + " has too many texts");
  std::vector<std::string> texts;
  if (n > 0) {
    collect_texts(space, n, texts,
                  [&](hid_t type, char** pointers) { return H5Aread(attribute, type, pointers); });
  }
  return texts;
}

void require_alike(hid_t type, hid_t expected, const std::string& name) {
  const H5T_class_t kind = H5Tget_class(expected);
  const bool signs_agree = kind != H5T_INTEGER || H5Tget_sign(type) == H5Tget_sign(expected);
  if (H5Tget_class(type) != kind || !signs_agree || H5Tget_size(type) != H5Tget_size(expected))
    throw Hdf5Error(name + " is a number of another kind: not written by jostle");
}

std::string read_fixed_text_attribute(hid_t object, const std::string& name) {
  const Hdf5Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose);
  const Hdf5Handle space(H5Aget_space(attribute), H5Sclose);
  const Hdf5Handle type(H5Aget_type(attribute), H5Tclose);
  constexpr std::size_t longest = 1024;
  const bool fixed = H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0;
  if (!fixed || H5Tget_size(type) > longest || n_elements(shape_of_space(space)) != 1)
    throw Hdf5Error("attribute " + name + " is not one short text");
  std::string text(H5Tget_size(type), '\0');
  checked(H5Aread(attribute, type, text.data()));
  return text.substr(0, text.find('\0'));
}

std::string read_text_attribute(hid_t object, const std::string& name) {
  return only(name, read_texts_attribute(object, name));
}

}  // namespace jostle::inline results
