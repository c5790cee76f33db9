// Writing a file as a whole or not at all.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace stereod {

/// Writes to a temporary file, which then replaces `file`, readable by all. Where `file` is a symbolic link,
/// what it points to is replaced and the link stays. Throws FileError; what was there before is then still
/// there.
void write_text_file(const std::filesystem::path& file, std::string_view text);

/// Throws FileError if a file of this name could not be written: its directory is not there, or it is a directory,
/// a device, or a link that leads nowhere. For asking before long work.
void require_writable(const std::filesystem::path& file);

/// Throws FileError if two names of `written` are of one file, or one is of a file of `read`, which would
/// overwrite what is read or was just written. Empty names do not matter.
void require_distinct(const std::vector<std::filesystem::path>& written,
                      const std::vector<std::filesystem::path>& read = {});

}  // namespace stereod
