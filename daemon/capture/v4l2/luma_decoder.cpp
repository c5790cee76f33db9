#include "daemon/capture/v4l2/luma_decoder.h"

#include <turbojpeg.h>

#include <algorithm>
#include <cstring>
#include <new>

namespace stereod {
namespace {

// Whether the picture is cut into pieces by restart markers: a segment DRI before the scan.
bool has_restarts(std::span<const std::uint8_t> jpeg) noexcept {
  constexpr std::uint8_t kRestartInterval = 0xdd, kScan = 0xda;
  for (std::size_t at = 2; at + 4 <= jpeg.size() && jpeg[at] == 0xff && jpeg[at + 1] != kScan;) {
    if (jpeg[at + 1] == kRestartInterval) return true;
    at += 2 + (static_cast<std::size_t>(jpeg[at + 2]) << 8 | jpeg[at + 3]);
  }
  return false;
}

// Some webcams put a few bytes too many before the end of every picture. libjpeg warns of that as of real
// damage, and keeps the first warning; if that is this one, it came after the whole picture, unless the end
// was found in a search for a restart marker.
bool only_too_long(tjhandle turbojpeg, std::span<const std::uint8_t> jpeg) noexcept {
  return tjGetErrorCode(turbojpeg) == TJERR_WARNING &&
         std::strstr(tjGetErrorStr2(turbojpeg), "extraneous bytes before marker 0xd9") != nullptr &&
         !has_restarts(jpeg);
}

}  // namespace

JpegLumaDecoder::JpegLumaDecoder() : turbojpeg_(tjInitDecompress()) {
  if (turbojpeg_ == nullptr) throw std::bad_alloc();
}

JpegLumaDecoder::~JpegLumaDecoder() { tjDestroy(turbojpeg_); }

// libjpeg keeps the Huffman tables it has seen, so a damaged picture could spoil all those after it that
// bring none of their own.
void JpegLumaDecoder::start_anew() noexcept {
  if (void* fresh = tjInitDecompress()) {
    tjDestroy(turbojpeg_);
    turbojpeg_ = fresh;
  }
}

bool JpegLumaDecoder::decode(std::span<const std::uint8_t> jpeg, ImageView<std::uint8_t> luma,
                             FrameDrop& drop) noexcept {
  if (jpeg.size() < 4 || jpeg[0] != 0xff || jpeg[1] != 0xd8 || jpeg[2] != 0xff) {
    drop = FrameDrop::kNoJpeg;
    return false;
  }
  const auto length = static_cast<unsigned long>(jpeg.size());
  int width = 0, height = 0, subsampling = 0, colorspace = 0;
  if (tjDecompressHeader3(turbojpeg_, jpeg.data(), length, &width, &height, &subsampling, &colorspace) != 0 ||
      (colorspace != TJCS_YCbCr && colorspace != TJCS_GRAY)) {
    drop = FrameDrop::kJpegDamaged;
    start_anew();
    return false;
  }
  if (Size{width, height} != luma.size()) {
    drop = FrameDrop::kJpegSize;
    return false;
  }
  // A progressive JPEG can have thousands of scans that decode to nothing; a camera's has one.
  constexpr int kFlags = TJFLAG_LIMITSCANS;
  const int status = tjDecompress2(turbojpeg_, jpeg.data(), length, luma.row(0), width,
                                   static_cast<int>(luma.stride()), height, TJPF_GRAY, kFlags);
  if (status != 0 && !only_too_long(turbojpeg_, jpeg)) {
    drop = FrameDrop::kJpegDamaged;
    start_anew();
    return false;
  }
  return true;
}

void scale_y10(const std::uint8_t* words, std::size_t stride, ImageView<std::uint8_t> luma) noexcept {
  for (int y = 0; y < luma.height(); ++y) {
    const std::uint8_t* in = words + static_cast<std::size_t>(y) * stride;
    std::uint8_t* out = luma.row(y);
    for (std::ptrdiff_t x = 0; x < luma.width(); ++x) {
      const int value = (in[2 * x] | in[2 * x + 1] << 8) >> 2;
      out[x] = static_cast<std::uint8_t>(std::min(value, 255));
    }
  }
}

}  // namespace stereod
