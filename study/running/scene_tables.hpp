#pragma once

#include <string>
#include <vector>

#include "results/file/results_file.hpp"
#include "study/tables/fits.hpp"

namespace jostle::inline study {

/// Receives the tables of a scene as they are made, without omitted ones.
class TablesObserver {
 public:
  virtual ~TablesObserver() = default;
  virtual void fitted(const FittedCurve&) {}
  virtual void analysed(const Table&) {}  // tables of analyses and of structure
  virtual void without_structure(const std::string& /*reason*/) {}
};

/// Makes the fits, analyses and structure that the scene of a complete results file asks for, and
/// how its targets are met, and stores them in one replacement of the file: nothing where it asks
/// for nothing, or is not one that this version reads. If one cannot be made, because memory or
/// disk is exhausted, earlier ones are stored first. Returns the names of the tables with their
/// groups, "fits/...". Throws ResultsError; LockHeld where another process works on the file for
/// longer than `patience` lasts.
std::vector<std::string> store_scene_tables(const ResultsFile& file, int threads,
                                            TablesObserver& observer,
                                            const Patience& patience = {});

}  // namespace jostle::inline study
