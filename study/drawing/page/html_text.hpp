#pragma once

#include <string>
#include <string_view>

namespace jostle::inline study {

/// The text as it stands in HTML, also in an attribute in double quotes.
std::string html_text(std::string_view text);

}  // namespace jostle::inline study
