#include "results/groups/contact_network.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "engine/bed/boundary.hpp"
#include "results/content/record.hpp"
#include "results/groups/axes.hpp"
#include "results/hdf5/read.hpp"
#include "results/hdf5/write.hpp"

namespace jostle::inline results {
namespace {

/// More touch no sphere, of contacts between spheres of one size and with walls.
constexpr std::uint64_t most_contacts_a_sphere = 16;

/// The datasets along `contact`.
class ContactWriter {
 public:
  ContactWriter(hid_t group, std::uint64_t n)
      : first_(group, "first", {n}, chunk_along_first({n})),
        second_(group, "second", {n}, chunk_along_first({n})),
        overlap_(group, "overlap", {n}, chunk_along_first({n})),
        normal_force_(group, "normal_force", {n}, chunk_along_first({n})),
        normal_(group, "normal", {n, 3}, chunk_along_first({n, 3})),
        tangential_force_(group, "tangential_force", {n, 3}, chunk_along_first({n, 3})) {}

  void write(std::uint64_t first, std::span<const Contact> contacts) {
    write_numbers_of(first_, first, contacts, &Contact::first);
    write_numbers_of(second_, first, contacts, &Contact::second);
    write_numbers_of(overlap_, first, contacts, &Contact::overlap);
    write_numbers_of(normal_force_, first, contacts, &Contact::normal_force);
    write_vectors_of(normal_, first, contacts, &Contact::normal);
    write_vectors_of(tangential_force_, first, contacts, &Contact::tangential_force);
  }

  void label(const Hdf5Handle& contacts, const Hdf5Handle& directions, std::uint32_t n_spheres,
             const Container& container) {
    const auto attach = [&](const Hdf5Handle& dataset, const Column& label, bool is_vector) {
      write_label(dataset, label);
      const Hdf5Handle* const axes[] = {&contacts, &directions};
      attach_axes(dataset, std::span(axes, is_vector ? 2 : 1));
    };
    const std::string source = "jostle";
    attach(first_.dataset(), {"first", "1", "number of the sphere", source}, false);
    attach(
        second_.dataset(),
        {"second", "1", "number of the other sphere, or n_spheres + w: wall w of `walls`", source},
        false);
    write_attribute(second_.dataset(), "n_spheres", n_spheres);
    write_attribute(second_.dataset(), "walls", wall_names(container));
    attach(overlap_.dataset(), {"overlap", "diameter", "overlap", source}, false);
    attach(normal_force_.dataset(),
           {"normal_force", "m g", "normal force; positive where they press on each other", source},
           false);
    attach(normal_.dataset(), {"normal", "1", "unit vector from second to first", source}, true);
    attach(tangential_force_.dataset(),
           {"tangential_force", "m g", "tangential force on first", source}, true);
  }

 private:
  template <class Number>
  static void write_numbers_of(RowsDataset<Number>& dataset, std::uint64_t first,
                               std::span<const Contact> contacts, Number Contact::*field) {
    std::vector<Number> values;
    for (const Contact& contact : contacts) values.push_back(contact.*field);
    dataset.write(first, values);
  }
  static void write_vectors_of(RowsDataset<double>& dataset, std::uint64_t first,
                               std::span<const Contact> contacts, Vec3 Contact::*field) {
    std::vector<double> values;
    for (const Contact& contact : contacts)
      for (const double x : {(contact.*field).x, (contact.*field).y, (contact.*field).z})
        values.push_back(x);
    dataset.write(first, values);
  }

  RowsDataset<std::uint32_t> first_, second_;
  RowsDataset<double> overlap_, normal_force_, normal_, tangential_force_;
};

}  // namespace

void write_contacts(hid_t group, const Container& container, std::uint32_t n_spheres,
                    std::span<const ContactFrame> frames,
                    const std::function<std::vector<Contact>(std::uint64_t tap)>& contacts_at) {
  std::vector<std::uint64_t> taps, offsets;
  std::uint64_t n = 0;
  for (const ContactFrame& frame : frames) {
    taps.push_back(frame.tap);
    offsets.push_back(n);
    n += frame.n_contacts;
  }
  if (n == 0) return;
  const Hdf5Handle contacts = create_group(group, "contacts");
  const Hdf5Handle step = write_numbers(contacts, "step", taps);
  write_label(step, {"step", "1", "number of taps; 0 is the start", ""});
  make_axis(step, "step");
  const Hdf5Handle offset = write_numbers(contacts, "offset", offsets);
  write_label(offset, {"offset", "1", "where the contacts of the step begin along `contact`", ""});
  const Hdf5Handle* const steps[] = {&step};
  attach_axes(offset, steps);
  const Hdf5Handle axis = write_counting_axis(contacts, "contact", n, "number of the contact");
  const Hdf5Handle directions = write_bare_axis(contacts, "direction", 3);
  ContactWriter writer(contacts, n);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const std::vector<Contact> of_frame = contacts_at(taps[k]);
    if (of_frame.size() != frames[k].n_contacts)
      throw Hdf5Error(fmt::format("the contacts of tap {} have changed", taps[k]));
    if (!of_frame.empty()) writer.write(offsets[k], of_frame);
  }
  writer.label(axis, directions, n_spheres, container);
}

ContactNetwork::ContactNetwork(hid_t group, std::uint32_t n_spheres, const Container& container)
    : n_spheres_(n_spheres), n_walls_(static_cast<std::uint32_t>(wall_names(container).size())) {
  if (!exists(group, "contacts")) return;
  const Hdf5Handle contacts = open_group(group, "contacts");
  taps_ = read_numbers<std::uint64_t>(contacts, "step");
  const Shape steps{taps_.size()};
  ends_ = read_numbers<std::uint64_t>(contacts, "offset", &steps);
  const Shape all = shape_of(open_dataset(contacts, "first"));
  if (all.size() != 1) throw Hdf5Error("first does not have the axis contact");
  for (const char* name : {"second", "overlap", "normal_force"}) require_shape(contacts, name, all);
  for (const char* name : {"normal", "tangential_force"})
    require_shape(contacts, name, {all[0], 3});
  // For each frame where it ends: where the next begins.
  ends_.push_back(all[0]);
  if (ends_.front() != 0 || !std::ranges::is_sorted(ends_))
    throw Hdf5Error("offset does not ascend from 0 to the number of contacts");
  ends_.erase(ends_.begin());
  first_ = open_dataset(contacts, "first");
  second_ = open_dataset(contacts, "second");
  overlap_ = open_dataset(contacts, "overlap");
  normal_force_ = open_dataset(contacts, "normal_force");
  normal_ = open_dataset(contacts, "normal");
  tangential_force_ = open_dataset(contacts, "tangential_force");
}

ContactNetwork::Extent ContactNetwork::extent_of(std::uint64_t tap) const {
  const auto found = std::ranges::find(taps_, tap);
  if (found == taps_.end()) return {};
  const auto frame = static_cast<std::size_t>(found - taps_.begin());
  const std::uint64_t first = frame > 0 ? ends_[frame - 1] : 0;
  if (ends_[frame] - first > most_contacts_a_sphere * n_spheres_)
    throw Hdf5Error(fmt::format("the snapshot of tap {} has {} contacts of {} spheres", tap,
                                ends_[frame] - first, n_spheres_));
  return {first, ends_[frame] - first};
}

std::uint64_t ContactNetwork::n_contacts(std::uint64_t tap) const {
  return extent_of(tap).n;
}

std::vector<Contact> ContactNetwork::contacts(std::uint64_t tap) const {
  const auto [first, n] = extent_of(tap);
  std::vector<Contact> contacts(n);
  if (n == 0) return contacts;
  const auto read = [&]<class Number>(const Hdf5Handle& dataset, std::size_t width,
                                      std::vector<Number> values) {
    values.resize(n * width);
    const Shape shape = width == 1 ? Shape{n} : Shape{n, width};
    read_rows(dataset, Hdf5Number<Number>::memory(), shape, first, values.data());
    return values;
  };
  using Numbers = std::vector<std::uint32_t>;
  const Numbers firsts = read(first_, 1, Numbers{}), seconds = read(second_, 1, Numbers{});
  using Values = std::vector<double>;
  const Values overlaps = read(overlap_, 1, Values{}), forces = read(normal_force_, 1, Values{}),
               normals = read(normal_, 3, Values{}),
               tangential = read(tangential_force_, 3, Values{});
  const auto vector = [](const Values& values, std::size_t k) {
    return Vec3{values[3 * k], values[3 * k + 1], values[3 * k + 2]};
  };
  bool sound = true;
  for (std::size_t k = 0; k < n; ++k) {
    Contact& contact = contacts[k];
    contact = {firsts[k], seconds[k],         overlaps[k],
               forces[k], vector(normals, k), vector(tangential, k)};
    const std::uint64_t n_bodies = std::uint64_t{n_spheres_} + n_walls_;
    sound = sound && contact.first < n_spheres_ && contact.first < contact.second &&
            contact.second < n_bodies && is_position({contact.overlap, contact.normal_force, 0}) &&
            is_position(contact.normal) && is_position(contact.tangential_force);
    sound = sound && (k == 0 || std::tuple(contacts[k - 1].first, contacts[k - 1].second) <
                                    std::tuple(contact.first, contact.second));
  }
  if (!sound)
    throw Hdf5Error(fmt::format("the snapshot of tap {} has a contact that is none", tap));
  return contacts;
}

}  // namespace jostle::inline results
