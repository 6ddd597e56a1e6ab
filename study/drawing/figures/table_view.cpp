#include "study/drawing/figures/table_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "config/scene.hpp"
#include "study/drawing/figures/figure.hpp"
#include "study/tables/points/half_widths.hpp"

namespace jostle::inline study {
namespace {

std::vector<double> numbers(const Quantity* quantity) {
  if (quantity == nullptr) return {};
  if (const auto* const whole = std::get_if<std::vector<std::uint64_t>>(&quantity->values)) {
    return {whole->begin(), whole->end()};
  }
  const auto* const values = std::get_if<std::vector<double>>(&quantity->values);
  return values == nullptr ? std::vector<double>{} : *values;
}

std::vector<std::string> strings(const Quantity* quantity) {
  if (quantity == nullptr) return {};
  const auto* const texts = std::get_if<std::vector<std::string>>(&quantity->values);
  return texts == nullptr ? std::vector<std::string>{} : *texts;
}

std::vector<std::string> parts_of(const std::string& name) {
  std::vector<std::string> parts(1);
  for (const char c : name) {
    if (c == '/') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

}  // namespace

TableView::TableView(const DrawnTable& drawn) : drawn_(&drawn), path_(parts_of(drawn.table.name)) {
  constexpr std::string_view mark = "point_";
  if (path_.size() < 2 || !path_.front().starts_with(mark)) return;
  const std::string digits = path_.front().substr(mark.size());
  std::uint32_t number = 0;
  const auto [end, fault] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (fault != std::errc() || end != digits.data() + digits.size()) return;
  point_ = number;
  path_.erase(path_.begin());
}

std::string TableView::observable() const {
  const std::string asked = note("observable");
  return asked.empty() ? path_.back() : asked;
}

const Quantity* TableView::found(const std::string& quantity) const {
  const auto found = std::ranges::find(drawn_->table.quantities, quantity, &Quantity::name);
  return found == drawn_->table.quantities.end() ? nullptr : &*found;
}
const Quantity* TableView::found_axis(const std::string& name) const {
  const auto found = std::ranges::find(drawn_->table.axes, name, &Quantity::name);
  return found == drawn_->table.axes.end() ? nullptr : &*found;
}
const Quantity* TableView::either(const std::string& name) const {
  const Quantity* const quantity = found(name);
  return quantity != nullptr ? quantity : found_axis(name);
}

std::vector<std::string> TableView::quantities() const {
  std::vector<std::string> names;
  for (const Quantity& quantity : drawn_->table.quantities) names.push_back(quantity.name);
  return names;
}

bool TableView::has_axis(const std::string& name) const {
  return found_axis(name) != nullptr;
}
std::vector<double> TableView::axis(const std::string& name) const {
  return numbers(found_axis(name));
}
std::vector<std::string> TableView::axis_texts(const std::string& name) const {
  return strings(found_axis(name));
}
std::vector<double> TableView::values(const std::string& quantity) const {
  return numbers(found(quantity));
}
std::vector<std::string> TableView::texts(const std::string& quantity) const {
  return strings(found(quantity));
}

double TableView::value(const std::string& quantity, std::size_t i) const {
  const std::vector<double> all = values(quantity);
  return i < all.size() ? all[i] : no_value;
}

std::vector<double> TableView::row(const std::string& quantity, std::size_t i) const {
  return row_of(found(quantity), values(quantity), i);
}

std::vector<double> TableView::half_widths(const std::string& quantity) const {
  const std::vector<double> low = values(quantity + "_low_68"), dof = values(quantity + "_dof");
  std::vector<double> widths = values(quantity + (low.empty() ? "_error" : "_high_68"));
  if (low.size() == widths.size() && !low.empty()) {
    for (std::size_t i = 0; i < widths.size(); ++i) widths[i] = (widths[i] - low[i]) / 2;
    return widths;
  }
  if (dof.empty()) return {};
  HalfWidths half;
  for (std::size_t i = 0; i < widths.size(); ++i) {
    widths[i] = half(widths[i], dof[dof.size() == widths.size() ? i : 0]);
  }
  return widths;
}

double TableView::half_width(const std::string& quantity, std::size_t i) const {
  const std::vector<double> all = half_widths(quantity);
  return i < all.size() ? all[i] : no_value;
}

std::vector<double> TableView::half_width_row(const std::string& quantity, std::size_t i) const {
  return row_of(found(quantity), half_widths(quantity), i);
}

std::vector<double> TableView::row_of(const Quantity* quantity, std::vector<double> all,
                                      std::size_t i) const {
  if (quantity == nullptr || quantity->axes.size() < 2) return all;
  const Quantity* const last = found_axis(quantity->axes.back());
  const std::size_t length =
      last == nullptr ? 0
                      : std::visit([](const auto& values) { return values.size(); }, last->values);
  if ((i + 1) * length > all.size()) return {};
  const auto begin = all.begin() + static_cast<std::ptrdiff_t>(i * length);
  return {begin, begin + static_cast<std::ptrdiff_t>(length)};
}

std::string TableView::units(const std::string& name) const {
  const Quantity* const quantity = either(name);
  return quantity == nullptr ? "1" : quantity->units;
}
std::string TableView::long_name(const std::string& name) const {
  const Quantity* const quantity = either(name);
  return quantity == nullptr ? "" : quantity->long_name;
}
std::string TableView::source(const std::string& quantity) const {
  const Quantity* const values = found(quantity);
  return values == nullptr || values->source == "jostle" ? "" : values->source;
}

std::string TableView::note(const std::string& key) const {
  for (const auto& [name, text] : drawn_->table.notes) {
    if (name == key) return text;
  }
  return "";
}

namespace {

/// The settings of a part with the defaults of this version: an earlier one may have had fewer.
std::string settings_with_defaults(const TableView& table) {
  const std::string& part = table.path().back();
  const std::string written = table.note("settings");
  const ParsedStructure parsed = parse_structure(fmt::format(R"({{"{}": {}}})", part, written));
  return parsed.settings ? resolved(*parsed.settings).at(part).dump() : written;
}

}  // namespace

bool measured_alike(const TableView& a, const TableView& b) {
  if (a.note("settings").empty() || b.note("settings").empty()) return true;
  return a.note("region") == b.note("region") &&
         settings_with_defaults(a) == settings_with_defaults(b);
}

}  // namespace jostle::inline study
