#pragma once

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/bed/random.hpp"

// Damage as it happens to files: to their bytes, and to the structure of JSON. The same random
// stream does the same damage on every machine.
namespace jostle {

inline RandomStream mutation_stream(std::uint64_t seed) {
  return RandomStream(stream_key(seed, 2, 0, Purpose::resampling));
}

/// One to four changes of bytes: a bit flipped, a piece lost, doubled or overwritten, the end lost.
inline std::string mutated_bytes(std::string text, RandomStream& random) {
  const auto piece = [&](std::size_t most) {
    return random.integer_below(std::min(most, text.size()) + 1);
  };
  for (std::uint64_t change = 0, n = 1 + random.integer_below(4); change < n && !text.empty();
       ++change) {
    const std::uint64_t index = random.integer_below(text.size());
    switch (random.integer_below(6)) {
      case 0:
        text[index] = static_cast<char>(text[index] ^ (1 << random.integer_below(8)));
        break;
      case 1:
        text.erase(index, piece(40));
        break;
      case 2:
        text.insert(random.integer_below(text.size()), text.substr(index, piece(40)));
        break;
      case 3:
        text.insert(index, 1, static_cast<char>(random.integer_below(256)));
        break;
      case 4:
        text.replace(index, 1, 1 + piece(30),
                     static_cast<char>(text[random.integer_below(text.size())]));
        break;
      default:
        if (random.integer_below(4) == 0) text.resize(index);
    }
  }
  return text;
}

/// Values that a parser meets where it expects others.
inline nlohmann::ordered_json surprising_value(RandomStream& random) {
  static const char* const texts[] = {"null",
                                      "true",
                                      "0",
                                      "-1",
                                      "1",
                                      "2",
                                      "0.5",
                                      "1e308",
                                      "-1e308",
                                      "5e-324",
                                      "1e-9",
                                      "0.1",
                                      "4294967295",
                                      "4294967296",
                                      "9223372036854775807",
                                      "18446744073709551615",
                                      "\"\"",
                                      "\"\\u0000\"",
                                      "\"infinity\"",
                                      "\"all\"",
                                      "[]",
                                      "{}",
                                      "[[]]",
                                      "[0, 1]",
                                      "[1, 0]",
                                      "{\"\": {}}",
                                      "{\"from\": 1, \"to\": 1e6, \"per_decade\": 10}",
                                      "{\"file\": \"a.h5\"}"};
  return nlohmann::ordered_json::parse(texts[random.integer_below(std::size(texts))]);
}

/// Every value within `value`, itself included.
inline void collect(nlohmann::ordered_json& value, std::vector<nlohmann::ordered_json*>& all) {
  all.push_back(&value);
  if (!value.is_structured()) return;
  for (auto& member : value) collect(member, all);
}

/// One to three changes of structure: a value replaced by a surprising one or by another of the
/// scene, made larger or smaller, removed, doubled, or given another key.
inline nlohmann::ordered_json mutated_structure(nlohmann::ordered_json scene,
                                                RandomStream& random) {
  static constexpr std::array factors = {-1.0, 0.0, 0.5, 2.0, 1e-3, 1e3, 1e12};
  for (std::uint64_t change = 0, n = 1 + random.integer_below(3); change < n; ++change) {
    std::vector<nlohmann::ordered_json*> all;
    collect(scene, all);
    nlohmann::ordered_json& value = *all[random.integer_below(all.size())];
    const nlohmann::ordered_json donor = *all[random.integer_below(all.size())];
    switch (random.integer_below(6)) {
      case 0:
        value = surprising_value(random);
        break;
      case 1:
        value = donor;
        break;
      case 2:
      case 3:
        if (value.is_number()) {
          value = value.get<double>() * factors[random.integer_below(factors.size())];
        }
        break;
      case 4:
        if (value.is_structured() && !value.empty()) {
          auto place = value.begin();
          std::advance(place, random.integer_below(value.size()));
          value.erase(place);
        }
        break;
      default:
        if (value.is_array()) value.push_back(donor);
        if (value.is_object()) value[random.integer_below(2) ? "tap" : "no_such_key"] = donor;
    }
  }
  return scene;
}

}  // namespace jostle
