// SPDX-License-Identifier: BSD-3-Clause
// The report in a browser.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <set>
#include <string>

#include "calib/report/report.h"
#include "daemon/base/text_file.h"
#include "daemon/imagefile/read_image.h"
#include "tests/support/board_scene.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_directory.h"

namespace stereod::calib {
namespace {

using testing::HasSubstr;

// Appends a text to the page that describes what is visible.
constexpr const char* kLook = R"(<script>
(async () => {
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
  const paragraph = document.createElement('pre');
  paragraph.textContent = 'SEEN ' + seen.join(' ');
  document.body.append(paragraph);
})();
</script>)";

class Browser {
 public:
  static bool is_there() { return std::system("command -v chromium >/dev/null 2>&1") == 0; }
  explicit Browser(const TemporaryDirectory& directory) : directory_(directory) {}

  // Runs the page for `time_ms` of virtual time, which advances while the page is idle; decoding images does not
  // advance it.
  ProgramRun run(std::vector<std::string> more, const std::string& page, int time_ms = 10'000) const {
    std::vector<std::string> arguments{"--headless",
                                       "--no-sandbox",
                                       "--disable-gpu",
                                       "--disable-dev-shm-usage",
                                       "--window-size=1100,3400",
                                       "--virtual-time-budget=" + std::to_string(time_ms),
                                       "--user-data-dir=" + (directory_ / "profile").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    arguments.push_back("file://" + (directory_ / page).string());
    return run_program("/usr/bin/chromium", arguments, directory_.path());
  }

 private:
  const TemporaryDirectory& directory_;
};

TEST(Report, InBrowser_ImagesAndNumbers) {
  if (!Browser::is_there()) GTEST_SKIP() << "the Debian package chromium is not here";
  const Board board{9, 6, 0.025};
  const StereoRigEstimate cameras = known_cameras({320, 240});
  const BoardScene scene(cameras, board);
  std::vector<ImagePair> images;
  for (const BoardPose& pose : varied_poses(board, 16)) {
    images.push_back(scene.render(pose, images.size()));
    images.back().name = "pair " + std::to_string(images.size());
  }
  const SolveResult result = solve(images, {board, board.square_m, LensChoice::kPinhole});
  const std::string page = report_page(result, assess(result), images);
  TemporaryDirectory directory;
  write_text_file(directory / "report.html", page);
  std::string looked_at = page;
  looked_at.insert(looked_at.find("</body>"), kLook);
  write_text_file(directory / "looked_at.html", looked_at);

  const Browser browser(directory);
  // On a busy machine the virtual time can end before the images are decoded.
  ProgramRun dump;
  std::size_t begin = std::string::npos;
  for (int time_ms = 10'000; begin == std::string::npos && time_ms <= 10'000'000; time_ms *= 10) {
    dump = browser.run({"--dump-dom"}, "looked_at.html", time_ms);
    begin = dump.out.find("<pre>SEEN ");
  }
  ASSERT_NE(begin, std::string::npos) << dump.err;
  const std::string seen = dump.out.substr(begin, dump.out.find("</pre>", begin) - begin);
  EXPECT_THAT(seen, HasSubstr("image 320x240 shown; image 320x240 shown; map"));
  const std::string corners = std::to_string(16 * 54);
  EXPECT_THAT(seen,
              HasSubstr("map shown, " + corners + " corners; map shown, " + corners + " corners; stat"));
  EXPECT_THAT(
      seen, testing::ContainsRegex("stat 0\\.[0-9][0-9] ?px; stat 0\\.[0-9][0-9] ?px; stat [0-9]+ ?%; stat"));
  EXPECT_THAT(seen, HasSubstr("verdict good;"));
  EXPECT_THAT(seen, HasSubstr("16 pairs; 5 depths; fits;"));

  const std::string shot = (directory / "shot.png").string();
  const ProgramRun draw = browser.run({"--hide-scrollbars", "--screenshot=" + shot}, "report.html");
  if (const char* keep = std::getenv("STEREOD_KEEP_SCREENSHOT")) {
    std::filesystem::copy_file(shot, keep, std::filesystem::copy_options::overwrite_existing);
  }
  const GrayImage image = read_gray(shot);
  EXPECT_EQ(image.width(), 1100) << draw.err;
  // The two camera images have more shades than a page without them.
  std::set<std::uint8_t> shades;
  for (int y = 0; y < image.height(); ++y) shades.insert(image.row(y), image.row(y) + image.width());
  EXPECT_GT(shades.size(), 150U);
}

}  // namespace
}  // namespace stereod::calib
