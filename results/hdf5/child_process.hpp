#pragma once

#include <functional>
#include <string>

namespace jostle::inline results {

/// Runs `work` in a child process and returns its text. HDF5 1.10 crashes on some files whose
/// internal structures are damaged: there the crash ends the child, and an Hdf5Error reports it.
/// A ResultsError, Hdf5Error or std::bad_alloc of `work` is thrown here again. Where no process can
/// be started, `work` runs in this one.
std::string in_child_process(const std::function<std::string()>& work);

}  // namespace jostle::inline results
