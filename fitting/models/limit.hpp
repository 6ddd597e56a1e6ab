#pragma once

#include <functional>
#include <memory>
#include <string>

#include "fitting/models/model.hpp"

namespace jostle::inline fitting {

/// The law of fewer parameters that a law becomes where some of its own go to 0 or infinity
/// together: the boundary of its curves (Transtrum & Qiu 2014, doi:10.1103/PhysRevLett.113.098701).
/// A parameter of the same name is the same parameter.
struct Limit {
  std::shared_ptr<const Model> law;
  std::string approach;  // "B and tau grow together without limit"
  /// Returns parameters of the first law for a curve of `law`, nearer to it the larger `distance`
  /// (above 1) is, over times from `first` > 0 to `last`. Null where none can be named.
  std::function<ParameterValues(const ParameterValues& p, double distance, double first,
                                double last)>
      near = {};
};

}  // namespace jostle::inline fitting
