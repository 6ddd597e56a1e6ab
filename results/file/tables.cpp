#include "results/file/tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include "results/disk/output_path.hpp"
#include "results/disk/publish.hpp"
#include "results/disk/seal.hpp"
#include "results/disk/temporary_file.hpp"
#include "results/file/contents.hpp"
#include "results/file/intact_file.hpp"
#include "results/file/results_file_impl.hpp"
#include "results/groups/axes.hpp"
#include "results/hdf5/axes.hpp"
#include "results/hdf5/policy.hpp"
#include "results/hdf5/read.hpp"
#include "results/hdf5/writable_file.hpp"
#include "results/hdf5/write.hpp"
#include "results/locks/lock.hpp"

namespace jostle::inline results {
namespace {

constexpr const char* axes_attribute = "jostle_axes";
constexpr const char* quantities_attribute = "jostle_quantities";

std::size_t n_values(const Quantity& quantity) {
  return std::visit([](const auto& values) { return values.size(); }, quantity.values);
}

Shape shape_in(const Table& table, const Quantity& quantity) {
  Shape shape;
  for (const std::string& name : quantity.axes) {
    const auto axis =
        std::ranges::find_if(table.axes, [&](const Quantity& a) { return a.name == name; });
    if (axis == table.axes.end()) throw std::invalid_argument(table.name + " has no axis " + name);
    shape.push_back(n_values(*axis));
  }
  if (n_elements(shape) != n_values(quantity))
    throw std::invalid_argument(fmt::format("{}/{} has {} values for {} places", table.name,
                                            quantity.name, n_values(quantity), n_elements(shape)));
  return shape;
}

struct WriteValues {
  hid_t group;
  const std::string& name;
  const Shape& shape;

  Hdf5Handle operator()(const std::vector<std::string>& texts) const {
    return write_texts(group, name, shape, texts);
  }
  template <class Number>
  Hdf5Handle operator()(const std::vector<Number>& numbers) const {
    return write_numbers<Number>(group, name, shape, numbers,
                                 shape.empty() ? shape : chunk_along_first(shape));
  }
};

Hdf5Handle write_quantity(hid_t group, const Table& table, const Quantity& quantity) {
  const Shape shape = shape_in(table, quantity);
  Hdf5Handle dataset = std::visit(WriteValues{group, quantity.name, shape}, quantity.values);
  write_label(dataset, {quantity.name, quantity.units, quantity.long_name, quantity.source});
  return dataset;
}

std::vector<std::string> names_of(const std::vector<Quantity>& quantities) {
  std::vector<std::string> names;
  for (const Quantity& quantity : quantities) names.push_back(quantity.name);
  return names;
}

/// The group of a path below `parent`, made where it is not there.
Hdf5Handle group_at(hid_t parent, const std::string& path) {
  const auto slash = path.find('/');
  const std::string first = path.substr(0, slash);
  Hdf5Handle group =
      exists(parent, first) ? open_group(parent, first) : create_group(parent, first);
  return slash == std::string::npos ? std::move(group) : group_at(group, path.substr(slash + 1));
}

bool has_results(hid_t parent, const std::string& name) {
  if (!exists(parent, name)) return false;
  const Hdf5Handle table = open_group(parent, name);
  return checked(H5Aexists(table, quantities_attribute)) > 0 &&
         !read_texts_attribute(table, quantities_attribute).empty();
}

void write_table(hid_t parent, const Table& table, const Provenance& provenance) {
  if (exists(parent, table.name)) checked(H5Ldelete(parent, table.name.c_str(), H5P_DEFAULT));
  const Hdf5Handle group = group_at(parent, table.name);
  write_attribute(group, axes_attribute, names_of(table.axes));
  write_attribute(group, quantities_attribute, names_of(table.quantities));
  write_attribute(group, "version", provenance.version);
  write_attribute(group, "git_revision", provenance.git_revision);
  write_attribute(group, "command_line", provenance.command_line);
  write_attribute(group, "made", provenance.started);
  for (const auto& [name, text] : table.notes) write_attribute(group, "note_" + name, text);
  std::map<std::string, Hdf5Handle> axes;
  for (const Quantity& axis : table.axes) {
    Hdf5Handle dataset = write_quantity(group, table, axis);
    make_axis(dataset, axis.name);
    axes.emplace(axis.name, std::move(dataset));
  }
  for (const Quantity& quantity : table.quantities) {
    const Hdf5Handle dataset = write_quantity(group, table, quantity);
    std::vector<const Hdf5Handle*> scales;
    for (const std::string& name : quantity.axes) scales.push_back(&axes.at(name));
    attach_axes(dataset, scales);
  }
}

std::string text_attribute_or_empty(hid_t object, const char* name) {
  return checked(H5Aexists(object, name)) > 0 ? read_text_attribute(object, name) : "";
}

/// How a table was made.
Provenance origin_of(hid_t table) {
  Provenance origin;
  origin.version = text_attribute_or_empty(table, "version");
  origin.git_revision = text_attribute_or_empty(table, "git_revision");
  origin.command_line = text_attribute_or_empty(table, "command_line");
  origin.started = text_attribute_or_empty(table, "made");
  return origin;
}

Quantity read_quantity(hid_t group, const std::string& name, const std::vector<Member>& members) {
  const Hdf5Handle dataset = open_dataset(group, name);
  const Hdf5Handle type(H5Dget_type(dataset), H5Tclose);
  Quantity quantity{.name = name,
                    .units = text_attribute_or_empty(dataset, "units"),
                    .long_name = text_attribute_or_empty(dataset, "long_name"),
                    .source = text_attribute_or_empty(dataset, "source")};
  switch (H5Tget_class(type)) {
    case H5T_STRING:
      quantity.values = read_texts(group, name);
      break;
    case H5T_INTEGER:
      quantity.values = read_numbers<std::uint64_t>(group, name);
      break;
    default:
      quantity.values = read_numbers<double>(group, name);
  }
  if (is_axis(dataset)) {
    quantity.axes = {name};
    return quantity;
  }
  for (const auto& scales : axes_of(dataset)) {
    for (const haddr_t address : scales) {
      const auto axis = std::ranges::find(members, address, &Member::address);
      if (axis == members.end()) throw Hdf5Error(name + " has an axis outside its table");
      quantity.axes.push_back(axis->name);
    }
  }
  return quantity;
}

/// Whoever takes a table relies on as many values as its axes give.
void require_consistent(const Table& table) {
  try {
    for (const Quantity& axis : table.axes) shape_in(table, axis);
    for (const Quantity& quantity : table.quantities) shape_in(table, quantity);
  } catch (const std::invalid_argument& error) {
    throw Hdf5Error(error.what());
  }
}

Table read_table(hid_t group, const std::string& name) {
  Table table{.name = name, .axes = {}, .quantities = {}, .notes = {}};
  const std::vector<Member> members = members_of(group);
  for (const std::string& axis : read_texts_attribute(group, axes_attribute))
    table.axes.push_back(read_quantity(group, axis, members));
  for (const std::string& quantity : read_texts_attribute(group, quantities_attribute))
    table.quantities.push_back(read_quantity(group, quantity, members));
  require_consistent(table);
  std::vector<std::string> notes;
  require_few_attributes(group);
  const auto keep = [](hid_t, const char* attribute, const H5A_info_t*, void* all) -> herr_t {
    if (std::string_view(attribute).starts_with("note_"))
      static_cast<std::vector<std::string>*>(all)->push_back(attribute);
    return 0;
  };
  checked(H5Aiterate2(group, H5_INDEX_NAME, H5_ITER_INC, nullptr, keep, &notes));
  for (const std::string& note : notes)
    table.notes.emplace_back(note.substr(5), read_text_attribute(group, note));
  return table;
}

/// Calls visit(group, path) for every table below a group, in the order of their names.
template <class Visit>
void for_each_table(hid_t group, const std::string& path, Walk& walk, const Visit& visit) {
  if (checked(H5Aexists(group, quantities_attribute)) > 0) return visit(group, path);
  for (const Member& member : members_of(group)) {
    const std::string path_below = path.empty() ? member.name : path + "/" + member.name;
    walk.enter(member, path_below);
    for_each_table(open_group(group, member.name), path_below, walk, visit);
  }
}

/// Names of the derived tables of a file whose group passes the test, in order.
template <class Test>
std::vector<std::string> derived_tables(hid_t file, const Test& passes) {
  std::vector<std::string> names;
  const auto name = [&](hid_t group, const std::string& table) {
    if (passes(group)) names.push_back(table);
  };
  Walk walk;
  for (const std::string group : derived_groups)
    if (exists(file, group)) for_each_table(open_group(file, group), group, walk, name);
  std::ranges::sort(names);
  return names;
}

}  // namespace

std::vector<std::string> store_tables(const std::string& path, const std::string& group,
                                      std::span<const Table> tables, const Provenance& provenance,
                                      const Patience& patience, StoredResults stored,
                                      const std::optional<DataVersion>& made) {
  const TableGroup table_group{group, {tables.begin(), tables.end()}};
  return store_tables(path, std::span(&table_group, 1), provenance, patience, stored, made);
}

std::vector<std::string> store_tables(const std::string& named, std::span<const TableGroup> groups,
                                      const Provenance& provenance, const Patience& patience,
                                      StoredResults stored,
                                      const std::optional<DataVersion>& made) {
  std::vector<std::string> names;
  for (const TableGroup& group : groups) {
    names.push_back(group.name);
    for (const Table& table : group.tables) {
      for (const Quantity& quantity : table.axes) shape_in(table, quantity);
      for (const Quantity& quantity : table.quantities) shape_in(table, quantity);
    }
  }
  const std::string path = output_path(named);
  const RunLock lock(path, false, LockUse::storing, patience);
  remove_stale_temporaries(path);
  TemporaryFile temporary(path);
  copy_intact(path, temporary);
  if (made && ResultsFile(path, Verify::end_of_file).data_version() != *made)
    throw ResultsError(path, "its data have changed since they were read; run the command again");
  std::vector<std::string> left;
  std::size_t n_written = 0;
  naming_file(temporary.name(), [&] {
    WritableHdf5File file(temporary.name(), WritableHdf5File::Begin::as_it_is);
    for (const TableGroup& group : groups) {
      const Hdf5Handle parent = group_at(file, group.name);
      for (const Table& table : group.tables) {
        if (stored == StoredResults::left && !is_made(table)) {
          if (has_results(parent, table.name)) left.push_back(table.name);
          continue;
        }
        write_table(parent, table, provenance);
        ++n_written;
      }
    }
    update_contents(file, names);
    file.close();
  });
  if (n_written == 0 && stored == StoredResults::left) return left;
  seal(temporary.name());
  temporary.publish();
  return left;
}

void copy_tables(const ResultsFile& source, const WritableHdf5File& copy) {
  const Hdf5Handle& file = source.impl_->file();
  Walk walk;
  for (const std::string group : derived_groups) {
    if (!exists(file, group)) continue;
    const Hdf5Handle parent = group_at(copy, group);
    const auto write = [&](hid_t table, const std::string& name) {
      write_table(parent, read_table(table, name), origin_of(table));
    };
    for_each_table(open_group(file, group), "", walk, write);
  }
}

std::vector<Table> ResultsFile::tables(const std::string& group) const {
  return naming_file(path(), [&] {
    std::vector<Table> tables;
    const auto read = [&](hid_t table, const std::string& name) {
      tables.push_back(read_table(table, name));
    };
    if (exists(impl_->file(), group)) {
      Walk walk;
      for_each_table(open_group(impl_->file(), group), "", walk, read);
    }
    return tables;
  });
}

std::vector<std::string> ResultsFile::table_names() const {
  return naming_file(path(),
                     [&] { return derived_tables(impl_->file(), [](hid_t) { return true; }); });
}

std::vector<std::string> ResultsFile::tables_without_results() const {
  return naming_file(path(), [&] {
    return derived_tables(
        impl_->file(), [](hid_t group) { return checked(H5Aexists(group, "note_refused")) > 0; });
  });
}

std::vector<Table> read_tables(const std::string& path, const std::string& group) {
  return ResultsFile(path).tables(group);
}

std::vector<std::string> table_names(const std::string& path) {
  return ResultsFile(path).table_names();
}

}  // namespace jostle::inline results
