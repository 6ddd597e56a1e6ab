#include "tests/config/schema_validator.hpp"

#include <cmath>
#include <cstdint>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "config/scene.hpp"

namespace jostle {
namespace {

/// The document as draft-07 sees it: any number without a fraction is an integer (6.1.1), of any
/// size. valijson looks at how the number is stored, in 64 signed bits.
PlainJson with_integers(PlainJson value) {
  if (value.is_number_float()) {
    const auto number = value.get<double>();
    if (number == std::trunc(number) && std::abs(number) < 0x1p53) {
      return static_cast<std::int64_t>(number);
    }
  }
  if (value.is_number_unsigned() && value.get<std::uint64_t>() > INT64_MAX) {
    return INT64_MAX;  // within the range of every key that takes such numbers, the seed
  }
  if (value.is_structured()) {
    for (auto& member : value) member = with_integers(member);
  }
  return value;
}

}  // namespace

struct SchemaValidator::Impl {
  valijson::Schema schema;
  valijson::Validator validator;
};

SchemaValidator::SchemaValidator() : impl_(std::make_unique<Impl>()) {
  const PlainJson text = PlainJson::parse(scene_schema());
  valijson::SchemaParser(valijson::SchemaParser::kDraft7)
      .populateSchema(valijson::adapters::NlohmannJsonAdapter(text), impl_->schema);
}

SchemaValidator::~SchemaValidator() = default;

bool SchemaValidator::accepts(const PlainJson& scene) {
  const PlainJson document = with_integers(scene);
  return impl_->validator.validate(impl_->schema, valijson::adapters::NlohmannJsonAdapter(document),
                                   nullptr);
}

}  // namespace jostle
