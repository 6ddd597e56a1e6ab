#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "results/hdf5/handle.hpp"

// Groups, datasets and attributes as this project writes them: no object times, text as UTF-8 of
// any length, numbers little-endian, shuffle + deflate where a dataset is chunked.
namespace jostle::inline results {

using Shape = std::vector<hsize_t>;
std::size_t n_elements(const Shape& shape);

/// The file type (little-endian) and the memory type of a C++ number.
template <class Number>
struct Hdf5Number;
template <>
struct Hdf5Number<double> {
  static hid_t file() { return H5T_IEEE_F64LE; }
  static hid_t memory() { return H5T_NATIVE_DOUBLE; }
};
template <>
struct Hdf5Number<std::uint64_t> {
  static hid_t file() { return H5T_STD_U64LE; }
  static hid_t memory() { return H5T_NATIVE_UINT64; }
};
template <>
struct Hdf5Number<std::uint32_t> {
  static hid_t file() { return H5T_STD_U32LE; }
  static hid_t memory() { return H5T_NATIVE_UINT32; }
};
template <>
struct Hdf5Number<std::uint8_t> {
  static hid_t file() { return H5T_STD_U8LE; }
  static hid_t memory() { return H5T_NATIVE_UINT8; }
};

/// Text of any length, UTF-8.
Hdf5Handle text_type();
/// With a small buffer for conversions: HDF5's own is two times a megabyte, cleared at every use.
Hdf5Handle transfer_properties();

Hdf5Handle create_group(hid_t parent, const std::string& name);

/// Writes a dataset; chunks of shape `chunk` are compressed, an empty `chunk` or a small dataset is
/// contiguous.
Hdf5Handle write_raw(hid_t parent, const std::string& name, hid_t file_type, hid_t memory_type,
                     const Shape& shape, const void* values, const Shape& chunk);

/// Like write(), without values.
Hdf5Handle create_dataset(hid_t parent, const std::string& name, hid_t file_type,
                          const Shape& shape, const Shape& chunk);
/// Writes values from index `first` of the first dimension on, over the whole of the others.
void write_rows(hid_t dataset, hid_t memory_type, Shape shape, hsize_t first, const void* values);

template <class Number>
Hdf5Handle write_numbers(hid_t parent, const std::string& name, const Shape& shape,
                         std::span<const Number> values, const Shape& chunk = {}) {
  return write_raw(parent, name, Hdf5Number<Number>::file(), Hdf5Number<Number>::memory(), shape,
                   values.data(), chunk);
}
template <class Number>
Hdf5Handle write_numbers(hid_t parent, const std::string& name, const std::vector<Number>& values) {
  return write_numbers<Number>(parent, name, {values.size()}, values);
}

/// A dataset of numbers that is written some rows at a time: it can be larger than memory.
template <class Number>
class RowsDataset {
 public:
  RowsDataset(hid_t parent, const std::string& name, Shape shape, const Shape& chunk)
      : shape_(std::move(shape)),
        dataset_(create_dataset(parent, name, Hdf5Number<Number>::file(), shape_, chunk)) {}

  /// Writes the rows from `first` on; `rows` is [n, the other extents].
  void write(hsize_t first, std::span<const Number> rows) {
    Shape shape = shape_;
    shape[0] = rows.size() / (n_elements(shape_) / shape_[0]);
    write_rows(dataset_, Hdf5Number<Number>::memory(), shape, first, rows.data());
  }
  const Hdf5Handle& dataset() const { return dataset_; }
  Hdf5Handle take() { return std::move(dataset_); }

 private:
  Shape shape_;
  Hdf5Handle dataset_;
};

/// A dataset of texts with the given shape ({} is one text).
Hdf5Handle write_texts(hid_t parent, const std::string& name, const Shape& shape,
                       std::span<const std::string> texts);

void write_attribute(hid_t object, const std::string& name, const std::string& text);
void write_attribute(hid_t object, const std::string& name, std::span<const std::string> texts);
template <class Number>
void write_attribute(hid_t object, const std::string& name, std::span<const Number> numbers,
                     bool scalar = false) {
  const hsize_t n = numbers.size();
  const Hdf5Handle space(scalar ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &n, nullptr),
                         H5Sclose);
  const Hdf5Handle attribute(
      H5Acreate2(object, name.c_str(), Hdf5Number<Number>::file(), space, H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose);
  checked(H5Awrite(attribute, Hdf5Number<Number>::memory(), numbers.data()));
}
template <class Number>
requires std::is_arithmetic_v<Number>
void write_attribute(hid_t object, const std::string& name, Number number) {
  write_attribute<Number>(object, name, std::span<const Number>(&number, 1), true);
}

/// Makes a one-dimensional dataset an axis, under its own name.
void make_axis(hid_t dataset, const std::string& name);
/// An axis without values, as netCDF-4 writes its plain dimensions; takes no room in the file.
Hdf5Handle write_bare_axis(hid_t parent, const std::string& name, hsize_t size);
/// Names the dimensions of a dataset, in order.
void attach_axes(hid_t dataset, std::span<const Hdf5Handle* const> axes);

}  // namespace jostle::inline results
