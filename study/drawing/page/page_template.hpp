#pragma once

#include <string>

namespace jostle::inline study {

/// report/page.html, which report/build.mjs makes: the page with its script and its styles, and the
/// marks @TITLE@ and @DATA@, each once.
std::string page_template();

}  // namespace jostle::inline study
