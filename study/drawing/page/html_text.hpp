#pragma once

#include <string>
#include <string_view>

namespace jostle::inline study {

/// The text escaped for HTML, also for an attribute in double quotes.
std::string html_text(std::string_view text);

}  // namespace jostle::inline study
