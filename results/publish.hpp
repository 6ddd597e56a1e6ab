#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

// How a file comes to be, whole or not at all: written under a temporary name, fsynced, renamed,
// and the folder fsynced. All throw ResultsError.
namespace jostle {

/// The temporary name of a file; a stale one is overwritten by the next attempt.
std::string temporary_name(const std::string& path);

/// Publishes the bytes under `path`, replacing what was there. On failure what was there stays.
void publish(const std::string& path, std::span<const std::byte> bytes);

/// The last steps for a file already written under temporary_name(path).
void publish_temporary(const std::string& path);

/// Removes a file if it is there.
void remove_file(const std::string& path);

/// Makes renames and removals in the folder of `path` durable.
void sync_folder_of(const std::string& path);

/// Throws if the file system below `path` has fewer free bytes than needed, with the `advice`.
void require_free_space(const std::string& path, std::uint64_t bytes,
                        const char* advice = "free some space or write elsewhere");

/// Throws ResultsError for a failed system call: "cannot `what`: " and the system's reason, with
/// the way out where there is one.
[[noreturn]] void fail_on_disk(const std::string& path, const char* what, int error);

}  // namespace jostle
