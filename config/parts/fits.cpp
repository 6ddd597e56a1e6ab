#include <fmt/format.h>

#include "config/parts/parts.hpp"

namespace jostle::inline config {

namespace {

FitRequest read_fit(const Reader& in) {
  FitRequest fit;
  if (!in.is_object_of({"observable", "model", "range"})) return fit;
  if (const auto observable = in.find("observable")) {
    fit.observable = observable->text().value_or("");
  } else {
    in.missing("observable", "the name of an observable of this scene");
  }
  std::vector<std::string> allowed = relaxation_laws();
  allowed.emplace_back("all");
  if (const auto model = in.find("model")) {
    fit.model = model->one_of(allowed).value_or("");
  } else {
    in.missing("model", "one of the strings " + listed(allowed));
  }
  const auto range = in.find("range");
  if (!range || !range->is_list(1, 2, "taps, first and last")) return fit;
  fit.first = range->element(0).whole_number(0, most_taps).value_or(fit.first);
  if (range->value().size() < 2) return fit;
  fit.last = range->element(1).whole_number(0, most_taps);
  if (fit.last && *fit.last <= fit.first) {
    range->fault(fmt::format("the range from {} to {} is empty: the first tap must be the lower",
                             fit.first, *fit.last));
  }
  return fit;
}

}  // namespace

std::vector<std::string> relaxation_laws() {
  return {"inverse_log", "inverse_log_height", "two_exponentials", "kww"};
}

// Eq. 4 is eq. 3 with other parameters.
std::vector<std::string> competing_laws() {
  return {"inverse_log", "two_exponentials", "kww"};
}

std::vector<FitRequest> read_fits(const Reader& in) {
  std::vector<FitRequest> fits;
  if (!in.is_list(0, 100, "fits")) return fits;
  for (std::size_t i = 0; i < in.value().size(); ++i) fits.push_back(read_fit(in.element(i)));
  return fits;
}

Json written(const std::vector<FitRequest>& fits) {
  Json list = Json::array();
  for (const FitRequest& fit : fits) {
    Json range = Json::array({fit.first});
    if (fit.last) range.push_back(*fit.last);
    list.push_back({{"observable", fit.observable}, {"model", fit.model}, {"range", range}});
  }
  return list;
}

}  // namespace jostle::inline config
