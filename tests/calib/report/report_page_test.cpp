// SPDX-License-Identifier: BSD-3-Clause
// The report in a browser.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <set>
#include <string>

#include "calib/report/report.h"
#include "daemon/base/file.h"
#include "daemon/imagefile/read_image.h"
#include "tests/support/board_scene.h"
#include "tests/support/chromium.h"
#include "tests/support/temporary_directory.h"

namespace stereod::calib {
namespace {

using testing::HasSubstr;

// Describes what is visible on the loaded page.
constexpr const char* kLook = R"((async () => {
  while (document.readyState !== 'complete') await new Promise(done => setTimeout(done, 10));
  const seen = [];
  for (const image of document.querySelectorAll('image, img')) {
    const probe = new Image();
    probe.src = image.getAttribute('href') || image.getAttribute('src');
    try { await probe.decode(); } catch (error) { }
    const box = image.getBoundingClientRect();
    seen.push(`image ${probe.naturalWidth}x${probe.naturalHeight} ${box.width > 200 && box.height > 150 ? 'shown' : 'hidden'};`);
  }
  for (const map of document.querySelectorAll('svg.map')) {
    seen.push(`map ${map.getBoundingClientRect().width > 200 ? 'shown' : 'hidden'}, ${map.querySelectorAll('circle').length} corners;`);
  }
  for (const stat of document.querySelectorAll('.stat b')) seen.push(`stat ${stat.innerText.replace(/\s+/g, ' ')};`);
  seen.push(`verdict ${document.querySelector('h1').textContent};`);
  seen.push(`${document.querySelectorAll('table.pairs tr').length - 1} pairs;`);
  seen.push(`${document.querySelectorAll('table.depth tr').length - 1} depths;`);
  seen.push(document.documentElement.scrollWidth <= window.innerWidth ? 'fits;' : 'overflows;');
  return seen.join(' ');
})())";

TEST(Report, InBrowser_ImagesAndNumbers) {
  const auto program = Chromium::program();
  if (!program) GTEST_SKIP() << "the Debian package chromium is missing";
  const Board board{9, 6, 0.025};
  const StereoRigEstimate cameras = known_cameras({320, 240});
  const BoardScene scene(cameras, board);
  std::vector<ImagePair> images;
  for (const BoardPose& pose : varied_poses(board, 16)) {
    images.push_back(scene.render(pose, images.size()));
    images.back().name = "pair " + std::to_string(images.size());
  }
  const SolveResult result = solve(images, {board, board.square_m, LensChoice::kPinhole});
  const TemporaryDirectory directory;
  write_text_file(directory / "report.html", report_page(result, assess(result), images));

  Chromium browser(*program, directory.path());
  browser.open("file://" + (directory / "report.html").string(), 1100, 3400);
  const std::string seen = browser.evaluate(kLook);
  EXPECT_THAT(seen, HasSubstr("image 320x240 shown; image 320x240 shown; map"));
  const std::string corners = std::to_string(16 * 54);
  EXPECT_THAT(seen,
              HasSubstr("map shown, " + corners + " corners; map shown, " + corners + " corners; stat"));
  EXPECT_THAT(
      seen, testing::ContainsRegex("stat 0\\.[0-9][0-9] ?px; stat 0\\.[0-9][0-9] ?px; stat [0-9]+ ?%; stat"));
  EXPECT_THAT(seen, HasSubstr("verdict good;"));
  EXPECT_THAT(seen, HasSubstr("16 pairs; 5 depths; fits;"));

  const std::string shot = (directory / "shot.png").string();
  browser.screenshot(shot);
  if (const char* keep = std::getenv("STEREOD_KEEP_SCREENSHOT")) {
    std::filesystem::copy_file(shot, keep, std::filesystem::copy_options::overwrite_existing);
  }
  const GrayImage image = read_gray(shot);
  EXPECT_EQ(image.width(), 1100);
  // The two camera images have more shades than a page without them.
  std::set<std::uint8_t> shades;
  for (int y = 0; y < image.height(); ++y) shades.insert(image.row(y), image.row(y) + image.width());
  EXPECT_GT(shades.size(), 150U);
}

}  // namespace
}  // namespace stereod::calib
