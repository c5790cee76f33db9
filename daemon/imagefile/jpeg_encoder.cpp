#include "daemon/imagefile/jpeg_encoder.h"

#include <turbojpeg.h>

#include <new>

namespace stereod {

JpegEncoder::JpegEncoder(Size size, int quality)
    : turbo_(tjInitCompress()), quality_(quality), bytes_(tjBufSize(size.width, size.height, TJSAMP_GRAY)) {
  if (turbo_ == nullptr) throw std::bad_alloc();
}

JpegEncoder::~JpegEncoder() { tjDestroy(turbo_); }

std::span<const std::uint8_t> JpegEncoder::encode(GrayView picture) noexcept {
  unsigned char* out = bytes_.data();
  unsigned long size = bytes_.size();
  const int result =
      tjCompress2(turbo_, picture.row(0), picture.width(), static_cast<int>(picture.stride()),
                  picture.height(), TJPF_GRAY, &out, &size, TJSAMP_GRAY, quality_, TJFLAG_NOREALLOC);
  if (result != 0) return {};
  return {bytes_.data(), size};
}

}  // namespace stereod
