#pragma once

#include <string>
#include <vector>

#include "results/hdf5/handle.hpp"
#include "results/hdf5/write.hpp"

// Reading back what hdf5_write.hpp writes. All throw Hdf5Error, also where a thing is not there,
// and for what hdf5_write.hpp never writes (hdf5_policy.hpp).
namespace jostle::inline results {

/// Opens a file that is not written to, and keeps little of it in memory.
Hdf5Handle open_to_read(const std::string& path);

Hdf5Handle open_group(hid_t parent, const std::string& name);
Hdf5Handle open_dataset(hid_t parent, const std::string& name);
/// True if the path exists, intermediate groups included.
bool exists(hid_t parent, const std::string& path);

Shape shape_of(hid_t dataset);
Shape shape_of_space(hid_t space);

/// Throws unless the dataset `name` of a group has that shape.
void require_shape(hid_t parent, const std::string& name, const Shape& shape);

/// For any shape, or of the given one.
template <class Number>
std::vector<Number> read_numbers(hid_t parent, const std::string& name,
                                 const Shape* expected = nullptr) {
  if (expected != nullptr) require_shape(parent, name, *expected);
  const Hdf5Handle dataset = open_dataset(parent, name);
  std::vector<Number> values(n_elements(shape_of(dataset)));
  checked(
      H5Dread(dataset, Hdf5Number<Number>::memory(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
  return values;
}

/// The part of a dataset of numbers that begins at `offset` and has `shape`.
/// Reads `shape` values from index `first` of the first dimension on, over the whole of the others.
void read_rows(hid_t dataset, hid_t memory_type, const Shape& shape, hsize_t first, void* values);

std::vector<double> read_block(hid_t parent, const std::string& name, const Shape& offset,
                               const Shape& shape);

/// Texts of any length, those of a table row by row. Throws Hdf5Error where they would take more
/// memory than the file has bytes.
std::vector<std::string> read_texts(hid_t parent, const std::string& name);
std::vector<std::string> texts_of_dataset(hid_t dataset, const std::string& name);
std::string read_text(hid_t parent, const std::string& name);

std::vector<std::string> read_texts_attribute(hid_t object, const std::string& name);
std::vector<std::string> texts_of_attribute(hid_t attribute, const std::string& name);
std::string read_text_attribute(hid_t object, const std::string& name);
/// For a length that its type fixes, as HDF5's own attributes have.
std::string read_fixed_text_attribute(hid_t object, const std::string& name);
/// Throws Hdf5Error for another kind of number, or one with a sign where there is none: HDF5 would
/// convert it in silence, -1 to 0.
void require_alike(hid_t type, hid_t expected, const std::string& name);
template <class Number>
std::vector<Number> read_numbers_attribute(hid_t object, const std::string& name) {
  const Hdf5Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose);
  const Hdf5Handle space(H5Aget_space(attribute), H5Sclose);
  std::vector<Number> numbers(n_elements(shape_of_space(space)));
  require_alike(Hdf5Handle(H5Aget_type(attribute), H5Tclose), Hdf5Number<Number>::file(), name);
  checked(H5Aread(attribute, Hdf5Number<Number>::memory(), numbers.data()));
  return numbers;
}
template <class Number>
Number read_number_attribute(hid_t object, const std::string& name) {
  const auto numbers = read_numbers_attribute<Number>(object, name);
  if (numbers.size() != 1) throw Hdf5Error("attribute " + name + " is not one number");
  return numbers.front();
}

}  // namespace jostle::inline results
