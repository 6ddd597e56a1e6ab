#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "fitting/fit.hpp"
#include "fitting/models/models.hpp"
#include "tests/test_files.hpp"

namespace jostle {
namespace {

/// A curve whose least-squares minimum is known in long double.
struct ReferenceFit {
  std::unique_ptr<Model> model;
  Curve curve;
  ParameterValues minimum, starts[2];
  std::vector<double> errors;
  double residual_sum = 0, condition = 0;
  std::vector<std::vector<double>> correlation;
};

ReferenceFit read_reference(const std::string& file_name, const std::string& model) {
  std::ifstream file(test_data("fits/" + file_name + ".json"));
  const auto json = nlohmann::json::parse(file);
  ReferenceFit reference;
  reference.model = make_model(model);
  reference.curve.t = json["x"].get<std::vector<double>>();
  reference.curve.x = json["y"].get<std::vector<double>>();
  reference.minimum = json["certified_params"].get<ParameterValues>();
  reference.starts[0] = json["start1"].get<ParameterValues>();
  reference.starts[1] = json["start2"].get<ParameterValues>();
  reference.errors = json["certified_stderr"].get<std::vector<double>>();
  reference.residual_sum = json["certified_rss"];
  reference.condition = json["scaled_condition_number"];
  if (json.contains("correlation_lin_and_log_params")) {
    reference.correlation =
        json["correlation_lin_and_log_params"].get<std::vector<std::vector<double>>>();
  }
  // The files give the amplitude of the stretched exponential, the model its value at 0.
  if (model == "kww") {
    for (ParameterValues* p : {&reference.minimum, &reference.starts[0], &reference.starts[1]}) {
      (*p)[1] = (*p)[0] - (*p)[1];
    }
  }
  return reference;
}

double standard_error(const Fit& fit, std::size_t j) {
  if (fit.model != "kww" || j != 1) return fit.estimates[j].standard_error;
  const Eigen::MatrixXd& c = fit.covariance;
  return std::sqrt(c(0, 0) + c(1, 1) - 2 * c(0, 1));
}

void check_against(const ReferenceFit& reference, const FitOptions& options) {
  const Fit fitted = std::get<Fit>(fit(*reference.model, reference.curve, options));
  CHECK(is_minimum(fitted.reason));
  for (std::size_t j = 0; j < reference.minimum.size(); ++j) {
    INFO(fitted.estimates[j].parameter.name);
    CHECK(fitted.estimates[j].value == Approx(reference.minimum[j]).epsilon(1e-8));
    if (reference.residual_sum > 0) {
      CHECK(standard_error(fitted, j) == Approx(reference.errors[j]).epsilon(1e-8));
    }
  }
  if (reference.residual_sum > 0) {
    CHECK(fitted.residual_sum == Approx(reference.residual_sum).epsilon(1e-9));
  }
}

const std::pair<const char*, const char*> reference_fits[] = {{"IL_easy", "inverse_log"},
                                                              {"IL_noisefree", "inverse_log"},
                                                              {"Z_eq4", "inverse_log_height"},
                                                              {"AGE_eq6", "ageing"},
                                                              {"KWW_g020", "kww"},
                                                              {"KWW_g025", "kww"},
                                                              {"KWW_noisefree", "kww"}};

}  // namespace

TEST_CASE("minimisers and errors agree with long double ones to 8 digits") {
  for (const auto& [file, model] : reference_fits) {
    const ReferenceFit reference = read_reference(file, model);
    for (const ParameterValues& start : reference.starts) {
      INFO(file << " from " << (&start == reference.starts ? "start 1" : "start 2"));
      check_against(reference, {.start = start, .multi_start = false, .profiles = false});
    }
  }
}

TEST_CASE("fits without a start from the user find the same minimum") {
  for (const auto& [file, model] : reference_fits) {
    INFO(file);
    check_against(read_reference(file, model), {.profiles = false});
  }
}

TEST_CASE("correlations agree with those of the reference fits") {
  for (const auto& [file, model] : reference_fits) {
    const ReferenceFit reference = read_reference(file, model);
    if (reference.correlation.empty() || std::string(model) == "kww") continue;
    const Fit fitted = std::get<Fit>(fit(*reference.model, reference.curve, {.profiles = false}));
    for (std::size_t i = 0; i < reference.correlation.size(); ++i) {
      for (std::size_t j = 0; j < reference.correlation.size(); ++j) {
        INFO(file << " " << i << " " << j);
        const double got =
            fitted.correlation(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
        CHECK(got == Approx(reference.correlation[i][j]).margin(1e-6));
      }
    }
    INFO(file);
    CHECK(fitted.condition == Approx(reference.condition).epsilon(1e-3));
  }
}

}  // namespace jostle
