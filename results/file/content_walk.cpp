#include "results/file/content_walk.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>

#include "results/hdf5/axes.hpp"
#include "results/hdf5/policy.hpp"
#include "results/hdf5/read.hpp"

namespace jostle::inline results {
namespace {

using Names = std::vector<std::string>;

class ContentWalk {
 public:
  ContentWalk(const std::function<bool(const std::string&)>& is_left_out, ContentSink& sink)
      : is_left_out_(is_left_out), sink_(sink) {}

  void add_file(hid_t file) {
    add_attributes(file, "/");
    add_members(file, "");
  }

 private:
  void add_members(hid_t group, const std::string& path);
  using Paths = std::unordered_map<haddr_t, std::string>;  // Paths of a group's members, by address

  void add_object(hid_t parent, const Member& member, const std::string& path, const Paths& paths);
  void add_dataset(hid_t dataset, const std::string& path);
  void add_attributes(hid_t object, const std::string& path);
  void add_attribute(hid_t object, const std::string& name, const std::string& path);
  void add_axes(hid_t dataset, const std::string& path, const Paths& paths);
  template <class Read, class Texts>
  void add_values(const std::string& item_name, hid_t type, hid_t space, Read&& read,
                  Texts&& texts);
  template <class Number, class Read>
  void add_numbers(hid_t memory_type, const Shape& shape, Read&& read);
  void add_texts(std::span<const std::string> texts);

  const std::function<bool(const std::string&)>& is_left_out_;
  ContentSink& sink_;
  Walk walk_;
};

/// Rows of a dataset, from `first` of its first dimension on; without a shape all of it.
struct Piece {
  hsize_t first = 0;
  Shape shape = {};
};

/// Whole chunks of results files (chunk_along_first), and no more than a few of them.
hsize_t rows_a_piece(const Shape& shape) {
  constexpr hsize_t numbers_per_chunk = 65536, chunks_a_piece = 32;
  const hsize_t a_row = std::max<hsize_t>(n_elements(shape) / std::max<hsize_t>(shape[0], 1), 1);
  const hsize_t a_chunk = std::max<hsize_t>(numbers_per_chunk / a_row, 1);
  return std::max<hsize_t>(numbers_per_chunk * chunks_a_piece / a_row / a_chunk, 1) * a_chunk;
}

Names attribute_names(hid_t object) {
  Names names;
  require_few_attributes(object);
  const auto keep = [](hid_t, const char* name, const H5A_info_t*, void* all) -> herr_t {
    static_cast<Names*>(all)->push_back(name);
    return 0;
  };
  checked(H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, keep, &names));
  std::sort(names.begin(), names.end());
  return names;
}

std::string shape_text(hid_t space) {
  std::string text;
  for (const hsize_t extent : shape_of_space(space)) text += fmt::format(" {}", extent);
  return text;
}

void ContentWalk::add_members(hid_t group, const std::string& path) {
  const std::vector<Member> members = members_of(group);
  Paths paths;
  for (const Member& member : members) paths[member.address] = path + "/" + member.name;
  Names names;
  for (const Member& member : members) names.push_back(member.name);
  sink_.names(path.empty() ? "/" : path, "members", names);
  for (const Member& member : members) {
    const std::string member_path = path + "/" + member.name;
    if (!is_left_out_(member_path)) add_object(group, member, member_path, paths);
  }
}

void ContentWalk::add_object(hid_t parent, const Member& member, const std::string& path,
                             const Paths& paths) {
  const Hdf5Handle object(H5Oopen(parent, member.name.c_str(), H5P_DEFAULT), H5Oclose);
  switch (H5Iget_type(object)) {
    case H5I_GROUP:
      walk_.enter(member, path);
      sink_.begin(path, "");
      sink_.add(path + " group\n");
      add_attributes(object, path);
      return add_members(object, path);
    case H5I_DATASET:
      require_plain_dataset(object, path);
      add_dataset(object, path);
      add_attributes(object, path);
      return add_axes(object, path, paths);
    default:
      throw Hdf5Error(path + " is neither a group nor a dataset: not written by jostle");
  }
}

void ContentWalk::add_dataset(hid_t dataset, const std::string& path) {
  const Hdf5Handle type(H5Dget_type(dataset), H5Tclose);
  const Hdf5Handle space(H5Dget_space(dataset), H5Sclose);
  const auto read = [&](hid_t memory_type, void* values, const Piece& piece) {
    if (piece.shape.empty())
      return H5Dread(dataset, memory_type, H5S_ALL, H5S_ALL, transfer_properties(), values);
    read_rows(dataset, memory_type, piece.shape, piece.first, values);
    return herr_t{0};
  };
  sink_.begin(path, "");
  add_values(path + " dataset", type, space, read, [&] { return texts_of_dataset(dataset, path); });
}

void ContentWalk::add_attributes(hid_t object, const std::string& path) {
  Names names = attribute_names(object);
  // References to the address of a dataset in the file; add_axes names them instead.
  std::erase_if(names, [](const std::string& name) {
    return name == "DIMENSION_LIST" || name == "REFERENCE_LIST";
  });
  sink_.names(path, "attributes", names);
  for (const std::string& name : names) add_attribute(object, name, path);
}

void ContentWalk::add_attribute(hid_t object, const std::string& name, const std::string& path) {
  const Hdf5Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose);
  const Hdf5Handle type(H5Aget_type(attribute), H5Tclose);
  const Hdf5Handle space(H5Aget_space(attribute), H5Sclose);
  sink_.begin(path, name);
  add_values(
      path + " attribute " + name, type, space,
      [&](hid_t memory_type, void* values, const Piece& piece) {
        if (!piece.shape.empty())
          throw Hdf5Error("an attribute of millions of numbers: not written by jostle");
        return H5Aread(attribute, memory_type, values);
      },
      [&] { return texts_of_attribute(attribute, name); });
}

/// Axes are in the group of their datasets, and a reference to one is its address there:
/// to ask HDF5 for its name would search the whole file.
void ContentWalk::add_axes(hid_t dataset, const std::string& path, const Paths& paths) {
  const auto axes = axes_of(dataset);
  for (std::size_t dimension = 0; dimension < axes.size(); ++dimension) {
    for (const haddr_t address : axes[dimension]) {
      const auto axis = paths.find(address);
      if (axis == paths.end())
        throw Hdf5Error(path + " has an axis in another group: not written by jostle");
      sink_.begin(path, "");
      sink_.add(path + " axis " + std::to_string(dimension) + " " + axis->second + "\n");
    }
  }
}

template <class Read, class Texts>
void ContentWalk::add_values(const std::string& item_name, hid_t type, hid_t space, Read&& read,
                             Texts&& texts) {
  const Shape shape = shape_of_space(space);
  const std::size_t n = n_elements(shape);
  const std::size_t size = H5Tget_size(type);
  const bool is_signed = H5Tget_class(type) == H5T_INTEGER && H5Tget_sign(type) == H5T_SGN_2;
  switch (H5Tget_class(type)) {
    case H5T_FLOAT:
      sink_.add(item_name + " float" + std::to_string(8 * size) + shape_text(space) + "\n");
      return add_numbers<double>(H5T_NATIVE_DOUBLE, shape, read);
    case H5T_INTEGER:
      sink_.add(item_name + (is_signed ? " int" : " uint") + std::to_string(8 * size) +
                shape_text(space) + "\n");
      return add_numbers<std::uint64_t>(is_signed ? H5T_NATIVE_INT64 : H5T_NATIVE_UINT64, shape,
                                        read);
    case H5T_STRING:
      sink_.add(item_name + " text" + shape_text(space) + "\n");
      if (H5Tis_variable_str(type) > 0) return add_texts(texts());
      {
        std::vector<std::byte> raw(n * size);
        checked(read(type, raw.data(), Piece{}));
        return sink_.add(std::span<const std::byte>(raw));
      }
    default:
      throw Hdf5Error(item_name + " is neither a number nor text: not written by jostle");
  }
}

template <class Number, class Read>
void ContentWalk::add_numbers(hid_t memory_type, const Shape& shape, Read&& read) {
  std::vector<Number> values;
  const auto add = [&](const Shape& part, const Piece& piece) {
    values.resize(n_elements(part));
    if (!values.empty()) checked(read(memory_type, values.data(), piece));
    if constexpr (std::is_floating_point_v<Number>)
      for (Number& value : values)
        if (std::isnan(value)) value = std::numeric_limits<Number>::quiet_NaN();
    sink_.add(std::as_bytes(std::span(values)));
  };
  const hsize_t n_rows = shape.empty() ? 1 : shape[0];
  const hsize_t a_piece = shape.empty() ? 1 : rows_a_piece(shape);
  if (n_rows <= a_piece) return add(shape, {});
  for (hsize_t first = 0; first < n_rows; first += a_piece) {
    Shape part = shape;
    part[0] = std::min(a_piece, n_rows - first);
    add(part, {first, part});
  }
}

void ContentWalk::add_texts(std::span<const std::string> texts) {
  for (const std::string& text : texts) {
    sink_.add(std::to_string(text.size()) + ":");
    sink_.add(text);
  }
}

}  // namespace

void walk_contents(hid_t file, const std::function<bool(const std::string&)>& is_left_out,
                   ContentSink& sink) {
  ContentWalk(is_left_out, sink).add_file(file);
}

}  // namespace jostle::inline results
