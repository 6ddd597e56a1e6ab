#pragma once

namespace jostle::inline results {

/// For a program, before anything else of HDF5: at its exit HDF5 shall not close again what it
/// could not close, which crashes it. Results files are always closed by whoever opened them.
void close_nothing_at_exit();

}  // namespace jostle::inline results
