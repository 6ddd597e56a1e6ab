#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "results/content/study.hpp"
#include "results/hdf5/write.hpp"

// The group /spheres: kinds and diameters of the spheres of sweep points with a mixture.
namespace jostle::inline results {

/// Writes kinds, and diameters where all realizations share them. Nothing of equal spheres.
void write_mixtures(hid_t file, const Study& study);

/// Writes the diameters of realizations that draw their own, [n_realizations, n_spheres], one by
/// one.
class DrawnDiameters {
 public:
  DrawnDiameters(hid_t file, std::uint32_t point, std::uint32_t n_realizations,
                 std::uint32_t n_spheres);
  void write(std::uint32_t realization, const std::vector<double>& diameters);
  /// Writes NaN for all realizations that were not written.
  void finish();

 private:
  std::uint32_t n_spheres_;
  std::vector<bool> written_;  // [n_realizations]
  RowsDataset<double> dataset_;
};

/// Reads what write_mixtures() wrote of the point number earlier.size(): null of equal spheres.
/// Throws Hdf5Error where the kinds or the sizes are none.
std::shared_ptr<const PointSpheres> read_mixture(hid_t file, const std::vector<StudyPoint>& earlier,
                                                 std::uint32_t n_spheres);

/// Reads the diameters that a realization drew, [n_spheres]; all NaN where it has not begun or has
/// failed.
std::vector<double> read_drawn_diameters(hid_t file, const StudyPoint& point, RealizationId id,
                                         std::uint32_t n_realizations);

}  // namespace jostle::inline results
