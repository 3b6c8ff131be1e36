#pragma once

#include <filesystem>
#include <string>

namespace unfurl {

// The directory that results go to, made where it is missing. Throws FileError before any work is done: the
// path is a file, cannot be made or written to, or holds files of somebody else and `force` was not given.
std::filesystem::path open_output_directory(const std::string& path, bool force);

// Throws FileError, naming the file, where it could not be written now: no such directory, no permission,
// disk full.
void require_writable(const std::filesystem::path& file);

// Remove what an earlier run left under the names that this program uses, so that no frame of it stays among
// ours.
void clear_old_results(const std::filesystem::path& directory);

}  // namespace unfurl
