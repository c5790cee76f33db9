// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/image_files.h"

#include <png.h>
#include <turbojpeg.h>

#include <fstream>
#include <iterator>
#include <stdexcept>

#include "daemon/base/file_error.h"

namespace stereod {

namespace {

int channels_of(PngKind kind) {
  switch (kind) {
    case PngKind::kGray:
    case PngKind::kPalette:
      return 1;
    case PngKind::kGrayAlpha:
      return 2;
    case PngKind::kRgb:
      return 3;
    case PngKind::kRgbAlpha:
      return 4;
  }
  return 0;
}

int color_type_of(PngKind kind) {
  switch (kind) {
    case PngKind::kGray:
      return PNG_COLOR_TYPE_GRAY;
    case PngKind::kPalette:
      return PNG_COLOR_TYPE_PALETTE;
    case PngKind::kGrayAlpha:
      return PNG_COLOR_TYPE_GRAY_ALPHA;
    case PngKind::kRgb:
      return PNG_COLOR_TYPE_RGB;
    case PngKind::kRgbAlpha:
      return PNG_COLOR_TYPE_RGB_ALPHA;
  }
  return 0;
}

void append(png_structp png, png_bytep from, std::size_t count) {
  auto* bytes = static_cast<Bytes*>(png_get_io_ptr(png));
  bytes->insert(bytes->end(), from, from + count);
}

void set_palette(png_structp png, png_infop info, int entries) {
  std::vector<png_color> palette;
  for (int i = 0; i < entries; ++i)
    palette.push_back({palette_color(i).r, palette_color(i).g, palette_color(i).b});
  png_set_PLTE(png, info, palette.data(), entries);
}

Bytes compress(Size size, const std::vector<int>& samples, int format, int subsampling, int flags) {
  const Bytes pixels(samples.begin(), samples.end());
  unsigned char* data = nullptr;
  unsigned long length = 0;
  tjhandle encoder = tjInitCompress();
  const int status = tjCompress2(encoder, pixels.data(), size.width, 0, size.height, format, &data, &length,
                                 subsampling, 95, flags);
  Bytes bytes(data, data + length);
  tjFree(data);
  tjDestroy(encoder);
  if (status != 0) throw std::runtime_error("tjCompress2 failed");
  return bytes;
}

}  // namespace

Rgb palette_color(int index) {
  return {static_cast<std::uint8_t>(7 * index + 3), static_cast<std::uint8_t>(250 - 11 * index),
          static_cast<std::uint8_t>(40 + 13 * index)};
}

// libpng's default error handler aborts the test.
Bytes make_png(PngKind kind, int depth, bool interlaced, Size size, const std::vector<int>& samples) {
  Bytes bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(png, &bytes, append, nullptr);
  png_set_IHDR(png, info, static_cast<png_uint_32>(size.width), static_cast<png_uint_32>(size.height), depth,
               color_type_of(kind), interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  if (kind == PngKind::kPalette) set_palette(png, info, 1 << depth);
  png_write_info(png, info);
  if (depth < 8) png_set_packing(png);
  const auto per_row = static_cast<std::size_t>(size.width * channels_of(kind));
  std::vector<Bytes> rows(static_cast<std::size_t>(size.height));
  std::vector<png_bytep> row_pointers;
  for (std::size_t y = 0; y < rows.size(); ++y) {
    for (std::size_t x = 0; x < per_row; ++x) {
      const int sample = samples.at(y * per_row + x);
      if (depth == 16) rows[y].push_back(static_cast<std::uint8_t>(sample >> 8));
      rows[y].push_back(static_cast<std::uint8_t>(sample & 255));
    }
    row_pointers.push_back(rows[y].data());
  }
  png_write_image(png, row_pointers.data());
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return bytes;
}

Bytes make_gray_jpeg(Size size, const std::vector<int>& samples, bool progressive) {
  return compress(size, samples, TJPF_GRAY, TJSAMP_GRAY, progressive ? TJFLAG_PROGRESSIVE : 0);
}

Bytes make_rgb_jpeg(Size size, const std::vector<int>& samples) {
  return compress(size, samples, TJPF_RGB, TJSAMP_444, 0);
}

Bytes make_cmyk_jpeg(Size size) {
  const std::vector<int> samples = some_samples(4 * size.width * size.height, 255);
  return compress(size, samples, TJPF_CMYK, TJSAMP_444, 0);
}

Bytes make_raw_pnm(const std::string& header, const std::vector<int>& samples, bool wide) {
  Bytes bytes = bytes_of(header);
  for (const int sample : samples) {
    if (wide) bytes.push_back(static_cast<std::uint8_t>(sample >> 8));
    bytes.push_back(static_cast<std::uint8_t>(sample & 255));
  }
  return bytes;
}

std::vector<int> some_samples(int count, int max) {
  std::vector<int> samples;
  std::uint32_t state = 12345;
  for (int i = 0; i < count; ++i) {
    state = state * 1664525 + 1013904223;
    samples.push_back(static_cast<int>((state >> 8) % (static_cast<std::uint32_t>(max) + 1)));
  }
  return samples;
}

Bytes bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

Bytes bytes_in(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write_bytes(const std::filesystem::path& path, const Bytes& bytes) {
  std::ofstream out(path, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

std::string file_error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const FileError& error) {
    return error.what();
  }
  return {};
}

}  // namespace stereod
