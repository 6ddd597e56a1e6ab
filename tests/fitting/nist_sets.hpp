#pragma once

#include <Eigen/Core>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "fitting/solver/levenberg_marquardt.hpp"
#include "tests/fitting/nist_models.hpp"

namespace jostle {

/// A certified set of NIST StRD, nonlinear regression.
struct NistSet {
  std::string name;
  NistModel model;
  std::vector<std::vector<double>> x;  // [n][n_predictors]
  Eigen::VectorXd y;                   // [n]
  std::vector<double> starts[2], parameters, errors;
  double residual_sum = 0;
};

/// `folder` holds the sets as JSON files.
inline NistSet read_nist_set(const std::string& folder, const std::string& name, NistModel model) {
  std::ifstream file(folder + "/" + name + ".json");
  const auto json = nlohmann::json::parse(file);
  NistSet set{name,
              model,
              {},
              {},
              {json["start1"], json["start2"]},
              json["certified_params"],
              json["certified_stderr"],
              json["certified_rss"]};
  const std::vector<double> y = json["y"];
  set.y = Eigen::Map<const Eigen::VectorXd>(y.data(), static_cast<Eigen::Index>(y.size()));
  // The model is that of log(y).
  if (name == "Nelson") set.y = set.y.array().log();
  for (const auto& x : json["x"]) {
    set.x.push_back(x.is_array() ? x.get<std::vector<double>>() : std::vector<double>{x});
  }
  return set;
}

class NistResiduals final : public Residuals {
 public:
  explicit NistResiduals(const NistSet& set) : set_(set) {}

  Eigen::Index n_residuals() const override { return set_.y.size(); }
  Eigen::Index n_variables() const override {
    return static_cast<Eigen::Index>(set_.parameters.size());
  }
  void values(const Eigen::VectorXd& b, Eigen::VectorXd& r) const override {
    Eigen::MatrixXd unused(n_residuals(), n_variables());
    values_and_jacobian(b, r, unused);
  }
  void values_and_jacobian(const Eigen::VectorXd& b, Eigen::VectorXd& r,
                           Eigen::MatrixXd& jacobian) const override {
    std::vector<Dual> parameters;
    for (Eigen::Index j = 0; j < b.size(); ++j) {
      parameters.push_back(Dual::variable(b[j], static_cast<std::size_t>(j)));
    }
    for (Eigen::Index i = 0; i < r.size(); ++i) {
      const Dual f = set_.model(parameters.data(), set_.x[static_cast<std::size_t>(i)].data());
      r[i] = f.v - set_.y[i];
      for (Eigen::Index j = 0; j < b.size(); ++j) {
        jacobian(i, j) = f.d[static_cast<std::size_t>(j)];
      }
    }
  }

 private:
  const NistSet& set_;
};

}  // namespace jostle
