// Whole files in and out of memory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace stereod {

/// All bytes of a regular file of at most 1 GiB, at least one. Throws FileError: the file does not exist, is
/// a directory or a device, may not be read, is empty or larger.
std::vector<std::uint8_t> read_file_bytes(const std::filesystem::path& path);

/// Makes `bytes` the content of the file. They go to a temporary beside it, which then takes its name: a
/// reader sees the old file or the new one, never half of one. Throws FileError if that fails or if the path
/// names something that is no regular file (renaming would replace a device).
void write_file_bytes(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);

}  // namespace stereod
