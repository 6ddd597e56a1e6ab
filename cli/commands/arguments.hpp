#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

#include "study/tables/fit_source.hpp"

// What values options take, with messages of their own: the parser's wrap negative numbers and
// print ranges in 309 digits.
namespace jostle {

/// Whole numbers from `least` to 2^64 - 1.
CLI::Validator whole_from(std::uint64_t least);

/// Finite numbers above 0.
CLI::Validator positive_number();

/// A file's name: neither empty nor "-", which stands for no stream here.
CLI::Validator file_to_write();

/// "1:4000", ":4000", "1:". Throws BadInput naming the option.
FitRange read_range(const std::string& option, const std::string& text);

/// Has every option that holds unsigned numbers, of all commands, refuse negative ones.
void refuse_negative_counts(CLI::App& app);

/// For a command line that could not be read: a word that should be a command, or an option that
/// its command does not have, with those there are or the nearest of them. Empty for others.
std::string unknown_word(const CLI::App& app);

}  // namespace jostle
