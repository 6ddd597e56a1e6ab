#pragma once

#include <string>

namespace jostle::inline study {

/// 4.1e+07 as "41.0 M", 950 as "950".
std::string format_count(double count);
/// Bytes with a binary unit: "12.3 MiB".
std::string format_bytes(double bytes);

}  // namespace jostle::inline study
