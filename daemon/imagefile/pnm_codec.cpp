// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/imagefile/pnm_codec.h"

#include "daemon/base/file_error.h"

namespace stereod {

namespace {

bool is_space(std::uint8_t byte) { return byte == ' ' || (byte >= '\t' && byte <= '\r'); }
bool is_digit(std::uint8_t byte) { return byte >= '0' && byte <= '9'; }

/// Parses a PNM file from front to end.
class PnmParser {
 public:
  PnmParser(const std::string& file, std::span<const std::uint8_t> bytes) : file_(file), bytes_(bytes) {
    kind_ = bytes_[1] - '0';
    next_ = 2;
  }

  DecodedImage image() {
    const long width = number("width");
    const long height = number("height");
    check_image_size(file_, width, height);
    const long max_value = number("maxval");
    if (max_value < 1 || max_value > 65535) {
      throw FileError(file_ + ": the maxval is " + std::to_string(max_value) + "; 1 to 65535 is allowed");
    }
    const bool color = kind_ == 3 || kind_ == 6;
    const bool plain = kind_ == 2 || kind_ == 3;
    // Nothing is allocated for an image that the file cannot hold. A plain sample takes at least two bytes.
    const std::size_t min_bytes = static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                                  (color ? 3 : 1) * (plain || max_value > 255 ? 2 : 1);
    if (bytes_.size() - next_ < min_bytes) throw_truncated();

    DecodedImage result({static_cast<int>(width), static_cast<int>(height)}, color ? 3 : 1,
                        static_cast<int>(max_value));
    const std::size_t samples = result.samples.size() / static_cast<std::size_t>(result.sample_bytes);
    for (std::size_t i = 0; i < samples; ++i) {
      const long value = plain ? number("pixel value") : raw_value(result.sample_bytes);
      if (value > max_value) {
        throw FileError(file_ + ": a pixel has the value " + std::to_string(value) + ", above the maxval " +
                        std::to_string(max_value));
      }
      result.set_sample(i, static_cast<int>(value));
    }
    return result;
  }

 private:
  /// Returns the next number of the text and skips it and the white-space character that must follow it.
  long number(const char* what) {
    skip_space_and_comments();
    if (next_ == bytes_.size()) throw_truncated();
    if (!is_digit(bytes_[next_])) {
      throw FileError(file_ + ": the " + what + " is not a number");
    }
    long value = 0;
    for (; next_ < bytes_.size() && is_digit(bytes_[next_]); ++next_) {
      value = value * 10 + (bytes_[next_] - '0');
      if (value > 100'000'000) throw FileError(file_ + ": the " + what + " is above 100000000");
    }
    if (next_ < bytes_.size() && bytes_[next_] == '#') skip_comment();
    if (next_ == bytes_.size()) throw_truncated();
    if (!is_space(bytes_[next_])) throw FileError(file_ + ": the " + what + " is not a number");
    ++next_;
    return value;
  }

  long raw_value(int sample_bytes) {
    if (sample_bytes == 1) return bytes_[next_++];
    const long value = bytes_[next_] * 256L + bytes_[next_ + 1];
    next_ += 2;
    return value;
  }

  void skip_space_and_comments() {
    while (next_ < bytes_.size() && (is_space(bytes_[next_]) || bytes_[next_] == '#')) {
      if (bytes_[next_] == '#') {
        skip_comment();
      } else {
        ++next_;
      }
    }
  }

  void skip_comment() {
    while (next_ < bytes_.size() && bytes_[next_] != '\n' && bytes_[next_] != '\r') ++next_;
  }

  [[noreturn]] void throw_truncated() const {
    throw FileError(file_ + ": the " + (kind_ == 2 || kind_ == 5 ? "PGM" : "PPM") +
                    " file is truncated; it ends before its image does");
  }

  const std::string& file_;
  std::span<const std::uint8_t> bytes_;
  std::size_t next_ = 0;
  int kind_ = 0;  // the digit in "P5"
};

}  // namespace

bool looks_like_pnm(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= 3 && bytes[0] == 'P' &&
         (bytes[1] == '2' || bytes[1] == '3' || bytes[1] == '5' || bytes[1] == '6') &&
         (is_space(bytes[2]) || bytes[2] == '#');
}

DecodedImage decode_pnm(const std::string& file, std::span<const std::uint8_t> bytes) {
  return PnmParser(file, bytes).image();
}

}  // namespace stereod
