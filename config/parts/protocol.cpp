#include <fmt/format.h>

#include <cmath>

#include "config/grids.hpp"
#include "config/parts/parts.hpp"

namespace jostle {

namespace {

constexpr std::uint64_t most_taps = 1'000'000'000;
constexpr std::uint64_t most_strengths = 1000;
constexpr Range dilations = between(0, 10);
constexpr Range lifts = between(0, 100);

const std::vector<std::string> tap_kinds{"dilate", "dilate_floor_held", "lift", "shake"};

/// {"from", "to", "step"} or, for what is best stepped in its square root, {"sqrt_from", ...}.
Ramp read_ramp(const Reader& in, Range strengths, bool may_be_square_root) {
  Ramp ramp;
  const std::vector<std::string> plain{"from", "to", "step"};
  const std::vector<std::string> rooted{"sqrt_from", "sqrt_to", "sqrt_step"};
  const bool square_root =
      may_be_square_root && (in.find("sqrt_from") || in.find("sqrt_to") || in.find("sqrt_step"));
  const auto& keys = square_root ? rooted : plain;
  std::vector<std::string> allowed = keys;
  if (may_be_square_root && !square_root)
    allowed.insert(allowed.end(), rooted.begin(), rooted.end());
  if (!in.is_object_of(allowed)) return ramp;

  const Range range = square_root ? between(0, 3) : strengths;
  ramp.scale = square_root ? RampScale::square_root : RampScale::linear;
  for (const std::string& key : keys) {
    if (!in.find(key)) in.missing(key, "a ramp has the keys " + listed(keys));
  }
  in.read(keys[0], ramp.from, range);
  in.read(keys[1], ramp.to, range);
  in.read(keys[2], ramp.step, above(0, range.high));
  if (!in.sound()) return ramp;
  const auto steps = whole_steps(ramp);
  if (!steps) {
    const double step = ramp.from > ramp.to ? -ramp.step : ramp.step;
    const double before = ramp.from + std::floor((ramp.to - ramp.from) / step) * step;
    in.fault(
        fmt::format("steps of {} from {} do not reach {} but {:.6g} and {:.6g}: both ends are "
                    "included, so the step must divide the distance",
                    ramp.step, ramp.from, ramp.to, before, before + step));
  } else if (*steps >= most_strengths) {
    in.fault(fmt::format("{} strengths: a ramp has at most {}", *steps + 1, most_strengths));
  }
  return ramp;
}

Shake read_shake(const Reader& in, std::optional<Ramp>* ramp) {
  Shake shake;
  if (!in.is_object_of({"lambda", "lateral_radius", "retries"})) return shake;
  if (!ramp) {
    in.read("lambda", shake.lambda, dilations);
  } else if (const auto lambda = in.find("lambda")) {
    *ramp = read_ramp(*lambda, dilations, true);
    shake.lambda = 0;
  } else {
    in.missing("lambda", "the ramp of a shake is an object here");
  }
  in.read("lateral_radius", shake.lateral_radius, between(0, 1));
  in.read_whole("retries", shake.retries, 0, 1000);
  return shake;
}

Tap read_tap(const Reader& in) {
  const auto tap = in.choice(tap_kinds);
  if (!tap) return Dilate{};
  if (tap->name == "dilate") {
    return Dilate{tap->settings.number(dilations).value_or(0)};
  }
  if (tap->name == "dilate_floor_held") {
    return DilateFloorHeld{tap->settings.number(dilations).value_or(0)};
  }
  if (tap->name == "lift") return Lift{tap->settings.number(lifts).value_or(0)};
  return read_shake(tap->settings, nullptr);
}

void read_ramped_tap(const Reader& in, ProtocolLine& line) {
  line.ramp = Ramp{};
  const auto tap = in.choice(tap_kinds);
  if (!tap) return;
  if (tap->name == "shake") {
    line.tap = read_shake(tap->settings, &line.ramp);
    return;
  }
  line.ramp =
      read_ramp(tap->settings, tap->name == "lift" ? lifts : dilations, tap->name != "lift");
  if (tap->name == "dilate") line.tap = Dilate{0};
  if (tap->name == "dilate_floor_held") line.tap = DilateFloorHeld{0};
  if (tap->name == "lift") line.tap = Lift{0};
}

ProtocolLine read_line(const Reader& in) {
  ProtocolLine line;
  if (!in.is_object_of({"tap", "ramp", "count"})) return line;
  const auto tap = in.find("tap");
  const auto ramp = in.find("ramp");
  if (tap) line.tap = read_tap(*tap);
  if (ramp) read_ramped_tap(*ramp, line);
  if (tap && ramp) in.fault("expected only one of the keys tap, ramp");
  if (!tap && !ramp) in.fault("expected one of the keys tap, ramp");
  if (!in.find("count")) {
    in.missing("count", "how many taps (of a ramp: at each strength), a whole number");
  }
  in.read_whole("count", line.count, 0, most_taps);
  return line;
}

Json written(const Ramp& ramp) {
  if (ramp.scale == RampScale::square_root) {
    return {{"sqrt_from", plain_number(ramp.from)},
            {"sqrt_to", plain_number(ramp.to)},
            {"sqrt_step", plain_number(ramp.step)}};
  }
  return {{"from", plain_number(ramp.from)},
          {"to", plain_number(ramp.to)},
          {"step", plain_number(ramp.step)}};
}

/// Writes a tap; a ramp, if any, stands in the place of the strength.
struct TapWriter {
  const std::optional<Ramp>& ramp;

  Json strength(double value) const { return ramp ? written(*ramp) : plain_number(value); }
  Json operator()(const Dilate& tap) const { return {{"dilate", strength(tap.epsilon)}}; }
  Json operator()(const DilateFloorHeld& tap) const {
    return {{"dilate_floor_held", strength(tap.delta)}};
  }
  Json operator()(const Lift& tap) const { return {{"lift", strength(tap.gamma)}}; }
  Json operator()(const Shake& tap) const {
    return {{"shake",
             {{"lambda", strength(tap.lambda)},
              {"lateral_radius", plain_number(tap.lateral_radius)},
              {"retries", tap.retries}}}};
  }
};

}  // namespace

std::vector<ProtocolLine> read_protocol(const Reader& in) {
  std::vector<ProtocolLine> protocol;
  if (!in.is_list(0, 1000, "stages")) return protocol;
  for (std::size_t i = 0; i < in.value().size(); ++i) protocol.push_back(read_line(in.element(i)));
  return protocol;
}

Json written(const Tap& tap) {
  return std::visit(TapWriter{std::nullopt}, tap);
}

Json written(const std::vector<ProtocolLine>& protocol) {
  Json lines = Json::array();
  for (const ProtocolLine& line : protocol) {
    lines.push_back({{line.ramp ? "ramp" : "tap", std::visit(TapWriter{line.ramp}, line.tap)},
                     {"count", line.count}});
  }
  return lines;
}

}  // namespace jostle
