// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/imagefile/jpeg_encoder.h"

#include <turbojpeg.h>

#include <new>

namespace stereod {

JpegEncoder::JpegEncoder(Size size, int quality)
    : turbo_(tjInitCompress()), quality_(quality), bytes_(tjBufSize(size.width, size.height, TJSAMP_GRAY)) {
  if (turbo_ == nullptr) throw std::bad_alloc();
}

JpegEncoder::~JpegEncoder() { tjDestroy(turbo_); }

std::span<const std::uint8_t> JpegEncoder::encode(GrayView image) noexcept {
  unsigned char* out = bytes_.data();
  unsigned long size = bytes_.size();
  const int result =
      tjCompress2(turbo_, image.row(0), image.width(), static_cast<int>(image.stride()), image.height(),
                  TJPF_GRAY, &out, &size, TJSAMP_GRAY, quality_, TJFLAG_NOREALLOC);
  if (result != 0) return {};
  return {bytes_.data(), size};
}

}  // namespace stereod
