#include <fmt/format.h>

#include <cmath>

#include "config/grids.hpp"
#include "config/parts/kinds.hpp"
#include "config/parts/parts.hpp"
#include "ensemble/statistics/finite_text.hpp"

namespace jostle::inline config {

namespace {

constexpr std::uint64_t most_strengths = 1000;
constexpr Range dilations = between(0, 10);
constexpr Range lifts = between(0, 100);

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
        finite_text("steps of {} from {} do not reach {} but {:.6g} and {:.6g}: both ends are "
                    "included, so the step must divide the distance",
                    ramp.step, ramp.from, ramp.to, before, before + step));
  } else if (*steps >= most_strengths) {
    in.fault(fmt::format("{} strengths: a ramp has at most {}", *steps + 1, most_strengths));
  }
  return ramp;
}

enum class Rooted { no, yes };

/// Reads the strength of a tap: a number, or in its place a ramp.
struct StrengthReader {
  std::optional<Ramp>* ramp = nullptr;  // null: a number

  double operator()(const Reader& in, Range strengths, Rooted rooted) const {
    if (!ramp) return in.number(strengths).value_or(0);
    *ramp = read_ramp(in, strengths, rooted == Rooted::yes);
    return 0;
  }
};

/// Writes it.
struct StrengthWriter {
  const std::optional<Ramp>& ramp;

  Json operator()(double value) const;
};

template <class TapKind>
struct TapEntry {
  using Part = TapKind;
  std::string_view name;
  Tap (*read)(const Reader&, const StrengthReader&);
  Json (*write)(const TapKind&, const StrengthWriter&);
};

Tap read_shake(const Reader& in, const StrengthReader& strength) {
  Shake shake;
  if (!in.is_object_of({"lambda", "lateral_radius", "retries"})) return shake;
  if (const auto lambda = in.find("lambda")) {
    shake.lambda = strength(*lambda, dilations, Rooted::yes);
  } else if (strength.ramp) {
    in.missing("lambda", "the ramp of a shake is an object here");
  }
  in.read("lateral_radius", shake.lateral_radius, between(0, 1));
  in.read_whole("retries", shake.retries, 0, 1000);
  return shake;
}

Json written_shake(const Shake& tap, const StrengthWriter& strength) {
  return {{"lambda", strength(tap.lambda)},
          {"lateral_radius", plain_number(tap.lateral_radius)},
          {"retries", tap.retries}};
}

constexpr Range floor_strengths = between(0, 100);  // diameters, or Gamma
constexpr Range frequencies = between(1e-3, 1e6);   // Hz

template <class FloorTap>
void read_floor_motion(const Reader& in, const StrengthReader& strength, FloorTap& tap) {
  const auto amplitude = in.find("amplitude"), acceleration = in.find("acceleration");
  if (amplitude && acceleration) in.fault("expected only one of the keys acceleration, amplitude");
  if (acceleration) tap.kind = FloorStrength::acceleration;
  if (const auto& given = acceleration ? acceleration : amplitude) {
    tap.strength = strength(*given, floor_strengths, Rooted::no);
  } else if (strength.ramp) {
    in.missing("amplitude", "the ramp of a floor that moves is an object here");
  }
  in.read("frequency", tap.frequency, frequencies);
}

template <class FloorTap>
Json written_floor_motion(const FloorTap& tap, const StrengthWriter& strength) {
  const bool by_amplitude = tap.kind == FloorStrength::amplitude;
  return {{by_amplitude ? "amplitude" : "acceleration", strength(tap.strength)},
          {"frequency", plain_number(tap.frequency)}};
}

Tap read_half_sine(const Reader& in, const StrengthReader& strength) {
  HalfSine tap;
  if (in.is_object_of({"amplitude", "acceleration", "frequency"}))
    read_floor_motion(in, strength, tap);
  return tap;
}

Tap read_vibration(const Reader& in, const StrengthReader& strength) {
  Vibration tap;
  if (!in.is_object_of({"amplitude", "acceleration", "frequency", "cycles"})) return tap;
  read_floor_motion(in, strength, tap);
  in.read_whole("cycles", tap.cycles, 1, most_cycles);
  return tap;
}

constexpr TableOf<TapEntry, Tap>::Type tap_kinds{
    {"dilate",
     [](const Reader& in, const StrengthReader& strength) -> Tap {
       return Dilate{strength(in, dilations, Rooted::yes)};
     },
     [](const Dilate& tap, const StrengthWriter& strength) { return strength(tap.epsilon); }},
    {"dilate_floor_held",
     [](const Reader& in, const StrengthReader& strength) -> Tap {
       return DilateFloorHeld{strength(in, dilations, Rooted::yes)};
     },
     [](const DilateFloorHeld& tap, const StrengthWriter& strength) {
       return strength(tap.delta);
     }},
    {"lift",
     [](const Reader& in, const StrengthReader& strength) -> Tap {
       return Lift{strength(in, lifts, Rooted::no)};
     },
     [](const Lift& tap, const StrengthWriter& strength) { return strength(tap.gamma); }},
    {"shake", read_shake, written_shake},
    {"half_sine", read_half_sine, written_floor_motion<HalfSine>},
    {"vibration", read_vibration, [](const Vibration& tap, const StrengthWriter& strength) -> Json {
       Json settings = written_floor_motion(tap, strength);
       settings["cycles"] = tap.cycles;
       return settings;
     }}};

Tap read_tap(const Reader& in, const StrengthReader& strength) {
  const auto choice = in.choice(names_of(tap_kinds));
  if (!choice) return Dilate{};
  return read_kind(tap_kinds, choice->name,
                   [&](const auto& kind) { return kind.read(choice->settings, strength); });
}

Json written(const Tap& tap, const StrengthWriter& strength) {
  const Json settings = with_kind(tap_kinds, tap, [&](const auto& kind, const auto& part) {
    return kind.write(part, strength);
  });
  return {{name_of(tap_kinds, tap), settings}};
}

ProtocolLine read_line(const Reader& in) {
  ProtocolLine line;
  if (!in.is_object_of({"tap", "ramp", "count"})) return line;
  const auto tap = in.find("tap");
  const auto ramp = in.find("ramp");
  if (tap) line.tap = read_tap(*tap, {});
  if (ramp) {
    line.ramp = Ramp{};
    line.tap = read_tap(*ramp, {&line.ramp});
  }
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

Json StrengthWriter::operator()(double value) const {
  return ramp ? written(*ramp) : plain_number(value);
}

}  // namespace

std::vector<ProtocolLine> read_protocol(const Reader& in) {
  std::vector<ProtocolLine> protocol;
  if (!in.is_list(0, 1000, "stages")) return protocol;
  for (std::size_t i = 0; i < in.value().size(); ++i) protocol.push_back(read_line(in.element(i)));
  return protocol;
}

Json written(const std::vector<ProtocolLine>& protocol) {
  Json lines = Json::array();
  for (const ProtocolLine& line : protocol) {
    lines.push_back({{line.ramp ? "ramp" : "tap", written(line.tap, StrengthWriter{line.ramp})},
                     {"count", line.count}});
  }
  return lines;
}

}  // namespace jostle::inline config
