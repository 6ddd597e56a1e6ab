#include "results/hdf5/axes.hpp"

#include "results/hdf5/read.hpp"

namespace jostle::inline results {

bool is_axis(hid_t dataset) {
  return checked(H5Aexists(dataset, "CLASS")) > 0 &&
         read_fixed_text_attribute(dataset, "CLASS") == "DIMENSION_SCALE";
}

std::vector<std::vector<haddr_t>> axes_of(hid_t dataset) {
  constexpr const char* name = "DIMENSION_LIST";
  if (is_axis(dataset) || checked(H5Aexists(dataset, name)) == 0) return {};
  const Hdf5Handle attribute(H5Aopen(dataset, name, H5P_DEFAULT), H5Aclose);
  const Hdf5Handle space(H5Aget_space(attribute), H5Sclose);
  const Hdf5Handle type(H5Aget_type(attribute), H5Tclose);
  const Shape shape = shape_of_space(space);
  const Hdf5Handle references(H5Tvlen_create(H5T_STD_REF_OBJ), H5Tclose);
  const std::size_t rank = shape_of(dataset).size();
  if (shape != Shape{rank} || checked(H5Tequal(type, references)) == 0)
    throw Hdf5Error(std::string(name) + " is malformed: not written by jostle");
  std::vector<hvl_t> lists(rank);
  checked(H5Aread(attribute, references, lists.data()));
  std::vector<std::vector<haddr_t>> axes;
  static_assert(sizeof(hobj_ref_t) == sizeof(haddr_t));
  for (const hvl_t& list : lists) {
    const auto* first = static_cast<const hobj_ref_t*>(list.p);
    axes.emplace_back(first, first + list.len);
  }
  H5Dvlen_reclaim(references, space, H5P_DEFAULT, lists.data());
  return axes;
}

}  // namespace jostle::inline results
