// The report as a browser shows it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <set>
#include <string>

#include "calib/report/report.h"
#include "daemon/base/file.h"
#include "daemon/imagefile/read_image.h"
#include "tests/support/board_scene.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_directory.h"

namespace stereod {
namespace {

using testing::HasSubstr;

// Says, as text in the page, what a person would see of it.
constexpr const char* kLook = R"(<script>
(async () => {
  const seen = [];
  for (const image of document.querySelectorAll('image, img')) {
    const probe = new Image();
    probe.src = image.getAttribute('href') || image.getAttribute('src');
    try { await probe.decode(); } catch (error) { }
    const box = image.getBoundingClientRect();
    seen.push(`picture ${probe.naturalWidth}x${probe.naturalHeight} ${box.width > 200 && box.height > 150 ? 'shown' : 'hidden'};`);
  }
  for (const map of document.querySelectorAll('svg.map')) {
    seen.push(`map ${map.getBoundingClientRect().width > 200 ? 'shown' : 'hidden'}, ${map.querySelectorAll('circle').length} corners;`);
  }
  for (const figure of document.querySelectorAll('.figure b')) seen.push(`figure ${figure.innerText.replace(/\s+/g, ' ')};`);
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

  // The page's time goes on by `time_ms` as fast as the page has nothing to do; decoding images takes none
  // of it.
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

TEST(ReportInABrowser, ShowsPicturesAndNumbers) {
  if (!Browser::is_there()) GTEST_SKIP() << "the Debian package chromium is not here";
  const Board board{9, 6, 0.025};
  const StereoRigEstimate cameras = known_cameras({320, 240});
  const BoardScene scene(cameras, board);
  std::vector<ImagePair> pictures;
  for (const BoardPose& pose : varied_poses(board, 16)) {
    pictures.push_back(scene.render(pose, pictures.size()));
    pictures.back().name = "pair " + std::to_string(pictures.size());
  }
  const SolveResult result = solve(pictures, {board, board.square_m, LensChoice::kPinhole});
  const std::string page = report_page(result, assess(result), pictures);
  TemporaryDirectory directory;
  write_text_file(directory / "report.html", page);
  std::string looked_at = page;
  looked_at.insert(looked_at.find("</body>"), kLook);
  write_text_file(directory / "looked_at.html", looked_at);

  const Browser browser(directory);
  // On a busy machine that time can be over before the images are decoded.
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
              HasSubstr("map shown, " + corners + " corners; map shown, " + corners + " corners; figure"));
  EXPECT_THAT(seen, testing::ContainsRegex(
                        "figure 0\\.[0-9][0-9] ?px; figure 0\\.[0-9][0-9] ?px; figure [0-9]+ ?%; figure"));
  EXPECT_THAT(seen, HasSubstr("verdict good;"));
  EXPECT_THAT(seen, HasSubstr("16 pairs; 5 depths; fits;"));

  const std::string shot = (directory / "shot.png").string();
  const ProgramRun draw = browser.run({"--hide-scrollbars", "--screenshot=" + shot}, "report.html");
  if (const char* keep = std::getenv("STEREOD_KEEP_SCREENSHOT")) {
    std::filesystem::copy_file(shot, keep, std::filesystem::copy_options::overwrite_existing);
  }
  const GrayImage picture = read_gray(shot);
  EXPECT_EQ(picture.width(), 1100) << draw.err;
  // Drawn: the two images alone have more shades than a page without them would.
  std::set<std::uint8_t> shades;
  for (int y = 0; y < picture.height(); ++y) shades.insert(picture.row(y), picture.row(y) + picture.width());
  EXPECT_GT(shades.size(), 150U);
}

}  // namespace
}  // namespace stereod
