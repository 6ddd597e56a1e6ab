#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

// How a file comes to be, whole or not at all: written under a temporary name, fsynced, renamed,
// and the folder fsynced. All throw ResultsError.
namespace jostle::inline results {

/// The fate of a file that has the name already when the new one gets it. A file that is kept
/// refuses the new one: refuse_existing().
enum class ExistingFile { replaced, kept };
/// Throws the ResultsError of a file that is kept.

[[noreturn]] void refuse_existing(const std::string& path);

/// Publishes the bytes under `path`, but never in place of a link, which is refused (output_path).
/// On failure what was there stays.
void publish(const std::string& path, std::span<const std::byte> bytes,
             ExistingFile existing = ExistingFile::replaced);

/// All bytes to a descriptor that is open on `path`, whatever interrupts or shortens a write.
void write_all(const std::string& path, int descriptor, std::span<const std::byte> bytes);

/// Target of symbolic links at `path`, for reading; the path itself without a link. Outputs use
/// output_path().
std::string end_of_links(const std::string& path);

/// Refuses to replace what is no file, and a file that is write-protected; what is not there may
/// come to be.
void require_replaceable_file(const std::string& path);

/// The folder that a path names a file in.
std::string folder_of(const std::string& path);

/// Removes a file if it is there.
void remove_file(const std::string& path);

/// Makes renames and removals in the folder of `path` durable.
void sync_folder_of(const std::string& path);

/// Throws if the file system below `path` has fewer free bytes than needed, with the `advice`.
void require_free_space(const std::string& path, std::uint64_t bytes,
                        const char* advice = "free some space or write elsewhere");

/// Throws ResultsError for a failed system call: "cannot `operation`: " and the system's reason,
/// with the way out where there is one.
[[noreturn]] void fail_on_disk(const std::string& path, const char* operation, int error);

}  // namespace jostle::inline results
