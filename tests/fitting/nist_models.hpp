#pragma once

#include <cmath>
#include <map>
#include <string>

#include "dual.hpp"

namespace jostle {

/// A model of NIST StRD with derivatives; b: parameters, x: predictors (Nelson has two).
using NistModel = Dual (*)(const Dual* b, const double* x);

inline Dual exponential_sum(const Dual* b, const double* x) {
  return b[0] * exp(-b[1] * x[0]) + b[2] * exp(-b[3] * x[0]) + b[4] * exp(-b[5] * x[0]);
}
inline Dual gauss(const Dual* b, const double* x) {
  return b[0] * exp(-b[1] * x[0]) + b[2] * exp(-square(x[0] - b[3]) / square(b[4])) +
         b[5] * exp(-square(x[0] - b[6]) / square(b[7]));
}
inline Dual cubic_ratio(const Dual* b, const double* x) {
  const double t = x[0];
  return (b[0] + b[1] * t + b[2] * t * t + b[3] * t * t * t) /
         (1.0 + b[4] * t + b[5] * t * t + b[6] * t * t * t);
}
inline Dual chwirut(const Dual* b, const double* x) {
  return exp(-b[0] * x[0]) / (b[1] + b[2] * x[0]);
}
inline Dual saturation(const Dual* b, const double* x) {
  return b[0] * (1.0 - exp(-b[1] * x[0]));
}
inline Dual seasons(const Dual* b, const double* x) {
  const double pi = std::acos(-1.0);
  const Dual first = 2 * pi * x[0] / b[3], second = 2 * pi * x[0] / b[6];
  return b[0] + b[1] * std::cos(2 * pi * x[0] / 12) + b[2] * std::sin(2 * pi * x[0] / 12) +
         b[4] * cos(first) + b[5] * sin(first) + b[7] * cos(second) + b[8] * sin(second);
}

inline const std::map<std::string, NistModel>& nist_models() {
  static const std::map<std::string, NistModel> models = {
      {"Bennett5",
       [](const Dual* b, const double* x) { return b[0] * pow(b[1] + x[0], -1.0 / b[2]); }},
      {"BoxBOD", saturation},
      {"Chwirut1", chwirut},
      {"Chwirut2", chwirut},
      {"DanWood", [](const Dual* b, const double* x) { return b[0] * pow(Dual(x[0]), b[1]); }},
      {"ENSO", seasons},
      {"Eckerle4",
       [](const Dual* b, const double* x) {
         return b[0] / b[1] * exp(-0.5 * square((x[0] - b[2]) / b[1]));
       }},
      {"Gauss1", gauss},
      {"Gauss2", gauss},
      {"Gauss3", gauss},
      {"Hahn1", cubic_ratio},
      {"Kirby2",
       [](const Dual* b, const double* x) {
         const double t = x[0];
         return (b[0] + b[1] * t + b[2] * t * t) / (1.0 + b[3] * t + b[4] * t * t);
       }},
      {"Lanczos1", exponential_sum},
      {"Lanczos2", exponential_sum},
      {"Lanczos3", exponential_sum},
      {"MGH09",
       [](const Dual* b, const double* x) {
         const double t = x[0];
         return b[0] * (t * t + t * b[1]) / (t * t + t * b[2] + b[3]);
       }},
      {"MGH10", [](const Dual* b, const double* x) { return b[0] * exp(b[1] / (x[0] + b[2])); }},
      {"MGH17",
       [](const Dual* b, const double* x) {
         return b[0] + b[1] * exp(-x[0] * b[3]) + b[2] * exp(-x[0] * b[4]);
       }},
      {"Misra1a", saturation},
      {"Misra1b",
       [](const Dual* b, const double* x) {
         return b[0] * (1.0 - 1.0 / square(1.0 + b[1] * x[0] / 2.0));
       }},
      {"Misra1c",
       [](const Dual* b, const double* x) {
         return b[0] * (1.0 - pow(1.0 + 2.0 * b[1] * x[0], Dual(-0.5)));
       }},
      {"Misra1d",
       [](const Dual* b, const double* x) { return b[0] * b[1] * x[0] / (1.0 + b[1] * x[0]); }},
      {"Nelson",
       [](const Dual* b, const double* x) { return b[0] - b[1] * x[0] * exp(-b[2] * x[1]); }},
      {"Rat42",
       [](const Dual* b, const double* x) { return b[0] / (1.0 + exp(b[1] - b[2] * x[0])); }},
      {"Rat43",
       [](const Dual* b, const double* x) {
         return b[0] / pow(1.0 + exp(b[1] - b[2] * x[0]), 1.0 / b[3]);
       }},
      {"Roszman1",
       [](const Dual* b, const double* x) {
         return b[0] - b[1] * x[0] - atan(b[2] / (x[0] - b[3])) / std::acos(-1.0);
       }},
      {"Thurber", cubic_ratio}};
  return models;
}

}  // namespace jostle
