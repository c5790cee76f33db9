// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/imagefile/png_codec.h"

#include <png.h>

#include <bit>
#include <csetjmp>
#include <cstring>
#include <new>

#include "daemon/base/file_error.h"

namespace stereod {

namespace {

/// State of libpng's callbacks. Without destructors, because libpng leaves the callbacks by longjmp.
struct ReadState {
  const std::uint8_t* next = nullptr;
  std::size_t left = 0;
  bool ran_out = false;
  char message[160] = {};
};

struct WriteState {
  std::vector<std::uint8_t>* bytes = nullptr;
  char message[160] = {};
};

template <typename State>
void on_error(png_structp png, png_const_charp message) {
  auto* state = static_cast<State*>(png_get_error_ptr(png));
  std::strncpy(state->message, message, sizeof state->message - 1);
  png_longjmp(png, 1);
}

void on_warning(png_structp /*png*/, png_const_charp /*message*/) {}

void on_read(png_structp png, png_bytep to, std::size_t count) {
  auto* state = static_cast<ReadState*>(png_get_io_ptr(png));
  if (count > state->left) {
    state->ran_out = true;
    png_error(png, "the file ends too early");
  }
  std::memcpy(to, state->next, count);
  state->next += count;
  state->left -= count;
}

void on_write(png_structp png, png_bytep from, std::size_t count) {
  auto* state = static_cast<WriteState*>(png_get_io_ptr(png));
  bool stored = true;
  try {
    state->bytes->insert(state->bytes->end(), from, from + count);
  } catch (...) {
    stored = false;  // an exception must not pass through libpng
  }
  if (!stored) png_error(png, "out of memory");
}

void on_flush(png_structp /*png*/) {}

/// Runs @p steps, which calls libpng and creates no object with a destructor. Returns false if libpng failed.
template <typename Steps>
bool run_guarded(png_structp png, const Steps& steps) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  steps();
  return true;
}

/// Owns libpng's two structures for reading.
class PngReader {
 public:
  explicit PngReader(ReadState& state)
      : png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, &state, on_error<ReadState>, on_warning)),
        info_(png_ != nullptr ? png_create_info_struct(png_) : nullptr) {
    if (info_ == nullptr) {
      png_destroy_read_struct(&png_, nullptr, nullptr);
      throw std::bad_alloc();
    }
    png_set_read_fn(png_, &state, on_read);
    // check_image_size() checks the size, with an error that names the limits.
    png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
  }
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  bool read_header() {
    return run_guarded(png_, [&] { png_read_info(png_, info_); });
  }

  /// Selects conversions to what DecodedImage can hold. Call after read_header().
  bool choose_layout() {
    return run_guarded(png_, [&] {
      if (png_get_color_type(png_, info_) == PNG_COLOR_TYPE_PALETTE) png_set_palette_to_rgb(png_);
      png_set_packing(png_);
      png_set_strip_alpha(png_);
      if constexpr (std::endian::native == std::endian::little) png_set_swap(png_);
      png_set_interlace_handling(png_);
      depth_in_file_ = png_get_bit_depth(png_, info_);
      png_read_update_info(png_, info_);
    });
  }

  bool read_rows(std::vector<png_bytep>& rows) {
    return run_guarded(png_, [&] {
      png_read_image(png_, rows.data());
      png_read_end(png_, nullptr);
    });
  }

  long long width() const { return png_get_image_width(png_, info_); }
  long long height() const { return png_get_image_height(png_, info_); }
  /// Returns the size of a row as in the file; after choose_layout() as in DecodedImage.
  std::size_t row_bytes() const { return png_get_rowbytes(png_, info_); }
  int channels() const { return png_get_channels(png_, info_); }
  int max_value() const {
    // Gray of fewer than 8 bits keeps its small values; the colors of a palette always have 8 bits.
    return channels() == 1 ? (1 << depth_in_file_) - 1 : (1 << png_get_bit_depth(png_, info_)) - 1;
  }

 private:
  png_structp png_;
  png_infop info_;
  int depth_in_file_ = 8;
};

[[noreturn]] void throw_read_error(const std::string& file, const ReadState& state) {
  if (state.ran_out) throw FileError(file + ": the PNG file is truncated; it ends before its image does");
  throw FileError(file + ": the PNG file is damaged (libpng: " + state.message + ")");
}

class PngWriter {
 public:
  explicit PngWriter(WriteState& state)
      : png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, &state, on_error<WriteState>, on_warning)),
        info_(png_ != nullptr ? png_create_info_struct(png_) : nullptr) {
    if (info_ == nullptr) {
      png_destroy_write_struct(&png_, nullptr);
      throw std::bad_alloc();
    }
    png_set_write_fn(png_, &state, on_write, on_flush);
  }
  ~PngWriter() { png_destroy_write_struct(&png_, &info_); }
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;

  bool write(Size size, int depth, int color_type, std::vector<png_bytep>& rows) {
    return run_guarded(png_, [&] {
      png_set_IHDR(png_, info_, static_cast<png_uint_32>(size.width), static_cast<png_uint_32>(size.height),
                   depth, color_type, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                   PNG_FILTER_TYPE_DEFAULT);
      // Level 3 is several times as fast as the default, and its files are hardly larger for photographs.
      png_set_compression_level(png_, 3);
      png_write_info(png_, info_);
      if (depth == 16 && std::endian::native == std::endian::little) png_set_swap(png_);
      png_write_image(png_, rows.data());
      png_write_end(png_, nullptr);
    });
  }

 private:
  png_structp png_;
  png_infop info_;
};

template <typename Pixel>
std::vector<std::uint8_t> encode(const std::string& file, ImageView<const Pixel> image, int depth,
                                 int color_type) {
  check_image_size(file, image.width(), image.height());
  std::vector<png_bytep> rows;
  rows.reserve(static_cast<std::size_t>(image.height()));
  for (int y = 0; y < image.height(); ++y) {
    // libpng only reads the rows, but its type lacks const.
    rows.push_back(reinterpret_cast<png_bytep>(const_cast<Pixel*>(image.row(y))));
  }
  std::vector<std::uint8_t> bytes;
  WriteState state;
  state.bytes = &bytes;
  PngWriter writer(state);
  if (!writer.write(image.size(), depth, color_type, rows)) {
    throw FileError(file + ": the image cannot be written as PNG (libpng: " + state.message + ")");
  }
  return bytes;
}

}  // namespace

bool looks_like_png(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= 8 && png_sig_cmp(bytes.data(), 0, 8) == 0;
}

DecodedImage decode_png(const std::string& file, std::span<const std::uint8_t> bytes) {
  ReadState state;
  state.next = bytes.data();
  state.left = bytes.size();
  PngReader reader(state);
  if (!reader.read_header()) throw_read_error(file, state);
  check_image_size(file, reader.width(), reader.height());
  // Deflate compresses to 1/1032 at best, so a file whose header announces more is truncated. Nothing is allocated for it.
  if (reader.row_bytes() * static_cast<std::size_t>(reader.height()) / 1100 > bytes.size()) {
    state.ran_out = true;
    throw_read_error(file, state);
  }
  if (!reader.choose_layout()) throw_read_error(file, state);

  const Size size{static_cast<int>(reader.width()), static_cast<int>(reader.height())};
  DecodedImage image(size, reader.channels(), reader.max_value());
  if (reader.row_bytes() != image.row_bytes()) {
    throw FileError(file + ": the PNG file has a pixel layout that is not supported");
  }
  std::vector<png_bytep> rows;
  rows.reserve(static_cast<std::size_t>(size.height));
  for (int y = 0; y < size.height; ++y) {
    rows.push_back(image.samples.data() + static_cast<std::size_t>(y) * image.row_bytes());
  }
  if (!reader.read_rows(rows)) throw_read_error(file, state);
  return image;
}

std::vector<std::uint8_t> encode_png(const std::string& file, ImageView<const std::uint8_t> gray) {
  return encode(file, gray, 8, PNG_COLOR_TYPE_GRAY);
}

std::vector<std::uint8_t> encode_png(const std::string& file, ImageView<const Rgb> color) {
  return encode(file, color, 8, PNG_COLOR_TYPE_RGB);
}

std::vector<std::uint8_t> encode_png(const std::string& file, ImageView<const std::uint16_t> gray) {
  return encode(file, gray, 16, PNG_COLOR_TYPE_GRAY);
}

}  // namespace stereod
