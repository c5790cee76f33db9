// SPDX-License-Identifier: BSD-3-Clause
// JPEG by libjpeg, and 10-bit luma.
#include "daemon/capture/v4l2/luma_decoder.h"

// jpeglib.h wants FILE and size_t before it.
#include <cstdio>

#include <jerror.h>
#include <jpeglib.h>

#include <algorithm>
#include <csetjmp>
#include <new>
#include <utility>

namespace stereod::v4l2 {

// libjpeg reports an error by calling a function that must not return. That function uses longjmp instead of
// an exception: on some architectures libjpeg is built without the unwind tables that an exception needs to
// pass through C. Between setjmp and longjmp there are only libjpeg's functions and variables without
// destructors.
struct JpegLumaDecoder::Libjpeg {
  jpeg_decompress_struct info{};
  jpeg_error_mgr errors{};
  std::jmp_buf failed{};
  bool created = false;
  bool damaged = false;

  Libjpeg() noexcept;
  ~Libjpeg() { jpeg_destroy_decompress(&info); }
  Libjpeg(const Libjpeg&) = delete;
  Libjpeg& operator=(const Libjpeg&) = delete;
};

namespace {

JpegLumaDecoder::Libjpeg& self(j_common_ptr info) {
  return *static_cast<JpegLumaDecoder::Libjpeg*>(info->client_data);
}

[[noreturn]] void leave(j_common_ptr info) { std::longjmp(self(info).failed, 1); }

// More extraneous bytes than this before a marker are not padding: the decoded image is wrong.
constexpr int kMaxPadding = 100;

// Returns true for warnings of libjpeg about images that are whole. Some webcams send a few extraneous bytes
// before the end of an image or before a restart marker. Everything has been decoded by then: missing data
// and missing markers have warnings of their own.
bool is_harmless(const jpeg_error_mgr& errors) {
  if (errors.msg_code == JWRN_JFIF_MAJOR)
    return true;  // a version number in the header; no decoding depends on it
  const int bytes = errors.msg_parm.i[0], marker = errors.msg_parm.i[1];
  return errors.msg_code == JWRN_EXTRANEOUS_DATA && bytes <= kMaxPadding &&
         (marker == JPEG_EOI || (marker >= JPEG_RST0 && marker <= JPEG_RST0 + 7));
}

void take_message(j_common_ptr info, int level) {
  if (level < 0 && !is_harmless(*info->err)) self(info).damaged = true;
}

void print_nothing(j_common_ptr) {}

bool is_luma_first(J_COLOR_SPACE space) { return space == JCS_YCbCr || space == JCS_GRAYSCALE; }

// Reads the header. A camera's image has one scan; the time to decode several is unbounded.
bool read_header(JpegLumaDecoder::Libjpeg& jpeg, std::span<const std::uint8_t> bytes) noexcept {
  if (setjmp(jpeg.failed) != 0) return false;
  jpeg_mem_src(&jpeg.info, bytes.data(), static_cast<unsigned long>(bytes.size()));
  return jpeg_read_header(&jpeg.info, TRUE) == JPEG_HEADER_OK && !jpeg.damaged &&
         is_luma_first(jpeg.info.jpeg_color_space) && jpeg_has_multiple_scans(&jpeg.info) == FALSE;
}

// Stops at the first damage.
bool read_luma(JpegLumaDecoder::Libjpeg& jpeg, ImageView<std::uint8_t> luma) noexcept {
  if (setjmp(jpeg.failed) != 0) return false;
  jpeg.info.out_color_space = JCS_GRAYSCALE;  // so that the chroma is not decoded
  jpeg_start_decompress(&jpeg.info);
  constexpr JDIMENSION kRows = 8;
  const auto height = static_cast<JDIMENSION>(luma.height());
  while (jpeg.info.output_scanline < height && !jpeg.damaged) {
    JSAMPROW rows[kRows];
    const JDIMENSION first = jpeg.info.output_scanline, count = std::min(kRows, height - first);
    for (JDIMENSION i = 0; i < count; ++i) rows[i] = luma.row(static_cast<int>(first + i));
    jpeg_read_scanlines(&jpeg.info, rows, count);
  }
  if (!jpeg.damaged) jpeg_finish_decompress(&jpeg.info);  // checks for the end marker
  return !jpeg.damaged;
}

}  // namespace

JpegLumaDecoder::Libjpeg::Libjpeg() noexcept {
  info.err = jpeg_std_error(&errors);
  info.client_data = this;
  errors.error_exit = leave;
  errors.emit_message = take_message;
  errors.output_message = print_nothing;
  if (setjmp(failed) != 0) return;  // out of memory
  jpeg_create_decompress(&info);
  created = true;
}

JpegLumaDecoder::JpegLumaDecoder() : jpeg_(std::make_unique<Libjpeg>()) {
  if (!jpeg_->created) throw std::bad_alloc();
}

JpegLumaDecoder::~JpegLumaDecoder() = default;

// libjpeg keeps Huffman tables from image to image: tables of a damaged image would spoil later images
// without tables.
void JpegLumaDecoder::reset() noexcept {
  std::unique_ptr<Libjpeg> fresh(new (std::nothrow) Libjpeg);
  if (fresh != nullptr && fresh->created) {
    jpeg_ = std::move(fresh);
  } else {
    jpeg_abort_decompress(&jpeg_->info);
  }
}

bool JpegLumaDecoder::decode(std::span<const std::uint8_t> jpeg, ImageView<std::uint8_t> luma,
                             FrameDrop& drop) noexcept {
  if (jpeg.size() < 4 || jpeg[0] != 0xff || jpeg[1] != 0xd8 || jpeg[2] != 0xff) {
    drop = FrameDrop::kNoJpeg;
    return false;
  }
  jpeg_->damaged = false;
  if (!read_header(*jpeg_, jpeg)) {
    drop = FrameDrop::kJpegDamaged;
    reset();
    return false;
  }
  const auto width = static_cast<JDIMENSION>(luma.width()), height = static_cast<JDIMENSION>(luma.height());
  if (jpeg_->info.image_width != width || jpeg_->info.image_height != height) {
    drop = FrameDrop::kJpegSize;
    jpeg_abort_decompress(&jpeg_->info);
    return false;
  }
  if (!read_luma(*jpeg_, luma)) {
    drop = FrameDrop::kJpegDamaged;
    reset();
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

}  // namespace stereod::v4l2
