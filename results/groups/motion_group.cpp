#include "results/groups/motion_group.hpp"

#include <iterator>
#include <string>
#include <vector>

#include "results/groups/axes.hpp"
#include "results/hdf5/read.hpp"
#include "results/hdf5/write.hpp"

namespace jostle::inline results {
namespace {

constexpr hsize_t n_directions = 3;

/// Along origins and lags, its places, realizations.
Shape shape_of_quantity(const MotionQuantity& quantity, const MotionRecords& records) {
  const MotionSettings& settings = records.settings;
  Shape shape{settings.origins.size(), settings.lags.size()};
  switch (quantity.places) {
    case MotionPlaces::none:
      break;
    case MotionPlaces::directions:
      shape.push_back(n_directions);
      break;
    case MotionPlaces::overlap_lengths:
      shape.push_back(settings.overlap_lengths.size());
      break;
    case MotionPlaces::layers:
      shape.push_back(settings.layers);
      break;
    case MotionPlaces::layer_directions:
      shape.insert(shape.end(), {settings.layers, n_directions});
      break;
    case MotionPlaces::layer_overlap_lengths:
      shape.insert(shape.end(), {settings.layers, settings.overlap_lengths.size()});
      break;
    case MotionPlaces::kind_directions:
      shape.insert(shape.end(), {settings.kinds, n_directions});
      break;
  }
  shape.push_back(records.n_realizations);
  return shape;
}

/// False of kinds where spheres are equal: an empty list of lengths still has its dataset.
bool is_followed(const MotionQuantity& quantity, const MotionSettings& settings) {
  return quantity.places != MotionPlaces::kind_directions || settings.kinds > 0;
}

Shape shape_of_heights(const MotionRecords& records) {
  return {records.settings.origins.size(), records.settings.layers, records.n_realizations};
}

template <class Number>
Hdf5Handle write_axis(hid_t group, const Column& label, const std::vector<Number>& values) {
  Hdf5Handle axis = write_numbers(group, label.name, values);
  write_label(axis, label);
  make_axis(axis, label.name);
  return axis;
}

class MotionWriter {
 public:
  MotionWriter(hid_t group, const MotionRecords& records, std::span<const std::string> kinds)
      : group_(group),
        records_(records),
        origins_(write_axis(group,
                            {"waiting_time", "1", "tap that displacements are counted from", ""},
                            records.settings.origins)),
        lags_(
            write_axis(group, {"lag", "1", "taps after waiting_time", ""}, records.settings.lags)),
        lengths_(write_axis(group, {"overlap_length", "diameter", "largest displacement a", ""},
                            records.settings.overlap_lengths)),
        layers_(
            write_counting_axis(group, "layer", records.settings.layers,
                                "spheres in equal numbers by height at waiting_time, 0 lowest")),
        realizations_(write_realization_axis(group, records.n_realizations)) {
    const std::string names[n_directions] = {"x", "y", "z"};
    directions_ = write_texts(group, "direction", {n_directions}, names);
    make_axis(directions_, "direction");
    if (records.settings.kinds == 0) return;
    kinds_ = write_texts(group, "kind", {kinds.size()}, kinds);
    make_axis(kinds_, "kind");
  }

  void write(const MotionQuantity& quantity, const std::vector<double>& values) {
    std::vector<const Hdf5Handle*> axes{&origins_, &lags_};
    switch (quantity.places) {
      case MotionPlaces::none:
        break;
      case MotionPlaces::directions:
        axes.push_back(&directions_);
        break;
      case MotionPlaces::overlap_lengths:
        axes.push_back(&lengths_);
        break;
      case MotionPlaces::layers:
        axes.push_back(&layers_);
        break;
      case MotionPlaces::layer_directions:
        axes.insert(axes.end(), {&layers_, &directions_});
        break;
      case MotionPlaces::layer_overlap_lengths:
        axes.insert(axes.end(), {&layers_, &lengths_});
        break;
      case MotionPlaces::kind_directions:
        axes.insert(axes.end(), {&kinds_, &directions_});
        break;
    }
    axes.push_back(&realizations_);
    write({quantity.name, quantity.units, quantity.long_name, quantity.source},
          shape_of_quantity(quantity, records_), values, axes);
  }

  void write_layer_heights() {
    write({"layer_height", "diameter", "mean height of the layer at waiting_time", ""},
          shape_of_heights(records_), records_.layer_height, {&origins_, &layers_, &realizations_});
  }

  void write_largest_steps() {
    write(
        {"largest_step", "1",
         "largest step of a sphere in one tap along a periodic direction, in periods; steps of 1/2 "
         "and more cannot be detected",
         ""},
        {records_.n_realizations}, records_.largest_step, {&realizations_});
  }

 private:
  void write(const Column& label, const Shape& shape, const std::vector<double>& values,
             const std::vector<const Hdf5Handle*>& axes) {
    const Hdf5Handle dataset =
        write_numbers<double>(group_, label.name, shape, values, chunk_along_first(shape));
    write_label(dataset, label);
    attach_axes(dataset, axes);
  }

  hid_t group_;
  const MotionRecords& records_;
  Hdf5Handle origins_, lags_, lengths_, layers_, realizations_, directions_, kinds_;
};

}  // namespace

void write_motion_records(hid_t group, const MotionRecords& records,
                          std::span<const std::string> kinds) {
  MotionWriter writer(group, records, kinds);
  for (std::size_t q = 0; q < records.values.size(); ++q) {
    if (is_followed(motion_quantities[q], records.settings))
      writer.write(motion_quantities[q], records.values[q]);
  }
  writer.write_layer_heights();
  writer.write_largest_steps();
}

void read_motion_records(hid_t group, MotionRecords& records) {
  for (std::size_t q = 0; q < records.values.size(); ++q) {
    if (!is_followed(motion_quantities[q], records.settings)) continue;
    const Shape shape = shape_of_quantity(motion_quantities[q], records);
    records.values[q] = read_numbers<double>(group, motion_quantities[q].name, &shape);
  }
  const Shape heights = shape_of_heights(records), extent{records.n_realizations};
  records.layer_height = read_numbers<double>(group, "layer_height", &heights);
  records.largest_step = read_numbers<double>(group, "largest_step", &extent);
}

}  // namespace jostle::inline results
