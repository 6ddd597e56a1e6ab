#include "hdf5_mutations.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <vector>

#include "results/disk/seal.hpp"
#include "results/export/export.hpp"
#include "results/export/packing_file.hpp"
#include "results/file/tables.hpp"
#include "results/hdf5/writable_file.hpp"
#include "results/run/live_run.hpp"
#include "results/run/merge.hpp"
#include "results/run/run_store.hpp"
#include "synthetic.hpp"

namespace jostle::synthetic {
namespace {

using Paths = std::vector<std::string>;

Paths all_objects(hid_t file) {
  Paths paths;
  const auto keep = [](hid_t, const char* name, const H5O_info_t*, void* all) -> herr_t {
    if (std::string(name) != ".") static_cast<Paths*>(all)->push_back(name);
    return 0;
  };
  H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, keep, &paths, H5O_INFO_BASIC);
  return paths;
}

/// A place in a file to change something.
struct Place {
  hid_t file;
  Paths objects;
  std::string path;  // path of one file
  Choices& choices;

  std::string folder() const {
    const auto slash = path.rfind('/');
    return slash == std::string::npos ? "/" : path.substr(0, slash);
  }
  const std::string& another() const { return objects[choices.integer_below(objects.size())]; }
  void remove() const { H5Ldelete(file, path.c_str(), H5P_DEFAULT); }
};

template <class Number>
Number extreme(Choices& choices) {
  using Limits = std::numeric_limits<Number>;
  const Number numbers[] = {
      Number{0},           Number{1},
      Limits::max(),       Limits::lowest(),
      Limits::min(),       Limits::infinity(),
      Limits::quiet_NaN(), static_cast<Number>(choices.integer_below(1 << 20))};
  return numbers[choices.integer_below(std::size(numbers))];
}

constexpr std::size_t most_values = 4096;

/// TargetPrecision values of a type for a dataset or an attribute of at most most_values elements.
struct Values {
  hid_t memory_type;
  std::vector<std::uint64_t> bits = std::vector<std::uint64_t>(most_values);
};

Values extreme_values(Choices& choices) {
  if (choices.integer_below(2) == 0) {
    Values values{H5T_NATIVE_DOUBLE};
    for (auto& bits : values.bits) bits = std::bit_cast<std::uint64_t>(extreme<double>(choices));
    return values;
  }
  Values values{H5T_NATIVE_UINT64};
  for (auto& bits : values.bits) bits = extreme<std::uint64_t>(choices);
  return values;
}

std::string odd_text(Choices& choices) {
  switch (choices.integer_below(8)) {
    case 0:
      return "";
    case 1:
      return std::string(100'000, '[');
    case 2:
      return std::string(100'000, 'x');
    case 3:
      return "\x1b]0;title\x07\x1b[2J\xff\xfe";
    case 4:
      return "{\"name\": 1e400, \"sweep\": null}";
    case 5:
      return "../../etc/passwd";
    case 6:
      return "complete";
    default:
      return fmt::format("{}", choices.integer_below(100));
  }
}

void create_dataset(const Place& place, hid_t type, const std::vector<hsize_t>& shape,
                    bool chunked = false) {
  place.remove();
  const hid_t space = shape.empty()
                          ? H5Screate(H5S_SCALAR)
                          : H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
  const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
  if (chunked && !shape.empty()) {
    std::vector<hsize_t> chunk(shape.size(), 1);
    H5Pset_chunk(properties, static_cast<int>(chunk.size()), chunk.data());
  }
  const hid_t dataset =
      H5Dcreate2(place.file, place.path.c_str(), type, space, H5P_DEFAULT, properties, H5P_DEFAULT);
  hsize_t n = 1;
  for (const hsize_t extent : shape) n = extent > most_values ? most_values + 1 : n * extent;
  if (n <= most_values && H5Tget_class(type) != H5T_STRING && dataset >= 0) {
    const Values values = extreme_values(place.choices);
    H5Dwrite(dataset, values.memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.bits.data());
  }
  H5Dclose(dataset);
  H5Pclose(properties);
  H5Sclose(space);
}

std::vector<hsize_t> odd_shape(Choices& choices) {
  const std::vector<hsize_t> shapes[] = {{},        {0},       {1},          {3},    {2, 3},
                                         {7, 3},    {3, 7},    {7},          {6, 3}, {0, 3},
                                         {3, 5, 3}, {3, 4, 3}, {1, 1, 1, 1}, {4000}};
  return shapes[choices.integer_below(std::size(shapes))];
}

void rewrite_values(const Place& place) {
  const hid_t dataset = H5Dopen2(place.file, place.path.c_str(), H5P_DEFAULT);
  if (dataset < 0) return;
  const hid_t space = H5Dget_space(dataset);
  if (H5Sget_simple_extent_npoints(space) <= static_cast<hssize_t>(most_values)) {
    const Values values = extreme_values(place.choices);
    H5Dwrite(dataset, values.memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.bits.data());
  }
  H5Sclose(space);
  H5Dclose(dataset);
}

void rewrite_text(const Place& place) {
  const hid_t dataset = H5Dopen2(place.file, place.path.c_str(), H5P_DEFAULT);
  if (dataset < 0) return;
  const hid_t type = H5Dget_type(dataset), space = H5Dget_space(dataset);
  const auto n = H5Sget_simple_extent_npoints(space);
  if (H5Tis_variable_str(type) > 0 && n > 0 && n < 100) {
    const std::string text = odd_text(place.choices);
    const std::vector<const char*> texts(static_cast<std::size_t>(n), text.c_str());
    H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, texts.data());
  }
  H5Sclose(space);
  H5Tclose(type);
  H5Dclose(dataset);
}

/// Calls change(object, name of an attribute).
void change_attribute(const Place& place, const std::function<void(hid_t, const char*)>& change) {
  const hid_t object = H5Oopen(place.file, place.path.c_str(), H5P_DEFAULT);
  if (object < 0) return;
  H5O_info_t info{};
  H5Oget_info2(object, &info, H5O_INFO_NUM_ATTRS);
  if (info.num_attrs > 0) {
    char name[256] = {};
    H5Aget_name_by_idx(object, ".", H5_INDEX_NAME, H5_ITER_INC,
                       place.choices.integer_below(info.num_attrs), name, sizeof name - 1,
                       H5P_DEFAULT);
    change(object, name);
  }
  H5Oclose(object);
}

void write_odd_attribute(const Place& place, hid_t object, const char* name) {
  H5Adelete(object, name);
  const auto shape = odd_shape(place.choices);
  const hid_t space = shape.empty()
                          ? H5Screate(H5S_SCALAR)
                          : H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
  const hid_t types[] = {H5T_NATIVE_DOUBLE, H5T_NATIVE_UINT64, H5T_NATIVE_INT8, H5T_STD_REF_OBJ};
  const hid_t type = types[place.choices.integer_below(std::size(types))];
  const hid_t attribute = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
  const Values values = extreme_values(place.choices);
  if (attribute >= 0) H5Awrite(attribute, type, values.bits.data());
  H5Aclose(attribute);
  H5Sclose(space);
}

void rewrite_attribute(const Place& place) {
  change_attribute(place, [&](hid_t object, const char* name) {
    const hid_t attribute = H5Aopen(object, name, H5P_DEFAULT);
    const hid_t type = H5Aget_type(attribute), space = H5Aget_space(attribute);
    const auto n = H5Sget_simple_extent_npoints(space);
    if (H5Tis_variable_str(type) > 0 && n < 100) {
      const std::string text = odd_text(place.choices);
      const std::vector<const char*> texts(static_cast<std::size_t>(n), text.c_str());
      H5Awrite(attribute, type, texts.data());
    } else if (n <= static_cast<hssize_t>(most_values) && H5Tget_class(type) != H5T_VLEN &&
               H5Tget_class(type) != H5T_COMPOUND) {
      const Values values = extreme_values(place.choices);
      H5Awrite(attribute, values.memory_type, values.bits.data());
    }
    H5Sclose(space);
    H5Tclose(type);
    H5Aclose(attribute);
  });
}

struct Forgery {
  const char* name;
  void (*make)(const Place&);
};

constexpr Forgery forgeries[] = {
    {"an object is missing", [](const Place& place) { place.remove(); }},
    {"a soft link",
     [](const Place& place) {
       const std::string target = "/" + place.another();
       place.remove();
       H5Lcreate_soft(target.c_str(), place.file, place.path.c_str(), H5P_DEFAULT, H5P_DEFAULT);
     }},
    {"an external link",
     [](const Place& place) {
       const char* files[] = {"/dev/zero", "other.h5", "/proc/self/mem", "/dev/stdin"};
       place.remove();
       H5Lcreate_external(files[place.choices.integer_below(4)], ("/" + place.path).c_str(),
                          place.file, place.path.c_str(), H5P_DEFAULT, H5P_DEFAULT);
     }},
    {"a second hard link, perhaps in a circle",
     [](const Place& place) {
       const std::string target = place.choices.integer_below(2) == 0 ? "/" : place.another();
       const std::string name =
           place.choices.integer_below(2) == 0 ? place.folder() + "/again" : place.path;
       if (name == place.path) place.remove();
       H5Lcreate_hard(place.file, target.c_str(), place.file, name.c_str(), H5P_DEFAULT,
                      H5P_DEFAULT);
     }},
    {"a dataset of another shape",
     [](const Place& place) {
       create_dataset(place, H5T_IEEE_F64LE, odd_shape(place.choices),
                      place.choices.integer_below(2) == 0);
     }},
    {"a dataset of another type",
     [](const Place& place) {
       const hid_t text = H5Tcopy(H5T_C_S1);
       H5Tset_size(text, place.choices.integer_below(2) == 0 ? 3 : H5T_VARIABLE);
       const hid_t types[] = {text, H5T_STD_I8BE, H5T_STD_REF_OBJ, H5T_STD_U64LE, H5T_IEEE_F32BE};
       create_dataset(place, types[place.choices.integer_below(5)], odd_shape(place.choices));
       H5Tclose(text);
     }},
    {"more values than bytes",
     [](const Place& place) {
       const std::vector<hsize_t> shapes[] = {
           {hsize_t{1} << 40}, {hsize_t{1} << 62, 3}, {1u << 20, 1u << 20}, {20'000'000}};
       create_dataset(place, H5T_IEEE_F64LE, shapes[place.choices.integer_below(4)], true);
     }},
    {"other values", rewrite_values},
    {"another text", rewrite_text},
    {"an attribute is missing",
     [](const Place& place) {
       change_attribute(place, [](hid_t object, const char* name) { H5Adelete(object, name); });
     }},
    {"an attribute of another kind",
     [](const Place& place) {
       change_attribute(place, [&](hid_t object, const char* name) {
         write_odd_attribute(place, object, name);
       });
     }},
    {"another value of an attribute", rewrite_attribute},
    {"deep groups",
     [](const Place& place) {
       std::string path = place.folder() + "/deep";
       for (int depth = 0; depth < 200; ++depth) {
         H5Gclose(H5Gcreate2(place.file, path.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
         path += "/d";
       }
     }},
    {"two objects change places",
     [](const Place& place) {
       const std::string second_path = place.another();
       H5Lmove(place.file, place.path.c_str(), place.file, "between", H5P_DEFAULT, H5P_DEFAULT);
       H5Lmove(place.file, second_path.c_str(), place.file, place.path.c_str(), H5P_DEFAULT,
               H5P_DEFAULT);
       H5Lmove(place.file, "between", place.file, second_path.c_str(), H5P_DEFAULT, H5P_DEFAULT);
     }},
};
static_assert(std::size(forgeries) == n_forgeries);

void go_on_with(const std::string& path) {
  const Study all = study();
  const auto store = RunStore::resume(path, all, {}, provenance());
  for (const RealizationId id : store->pending(true)) run(*store, all, id);
  store->finish();
}

void read_all(const std::string& path) {
  const ResultsFile file(path);
  for (const RealizationSummary& realization : file.realizations()) file.record(realization.id);
  for (std::uint32_t point = 0; point < file.study().points.size(); ++point) {
    file.series(point);
    file.ensemble(point);
    for (const Column& label : file.columns(point)) file.block(point, label.name, {0, 1}, {0, 1});
  }
}

void store_table(const std::string& path) {
  const Table table{.name = "t/u", .axes = {}, .quantities = {}, .notes = {{"a", "b"}}};
  store_tables(path, "fits", std::span(&table, 1), provenance());
}

const std::function<void(const std::string&)> uses[] = {
    read_all,
    [](const std::string& path) { digest_of(path); },
    [](const std::string& path) { run_status(path); },
    [](const std::string& path) { table_names(path); },
    [](const std::string& path) { read_tables(path, "analysis"); },
    [](const std::string& path) { read_packing(path, {.point = 1, .realization = 2}); },
    [](const std::string& path) {
      kept_frames(ResultsFile(path), {0, 0}, {.all = true});
    },
    [](const std::string& path) { live_results(path); },
    [](const std::string& path) {
      merge_files(std::span(&path, 1), path + ".merged", provenance(), true);
    },
    store_table,
    go_on_with,
};

}  // namespace

std::size_t Choices::integer_below(std::size_t n) {
  std::size_t number = 0;
  for (int i = 0; i < 3 && !bytes_.empty(); ++i) {
    number = number << 8 | bytes_.front();
    bytes_ = bytes_.subspan(1);
  }
  return n == 0 ? 0 : number % n;
}

const char* forgery_name(std::size_t kind) {
  return forgeries[kind].name;
}

void forge(const std::string& path, std::size_t kind, Choices& choices) {
  WritableHdf5File file(path, WritableHdf5File::Begin::as_it_is);
  Paths objects = all_objects(file);
  if (!objects.empty()) {
    std::string object = objects[choices.integer_below(objects.size())];
    forgeries[kind].make({file, std::move(objects), std::move(object), choices});
  }
  H5Eclear2(H5E_DEFAULT);
  file.close();
  seal(path);
}

int use_in_every_way(const std::string& path) {
  int refused = 0;
  for (const auto& use : uses) {
    try {
      use(path);
    } catch (const ResultsError&) {
      ++refused;
    } catch (const std::invalid_argument&) {  // a choice that the file does not have
      ++refused;
    }
  }
  return refused;
}

int n_uses() {
  return static_cast<int>(std::size(uses));
}

}  // namespace jostle::synthetic
