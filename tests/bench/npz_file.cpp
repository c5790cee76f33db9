// SPDX-License-Identifier: BSD-3-Clause
// Reading the first array of an .npz file.
#include "tests/bench/npz_file.h"

#include <zlib.h>

#include <bit>
#include <cstring>
#include <regex>
#include <string>
#include <vector>

#include "daemon/base/file.h"
#include "daemon/base/file_error.h"

namespace stereod::bench {
namespace {

static_assert(std::endian::native == std::endian::little);

using Bytes = std::vector<std::uint8_t>;

std::size_t number_at(const Bytes& bytes, std::size_t place) {
  return place + 1 < bytes.size() ? bytes[place] + std::size_t{256} * bytes[place + 1] : 0;
}

/// Returns the first file of a ZIP archive, at most @p max_bytes; empty if it is damaged or not deflated.
Bytes inflate_first(Bytes zip, std::size_t max_bytes) {
  const std::size_t start = 30 + number_at(zip, 26) + number_at(zip, 28);
  constexpr std::size_t kDeflated = 8;
  if (start >= zip.size() || std::memcmp(zip.data(), "PK\3\4", 4) != 0 || number_at(zip, 8) != kDeflated) {
    return {};
  }
  Bytes plain(max_bytes);
  z_stream stream{};
  stream.next_in = zip.data() + start;
  stream.avail_in = static_cast<uInt>(zip.size() - start);
  stream.next_out = plain.data();
  stream.avail_out = static_cast<uInt>(plain.size());
  if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) return {};
  const bool whole = inflate(&stream, Z_FINISH) == Z_STREAM_END;
  plain.resize(whole ? stream.total_out : 0);
  inflateEnd(&stream);
  return plain;
}

}  // namespace

Image<float> read_npz_floats(const std::filesystem::path& path) {
  constexpr std::size_t kMax = 64'000'000;
  constexpr std::size_t kPreamble = 10;  // magic, version 1.0, length of the header
  const Bytes npy = inflate_first(read_file_bytes(path), kMax);
  const std::size_t data = kPreamble + number_at(npy, 8);
  if (data > npy.size()) throw FileError(path.string() + ": holds no deflated array");

  const std::string header(npy.begin() + kPreamble, npy.begin() + static_cast<std::ptrdiff_t>(data));
  const std::regex wanted(
      "'descr': '<f4', 'fortran_order': False, 'shape': \\(([0-9]{1,4}), ([0-9]{1,4})\\)");
  std::smatch shape;
  if (!std::regex_search(header, shape, wanted)) {
    throw FileError(path.string() + ": its first array is not an image of 32-bit floats");
  }
  Image<float> image(std::stoi(shape[2]), std::stoi(shape[1]));
  const std::size_t row_bytes = static_cast<std::size_t>(image.width()) * sizeof(float);
  if (npy.size() - data != row_bytes * static_cast<std::size_t>(image.height())) {
    throw FileError(path.string() + ": its first array has not the size that it claims");
  }
  for (int y = 0; y < image.height(); ++y) {
    std::memcpy(image.row(y), npy.data() + data + row_bytes * static_cast<std::size_t>(y), row_bytes);
  }
  return image;
}

}  // namespace stereod::bench
