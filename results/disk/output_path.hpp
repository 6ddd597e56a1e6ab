#pragma once

#include <cstddef>
#include <span>
#include <string>

// Every file and folder that the program writes is reached through these. In folders where others
// may write, they may have put a link at a name of ours, or on the way to it, to have something
// else written over.
namespace jostle::inline results {

/// Returns where a write to `path` goes: where symbolic links at its end lead, or the path itself.
/// Throws ResultsError for a link, at the end or on the way, that another user may have put there,
/// and for such a pipe or device at the end. Trusted are links of this user; links in a folder
/// where its owner alone may write; and on the way, where a group may write too, links of root and
/// link of the folder's owner. The kernel (fs.protected_symlinks) refuses fewer: those in sticky
/// folders.
std::string output_path(const std::string& path);

/// Who may write to a folder beside its owner.
enum class Writers { everybody, a_group_or_everybody };

/// True if another user may have created the file at `path`: it belongs to another user, in a
/// folder where others may write.
bool may_be_planted(const std::string& path, Writers writers);

/// Makes a folder, if there is none. Throws ResultsError.
void make_folder(const std::string& path);

/// Writes a file that must not be there yet, in place. Throws ResultsError.
void write_new_file(const std::string& path, std::span<const std::byte> bytes);

}  // namespace jostle::inline results
