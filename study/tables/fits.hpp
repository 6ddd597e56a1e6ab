#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "cli/terminal/fit_output.hpp"
#include "ensemble/analysis/table.hpp"
#include "fitting/models/models.hpp"
#include "study/tables/fit_source.hpp"

namespace jostle {

/// How curves are fitted and how the errors of resampled realizations are made.
struct FitManner {
  std::map<std::string, double> fixed = {};  // parameters that keep a value
  bool resampled = false;
  ResamplingOptions resampling = {};
};

/// A model of docs/fitting.md, or for "all" every law of an approach to a final value. Empty where
/// there is none of that name.
std::vector<std::unique_ptr<Model>> models_named(const std::string& name);

std::vector<FitOutcome> fit_models(const std::vector<std::unique_ptr<Model>>& models,
                                   const FitSource& source, const FitManner& manner);

/// The report of a curve and its fits, for people.
std::string fits_text(const FitSource& source, const std::vector<FitOutcome>& outcomes,
                      ReportDetail detail = ReportDetail::brief);

/// One table a fit, point_PPPP/<observable>/<model>, as results files keep them. `resampling` says
/// how resampled errors were made.
std::vector<Table> fit_tables(const FitSource& source, const std::vector<FitOutcome>& outcomes,
                              const FitManner& manner);

/// Makes, prints (unless quiet) and stores the fits that the scene of a complete results file asks
/// for. Throws ResultsError.
void make_scene_fits(const std::string& results, int threads, bool quiet);

}  // namespace jostle
