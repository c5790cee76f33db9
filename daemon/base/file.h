// SPDX-License-Identifier: BSD-3-Clause
// Reads and writes whole files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/file_error.h"

namespace stereod {

/// Maximum size of a file that is read into memory [bytes].
inline constexpr std::size_t kMaxFileBytes = std::size_t{1} << 30;

/// Returns all bytes of a regular file of 1…@p max_bytes bytes. Never blocks on a pipe or a device.
/// @throws FileError if the file is missing, unreadable, empty, too large, or not a regular file.
std::vector<std::uint8_t> read_file_bytes(const std::filesystem::path& path,
                                          std::size_t max_bytes = kMaxFileBytes);

/// Returns the text of a regular file of 0…@p max_bytes bytes. Throws as read_file_bytes() does, but accepts an
/// empty file.
std::string read_text_file(const std::filesystem::path& path, std::size_t max_bytes);

/// Replaces the content of @p path by @p bytes, as a whole or not at all.
///
/// Writes a temporary file in the same directory, flushes it to the disk and renames it, so that a reader, or the
/// next start after a power cut, finds the old content or the new. A symbolic link stays; the file it leads to is
/// replaced. The mode is that of the old file, or 0644 less the umask.
/// @throws FileError if that fails, or if @p path names a directory, device, pipe or socket. The old content stays.
void write_file_bytes(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);

/// Does the same with @p text.
void write_text_file(const std::filesystem::path& path, std::string_view text);

/// Throws the FileError with which writing @p path would fail now, as far as that can be known without writing. Call
/// it before long work.
void require_writable(const std::filesystem::path& path);

/// Throws FileError if two paths of @p written name the same file, or one of them names a file of @p read. Links are
/// followed; empty paths are ignored.
void require_distinct(const std::vector<std::filesystem::path>& written,
                      const std::vector<std::filesystem::path>& read = {});

}  // namespace stereod
