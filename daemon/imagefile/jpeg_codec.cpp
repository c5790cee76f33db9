// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/imagefile/jpeg_codec.h"

#include <turbojpeg.h>

#include <memory>
#include <new>
#include <type_traits>

#include "daemon/base/file_error.h"

namespace stereod {

namespace {

struct DestroyDecoder {
  void operator()(void* decoder) const { tjDestroy(decoder); }
};
using Decoder = std::unique_ptr<std::remove_pointer_t<tjhandle>, DestroyDecoder>;

[[noreturn]] void throw_damaged(const std::string& file, const Decoder& decoder) {
  throw FileError(file +
                  ": the JPEG file is damaged or truncated (libjpeg: " + tjGetErrorStr2(decoder.get()) + ")");
}

}  // namespace

bool looks_like_jpeg(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= 3 && bytes[0] == 0xff && bytes[1] == 0xd8 && bytes[2] == 0xff;
}

DecodedImage decode_jpeg(const std::string& file, std::span<const std::uint8_t> bytes,
                         JpegChannels channels) {
  const Decoder decoder(tjInitDecompress());
  if (decoder == nullptr) throw std::bad_alloc();
  const auto length = static_cast<unsigned long>(bytes.size());
  int width = 0;
  int height = 0;
  int subsampling = 0;
  int colorspace = 0;
  if (tjDecompressHeader3(decoder.get(), bytes.data(), length, &width, &height, &subsampling, &colorspace) !=
      0) {
    throw_damaged(file, decoder);
  }
  check_image_size(file, width, height);
  if (colorspace == TJCS_CMYK || colorspace == TJCS_YCCK) {
    throw FileError(file + ": is a CMYK JPEG; only gray and RGB JPEGs are read");
  }
  const bool luma = channels == JpegChannels::kLuma;
  DecodedImage image({width, height}, luma ? 1 : 3, 255);
  // A hostile file may have thousands of empty progressive scans; libjpeg stops at 500.
  constexpr int kFlags = TJFLAG_LIMITSCANS;
  if (tjDecompress2(decoder.get(), bytes.data(), length, image.samples.data(), width, 0, height,
                    luma ? TJPF_GRAY : TJPF_RGB, kFlags) != 0) {
    throw_damaged(file, decoder);
  }
  return image;
}

}  // namespace stereod
