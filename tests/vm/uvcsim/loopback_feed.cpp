// SPDX-License-Identifier: BSD-3-Clause
// loopback-feed: plays known stereo pairs as YUYV or RGB through two v4l2loopback devices, and writes them as
// files for comparison.
#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "tests/vm/uvcsim/scene.h"

namespace stereod::uvcsim {
namespace {

constexpr Size kSize{640, 480};

void write_pgm(const std::string& path, const GrayImage& image) {
  std::ofstream file(path, std::ios::binary);
  file << "P5\n" << image.width() << ' ' << image.height() << "\n255\n";
  for (int y = 0; y < image.height(); ++y) {
    file.write(reinterpret_cast<const char*>(image.row(y)), image.width());
  }
  if (!file.flush()) throw std::runtime_error(path + ": cannot be written");
}

/// Writes pair-0-left.pgm, pair-0-right.pgm and so on.
void write_pairs(const std::string& directory) {
  for (int frame = 0; frame < kSceneFrames; ++frame) {
    const std::string start = directory + "/pair-" + std::to_string(frame);
    write_pgm(start + "-left.pgm", render_scene(Eye::kLeft, kSize, frame));
    write_pgm(start + "-right.pgm", render_scene(Eye::kRight, kSize, frame));
  }
}

Bytes rgb_bytes(const GrayImage& image) {
  Bytes bytes;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) bytes.insert(bytes.end(), 3, image.row(y)[x]);
  }
  return bytes;
}

int open_output(const std::string& device, bool rgb) {
  const std::uint32_t bytes_per_pixel = rgb ? 3 : 2;
  const int file = ::open(device.c_str(), O_RDWR | O_CLOEXEC);
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
  format.fmt.pix.width = kSize.width;
  format.fmt.pix.height = kSize.height;
  format.fmt.pix.pixelformat = rgb ? V4L2_PIX_FMT_RGB24 : V4L2_PIX_FMT_YUYV;
  format.fmt.pix.field = V4L2_FIELD_NONE;
  format.fmt.pix.bytesperline = kSize.width * bytes_per_pixel;
  format.fmt.pix.sizeimage = kSize.width * kSize.height * bytes_per_pixel;
  if (file < 0 || ::ioctl(file, VIDIOC_S_FMT, &format) != 0) {
    throw std::system_error(errno, std::generic_category(), device);
  }
  return file;
}

[[noreturn]] void feed(const std::array<std::string, 2>& devices, double fps, bool rgb) {
  std::array<std::vector<Bytes>, 2> images;
  std::array<int, 2> files{};
  for (std::size_t side = 0; side < 2; ++side) {
    files[side] = open_output(devices[side], rgb);
    for (int frame = 0; frame < kSceneFrames; ++frame) {
      const GrayImage image = render_scene(side == 0 ? Eye::kLeft : Eye::kRight, kSize, frame);
      images[side].push_back(rgb ? rgb_bytes(image) : yuyv_bytes(image));
    }
  }
  auto next = std::chrono::steady_clock::now();
  for (std::size_t frame = 0;; ++frame) {
    for (std::size_t side = 0; side < 2; ++side) {
      const Bytes& bytes = images[side][frame % kSceneFrames];
      if (::write(files[side], bytes.data(), bytes.size()) < 0) {
        throw std::system_error(errno, std::generic_category(), devices[side]);
      }
    }
    next += std::chrono::microseconds(static_cast<std::int64_t>(1e6 / fps));
    std::this_thread::sleep_until(next);
  }
}

int main_with(int argc, char** argv) {
  CLI::App app("loopback-feed: known stereo pairs through two v4l2loopback devices.");
  std::array<std::string, 2> devices;
  std::string directory;
  double fps = 5;
  bool rgb = false;
  app.add_option("--left", devices[0], "device of the left images")->required();
  app.add_option("--right", devices[1], "device of the right images")->required();
  app.add_option("--pairs", directory, "existing directory for the pairs as files")->required();
  app.add_option("--fps", fps, "pairs a second")->check(CLI::Range(0.1, 120.0));
  app.add_flag("--rgb", rgb, "RGB instead of YUYV");
  CLI11_PARSE(app, argc, argv);
  write_pairs(directory);
  feed(devices, fps, rgb);
}

}  // namespace
}  // namespace stereod::uvcsim

int main(int argc, char** argv) {
  try {
    return stereod::uvcsim::main_with(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "loopback-feed: %s\n", error.what());
    return 1;
  }
}
