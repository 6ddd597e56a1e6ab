#pragma once

#include <cstddef>
#include <string>
#include <string_view>

// Names of the files beside a results file while it is written.
namespace jostle::inline results {

/// Bytes that a file's name may have in the folder of `path`: 255 nearly everywhere.
std::size_t longest_name_beside(const std::string& path);

/// `path` with an ending. Where the name would be too long for its folder: the first bytes of the
/// old name, "~" and 16 digits that stand for all of it, and the ending.
std::string path_with_ending(const std::string& path, std::string_view ending);

/// Throws ResultsError where the name of a file to be written is too long for its folder.
void require_name_fits(const std::string& path);

}  // namespace jostle::inline results
