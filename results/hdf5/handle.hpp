#pragma once

#include <hdf5.h>

#include <stdexcept>
#include <string>
#include <utility>

#include "results/disk/error.hpp"

namespace jostle::inline results {

/// The error message of HDF5; naming_file() adds the file.
class Hdf5Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws Hdf5Error with HDF5's own reason where the library reports a failure (a negative value).
template <class Result>
Result checked(Result result);

/// An HDF5 identifier, given back by the function that suits its kind.
class Hdf5Handle {
 public:
  using Close = herr_t (*)(hid_t);

  Hdf5Handle() = default;
  Hdf5Handle(hid_t id, Close closer) : id_(checked(id)), close_(closer) {}
  Hdf5Handle(Hdf5Handle&& source) noexcept
      : id_(std::exchange(source.id_, -1)), close_(source.close_) {}
  Hdf5Handle& operator=(Hdf5Handle&& source) noexcept {
    std::swap(id_, source.id_);
    std::swap(close_, source.close_);
    return *this;
  }
  ~Hdf5Handle() {
    if (id_ >= 0) close_(id_);
  }

  operator hid_t() const { return id_; }
  /// Closes now and throws Hdf5Error if that fails.
  void close() { checked(close_(std::exchange(id_, -1))); }

 private:
  hid_t id_ = -1;
  Close close_ = nullptr;
};

/// How files are opened, for reading and for writing: what is in them is read and written once from
/// start to end, and a group may have a million members.
Hdf5Handle file_access();

/// Keeps HDF5 from printing its errors: they come as exceptions.
void silence_hdf5();
/// The innermost message on HDF5's error stack, which is then cleared.
std::string hdf5_reason();

template <class Result>
Result checked(Result result) {
  if (result < 0) throw Hdf5Error(hdf5_reason());
  return result;
}

/// Runs `work` and turns an Hdf5Error into a ResultsError with the path; a list that is shorter
/// than another that it belongs to likewise.
template <class Work>
auto naming_file(const std::string& path, Work&& work) {
  try {
    return work();
  } catch (const Hdf5Error& error) {
    throw ResultsError(path, error.what());
  } catch (const std::out_of_range&) {
    throw ResultsError(path, "its lists have different lengths: not written by jostle");
  }
}

}  // namespace jostle::inline results
