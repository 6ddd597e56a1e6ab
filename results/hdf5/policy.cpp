#include "results/hdf5/policy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace jostle::inline results {
namespace {

constexpr std::size_t most_dimensions = 8;
constexpr hsize_t most_elements = hsize_t{1} << 44;
constexpr hsize_t most_attributes = 1000;
constexpr std::ptrdiff_t deepest_group = 32;

/// Fewer elements than these need no bytes behind them: axes without values, of spheres.
constexpr hsize_t most_empty_elements = 10'000'000;
/// Deflate packs 1032 bytes into one at best. https://zlib.net/zlib_tech.html
constexpr hsize_t best_compression = 1032;

void require_known_filters(hid_t properties, const std::string& name) {
  const int n = checked(H5Pget_nfilters(properties));
  for (int i = 0; i < n; ++i) {
    unsigned flags = 0, settings = 0;
    std::size_t n_settings = 0;
    const H5Z_filter_t filter = H5Pget_filter2(properties, static_cast<unsigned>(i), &flags,
                                               &n_settings, nullptr, 0, nullptr, &settings);
    if (filter != H5Z_FILTER_SHUFFLE && filter != H5Z_FILTER_DEFLATE)
      throw Hdf5Error(name + " is packed with a filter that jostle does not use");
  }
}

void require_chunks_within(hid_t properties, const Shape& shape, const std::string& name) {
  std::array<hsize_t, H5S_MAX_RANK> chunk{};
  const int rank = checked(H5Pget_chunk(properties, H5S_MAX_RANK, chunk.data()));
  bool is_inside = static_cast<std::size_t>(rank) == shape.size();
  for (std::size_t i = 0; is_inside && i < shape.size(); ++i)
    is_inside = chunk[i] <= std::max<hsize_t>(shape[i], 1);
  if (!is_inside) throw Hdf5Error(name + " has chunks larger than itself: not written by jostle");
}

}  // namespace

void require_hard_link(hid_t parent, const std::string& name) {
  H5L_info_t info;
  checked(H5Lget_info(parent, name.c_str(), &info, H5P_DEFAULT));
  if (info.type != H5L_TYPE_HARD)
    throw Hdf5Error(name + " is a link to another place: not written by jostle");
}

void require_plausible_shape(const Shape& shape) {
  bool plausible = shape.size() <= most_dimensions;
  hsize_t n = 1;
  for (const hsize_t extent : shape) {
    plausible = plausible && (extent == 0 || n <= most_elements / extent);
    n = plausible ? n * extent : 0;
  }
  if (!plausible) throw Hdf5Error("a dataset claims more values than a disk holds");
}

void require_plain_dataset(hid_t dataset, const std::string& name) {
  const Hdf5Handle properties(H5Dget_create_plist(dataset), H5Pclose);
  const Hdf5Handle space(H5Dget_space(dataset), H5Sclose);
  const Hdf5Handle type(H5Dget_type(dataset), H5Tclose);
  Shape shape(static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space))));
  if (!shape.empty()) checked(H5Sget_simple_extent_dims(space, shape.data(), nullptr));
  require_plausible_shape(shape);
  const H5D_layout_t layout = H5Pget_layout(properties);
  const bool inside = layout == H5D_COMPACT || layout == H5D_CONTIGUOUS || layout == H5D_CHUNKED;
  if (!inside || H5Pget_external_count(properties) != 0)
    throw Hdf5Error(name + " keeps its values in another file: not written by jostle");
  require_known_filters(properties, name);
  if (layout == H5D_CHUNKED) require_chunks_within(properties, shape, name);
  const hsize_t n = n_elements(shape), stored = H5Dget_storage_size(dataset);
  if (n > most_empty_elements && n > stored * best_compression / H5Tget_size(type))
    throw Hdf5Error(
        fmt::format("{} claims {} values, for which {} bytes are too few", name, n, stored));
}

void require_few_attributes(hid_t object) {
  H5O_info_t info;
  checked(H5Oget_info2(object, &info, H5O_INFO_NUM_ATTRS));
  if (info.num_attrs > most_attributes)
    throw Hdf5Error(
        fmt::format("{} attributes on one object: not written by jostle", info.num_attrs));
}

std::vector<Member> members_of(hid_t group) {
  std::vector<Member> members;
  // No exception may pass through HDF5.
  const auto keep = [](hid_t, const char* name, const H5L_info_t* info, void* all) -> herr_t {
    try {
      const haddr_t address = info->type == H5L_TYPE_HARD ? info->u.address : HADDR_UNDEF;
      static_cast<std::vector<Member>*>(all)->push_back({name, address});
      return 0;
    } catch (const std::exception&) {
      return -1;
    }
  };
  checked(H5Literate(group, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, keep, &members));
  std::ranges::sort(members, {}, &Member::name);
  for (const Member& member : members)
    if (member.address == HADDR_UNDEF)
      throw Hdf5Error(member.name + " is a link to another place: not written by jostle");
  return members;
}

void Walk::enter(const Member& member, const std::string& path) {
  if (!entered_.insert(member.address).second)
    throw Hdf5Error(path + " is a group that has another name: not written by jostle");
  if (std::ranges::count(path, '/') > deepest_group)
    throw Hdf5Error(fmt::format("groups lie deeper than {}: not written by jostle", deepest_group));
}

}  // namespace jostle::inline results
