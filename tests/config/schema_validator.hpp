#pragma once

#include <memory>
#include <nlohmann/json.hpp>

namespace jostle {

using PlainJson = nlohmann::json;  // the type that valijson reads

/// Validates scenes against the schema that the program prints, by valijson.
class SchemaValidator {
 public:
  SchemaValidator();
  ~SchemaValidator();
  SchemaValidator(const SchemaValidator&) = delete;
  SchemaValidator& operator=(const SchemaValidator&) = delete;

  bool accepts(const PlainJson& scene);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace jostle
