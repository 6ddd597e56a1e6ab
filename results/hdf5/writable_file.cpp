#include "results/hdf5/writable_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <new>
#include <vector>

#include "results/disk/publish.hpp"

namespace jostle::inline results {
namespace {

/// Data that the driver receives through the access properties.
struct DriverSettings {
  int* error;
  bool keep;  // size of the file's contents
};

/// HDF5 sees the first member and hands its address back to every function below.
struct DriverFile {
  H5FD_t hdf5;
  int descriptor;
  int* error;
  haddr_t allocated;  // HDF5's end of the address space
  haddr_t size;       // size of the file, waiting bytes included
  haddr_t waiting_at;
  std::vector<std::byte> waiting;  // written by HDF5, not yet by us
};

DriverFile& driver_file(H5FD_t* file) {
  return *reinterpret_cast<DriverFile*>(file);
}
const DriverFile& driver_file(const H5FD_t* file) {
  return *reinterpret_cast<const DriverFile*>(file);
}

void remember(DriverFile& file, int error) {
  if (*file.error == 0) *file.error = error;
}

void write_waiting(DriverFile& file) {
  std::size_t done = 0;
  while (done < file.waiting.size() && *file.error == 0) {
    const ssize_t n =
        ::pwrite(file.descriptor, file.waiting.data() + done, file.waiting.size() - done,
                 static_cast<off_t>(file.waiting_at + done));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) remember(file, errno);
    if (n > 0) done += static_cast<std::size_t>(n);
  }
  file.waiting.clear();
}

H5FD_t* open_file(const char* name, unsigned, hid_t properties, haddr_t) {
  const auto* settings = static_cast<const DriverSettings*>(H5Pget_driver_info(properties));
  const int begin = settings->keep ? 0 : O_CREAT | O_TRUNC;
  const int descriptor = ::open(name, O_RDWR | begin | O_NOFOLLOW | O_CLOEXEC, 0666);
  struct stat status;
  if (descriptor < 0 || ::fstat(descriptor, &status) != 0) {
    *settings->error = errno;
    if (descriptor >= 0) ::close(descriptor);
    return nullptr;
  }
  const auto size = static_cast<haddr_t>(status.st_size);
  auto* const file = new (std::nothrow) DriverFile{{}, descriptor, settings->error, 0, size, 0, {}};
  if (file == nullptr) {
    *settings->error = ENOMEM;
    ::close(descriptor);
    return nullptr;
  }
  return &file->hdf5;
}

herr_t close_file(H5FD_t* base) {
  DriverFile& file = driver_file(base);
  write_waiting(file);
  if (::close(file.descriptor) != 0) remember(file, errno);
  delete &file;
  return 0;
}

int compare_files(const H5FD_t* a, const H5FD_t* b) {
  return a < b ? -1 : a > b;
}

herr_t query(const H5FD_t*, unsigned long* features) {
  *features = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
              H5FD_FEAT_AGGREGATE_SMALLDATA | H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
  return 0;
}

haddr_t allocated_end(const H5FD_t* file, H5FD_mem_t) {
  return driver_file(file).allocated;
}

herr_t set_allocated_end(H5FD_t* file, H5FD_mem_t, haddr_t end) {
  driver_file(file).allocated = end;
  return 0;
}

haddr_t file_end(const H5FD_t* file, H5FD_mem_t) {
  return driver_file(file).size;
}

/// Beyond what the disk took, zeros.
herr_t read_bytes_at(H5FD_t* base, H5FD_mem_t, hid_t, haddr_t address, std::size_t n, void* bytes) {
  DriverFile& file = driver_file(base);
  write_waiting(file);
  auto* destination = static_cast<std::byte*>(bytes);
  while (n > 0) {
    const ssize_t got = ::pread(file.descriptor, destination, n, static_cast<off_t>(address));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) remember(file, errno);
    if (got <= 0) break;
    destination += got;
    address += static_cast<haddr_t>(got);
    n -= static_cast<std::size_t>(got);
  }
  std::memset(destination, 0, n);
  return 0;
}

herr_t write_bytes_at(H5FD_t* base, H5FD_mem_t, hid_t, haddr_t address, std::size_t n,
                      const void* bytes) {
  constexpr std::size_t most_waiting = 4u << 20;
  DriverFile& file = driver_file(base);
  const bool joins = address == file.waiting_at + file.waiting.size();
  if (!joins || file.waiting.size() + n > most_waiting) write_waiting(file);
  if (file.waiting.empty()) file.waiting_at = address;
  const auto* source = static_cast<const std::byte*>(bytes);
  try {
    file.waiting.insert(file.waiting.end(), source, source + n);
  } catch (const std::bad_alloc&) {  // these must not pass through HDF5
    remember(file, ENOMEM);
  }
  file.size = std::max(file.size, address + n);
  return 0;
}

herr_t flush(H5FD_t* base, hid_t, hbool_t) {
  write_waiting(driver_file(base));
  return 0;
}

herr_t truncate_file(H5FD_t* base, hid_t, hbool_t) {
  DriverFile& file = driver_file(base);
  write_waiting(file);
  if (file.size == file.allocated) return 0;
  if (*file.error == 0 && ::ftruncate(file.descriptor, static_cast<off_t>(file.allocated)) != 0)
    remember(file, errno);
  file.size = file.allocated;
  return 0;
}

H5FD_class_t driver_class() {
  H5FD_class_t driver{};
#ifdef H5FD_CLASS_VERSION  // HDF5 1.14 checks both members; 1.10 and 1.12 have neither
  constexpr H5FD_class_value_t unregistered_driver =
      256;  // first value left to unregistered drivers
  driver.version = H5FD_CLASS_VERSION;
  driver.value = unregistered_driver;
#endif
  driver.name = "jostle";
  driver.maxaddr = (haddr_t{1} << 62) - 1;
  driver.fc_degree = H5F_CLOSE_WEAK;
  driver.fapl_size = sizeof(DriverSettings);
  driver.open = open_file;
  driver.close = close_file;
  driver.cmp = compare_files;
  driver.query = query;
  driver.get_eoa = allocated_end;
  driver.set_eoa = set_allocated_end;
  driver.get_eof = file_end;
  driver.read = read_bytes_at;
  driver.write = write_bytes_at;
  driver.flush = flush;
  driver.truncate = truncate_file;
  const H5FD_mem_t one_place[] = H5FD_FLMAP_DICHOTOMY;
  std::copy(std::begin(one_place), std::end(one_place), driver.fl_map);
  return driver;
}

/// HDF5 1.10 may damage its heap and abort where memory runs out while it writes, so that it is
/// checked before: throws std::bad_alloc. It takes 1 MB for a dataset, and as much again for data
/// that wait to be written and compressed.
void require_memory() {
  constexpr std::size_t enough = 16u << 20;
  ::operator delete(::operator new(enough));
}

}  // namespace

WritableHdf5File::WritableHdf5File(const std::string& path, Begin begin)
    : path_(path), error_(std::make_unique<int>(0)) {
  require_memory();
  silence_hdf5();
  const H5FD_class_t driver = driver_class();
  driver_ = Hdf5Handle(H5FDregister(&driver), H5FDunregister);
  const Hdf5Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  checked(H5Pset_obj_track_times(creation, false));
  // Room that a replaced table leaves is used again, also by a later process.
  constexpr bool across_processes = true;
  constexpr hsize_t least_room = 1;
  checked(H5Pset_file_space_strategy(creation, H5F_FSPACE_STRATEGY_FSM_AGGR, across_processes,
                                     least_room));
  const Hdf5Handle access = file_access();
  const DriverSettings settings{error_.get(), begin == Begin::as_it_is};
  checked(H5Pset_driver(access, driver_, &settings));
  const hid_t file = begin == Begin::as_it_is
                         ? H5Fopen(path.c_str(), H5F_ACC_RDWR, access)
                         : H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, access);
  check();
  file_ = Hdf5Handle(file, H5Fclose);
}

WritableHdf5File::~WritableHdf5File() = default;

void WritableHdf5File::check() const {
  if (*error_ != 0) fail_on_disk(path_, "write", *error_);
}

void WritableHdf5File::close() {
  file_.close();
  check();
}

}  // namespace jostle::inline results
