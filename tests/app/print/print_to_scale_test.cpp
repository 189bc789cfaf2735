// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Measures the prints of marey in pictures: poppler draws the pages, and detectors search
// the pictures for the patterns.
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/aruco/charuco.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "capture/tags/detect_tags.h"
#include "core/board.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/run_program.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr double kDotsPerInch = 300.0;
constexpr double kPxPerM = kDotsPerInch / 0.0254;
/// The required accuracy of the print; a dot is 0.085 mm.
constexpr double kTolerance_m = 0.0001;

/// An empty folder; skips without poppler.
class PrintToScale : public ::testing::Test {
 protected:
  void SetUp() override {
    if (marey::testing::pdftoppm().empty()) {
      GTEST_SKIP() << "skipped: pdftoppm is missing; apt-get install poppler-utils";
    }
  }

  [[nodiscard]] std::string pdf() const { return (folder_ / "out.pdf").string(); }
  /// `marey ARGUMENTS --out out.pdf --json`.
  Json print(std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--out", pdf(), "--json"});
    const ProgramRun run = run_program(marey::testing::program(), arguments);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return Json::parse(run.out, nullptr, false);
  }

  /// Its pages at 300 dots an inch.
  std::vector<cv::Mat> draw() {
    const ProgramRun run =
        run_program(marey::testing::pdftoppm(),
                    {"-r", "300", "-gray", pdf(), (folder_ / "page").string()});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    std::set<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder_.path())) {
      if (entry.path().extension() == ".pgm") files.insert(entry.path());
    }
    std::vector<cv::Mat> pages;
    for (const fs::path& file : files) {
      pages.push_back(cv::imread(file.string(), cv::IMREAD_GRAYSCALE));
    }
    return pages;
  }

 private:
  ScratchFolder folder_;
};

/// The page as a camera would see it, a few times smaller: light is averaged and a little
/// blurred, grey values follow from it by sRGB's curve (IEC 61966-2-1). The detector is
/// made for such pictures; in ones without any blur its corners are off by a pixel or
/// two.
cv::Mat seen(const cv::Mat& page, int times) {
  cv::Mat light;
  page(cv::Rect(0, 0, page.cols / times * times, page.rows / times * times))
      .convertTo(light, CV_32F, 1.0 / 255.0);
  cv::resize(light, light, {}, 1.0 / times, 1.0 / times, cv::INTER_AREA);
  cv::GaussianBlur(light, light, {}, 0.7);
  light.forEach<float>([](float& value, const int*) {
    value = value <= 0.0031308F ? 12.92F * value
                                : 1.055F * std::pow(value, 1.0F / 2.4F) - 0.055F;
  });
  cv::Mat gray;
  light.convertTo(gray, CV_8U, 255.0);
  return gray;
}

/// Returns the detected tags. The detector's corners are good to 0.2 mm, because it
/// receives few pixels. The function then refines them in the page itself.
std::vector<TagDetection> tags_in(const cv::Mat& page,
                                  const std::string& family,
                                  double largest_m) {
  // The largest tag has some hundred pixels, as in front of a camera.
  const int times = std::max(3, static_cast<int>(largest_m * kPxPerM / 100.0));
  const cv::Mat picture = seen(page, times);
  auto detector = capture::TagDetector::create({.families = {{family, {}}}});
  EXPECT_TRUE(detector);
  std::vector<TagDetection> tags = detector->detect(
      {picture.data, picture.cols, picture.rows, static_cast<int>(picture.step[0]), 0});
  for (TagDetection& tag : tags) {
    std::vector<cv::Point2f> corners;
    for (const glm::dvec2& corner : tag.corners_px) {
      const glm::dvec2 p = static_cast<double>(times) * (corner + 0.5) - 0.5;
      corners.emplace_back(static_cast<float>(p.x), static_cast<float>(p.y));
    }
    const cv::TermCriteria precise(
        cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 50, 0.01);
    cv::cornerSubPix(page, corners, {7, 7}, {-1, -1}, precise);
    for (std::size_t i = 0; i < 4; ++i) tag.corners_px[i] = {corners[i].x, corners[i].y};
  }
  return tags;
}

/// Compares edges and diagonals with the size, and the middle with the reported centre.
void expect_size(const TagDetection& tag, const Json& said, double page_height_m) {
  const double size_m = said.at("size_m");
  glm::dvec2 middle{0.0};
  for (std::size_t i = 0; i < 4; ++i) {
    middle += 0.25 * tag.corners_px[i];
    for (std::size_t j = i + 1; j < 4; ++j) {
      const double wanted_m = (j - i) % 2 == 1 ? size_m : std::sqrt(2.0) * size_m;
      const double found_m =
          glm::distance(tag.corners_px[i], tag.corners_px[j]) / kPxPerM;
      EXPECT_NEAR(found_m, wanted_m, kTolerance_m) << "tag " << number(tag.id);
    }
  }
  // Centres of pixels are at whole numbers: the page begins half a pixel before.
  const glm::dvec2 at_m = (middle + 0.5) / kPxPerM;
  EXPECT_NEAR(at_m.x, said.at("centre_m").at(0).get<double>(), kTolerance_m);
  EXPECT_NEAR(
      page_height_m - at_m.y, said.at("centre_m").at(1).get<double>(), kTolerance_m);
}

void expect_tags(const Json& summary,
                 const std::vector<cv::Mat>& pictures,
                 const std::string& family,
                 std::set<int> wanted) {
  ASSERT_EQ(pictures.size(), summary.at("pages").size());
  for (std::size_t p = 0; p < pictures.size(); ++p) {
    const Json& page = summary.at("pages").at(p);
    double largest_m = 0.0;
    for (const Json& said : page.at("tags")) {
      largest_m = std::max(largest_m, said.at("size_m").get<double>());
    }
    std::map<int, TagDetection> found;
    for (const TagDetection& tag : tags_in(pictures[p], family, largest_m)) {
      EXPECT_EQ(tag.hamming, 0);
      found[number(tag.id)] = tag;
    }
    EXPECT_EQ(found.size(), page.at("tags").size());
    for (const Json& said : page.at("tags")) {
      const int id = said.at("id");
      EXPECT_EQ(wanted.erase(id), 1U) << id;
      ASSERT_TRUE(found.contains(id)) << family << " " << id;
      expect_size(found.at(id), said, page.at("height_m"));
    }
  }
  EXPECT_TRUE(wanted.empty());
}

/// Returns the places of the ruler's ticks along x. [m]
std::vector<double> ticks(const cv::Mat& picture, const Json& page) {
  const double height_m = page.at("height_m");
  const double left_m = page.at("ruler_start_m").at(0);
  const double line_m = height_m - page.at("ruler_start_m").at(1).get<double>();
  // Half way up the shorter ticks.
  const int row = static_cast<int>((line_m - 0.00125) * kPxPerM);
  const int first = static_cast<int>((left_m - 0.003) * kPxPerM);
  const int last = static_cast<int>((left_m + 0.103) * kPxPerM);
  std::vector<double> found;
  double weight = 0.0;
  double sum = 0.0;
  for (int x = first; x <= last; ++x) {
    const double dark = 255.0 - picture.at<std::uint8_t>(row, x);
    weight += dark;
    sum += dark * (x + 0.5);
    if (dark > 0.0 || weight == 0.0) continue;
    found.push_back(sum / weight / kPxPerM);
    weight = sum = 0.0;
  }
  return found;
}

void expect_ruler(const Json& summary, const std::vector<cv::Mat>& pictures) {
  for (std::size_t p = 0; p < pictures.size(); ++p) {
    const std::vector<double> at_m = ticks(pictures[p], summary.at("pages").at(p));
    ASSERT_EQ(at_m.size(), 11U);
    EXPECT_NEAR(at_m.back() - at_m.front(), 0.1, kTolerance_m);
    EXPECT_NEAR(at_m[5] - at_m[0], 0.05, kTolerance_m);
  }
}

TEST_F(PrintToScale, TagsOfEveryFamilyAreFound) {
  for (const char* family : {"tag36h11",
                             "tag25h9",
                             "tag16h5",
                             "tagStandard41h12",
                             "tagCircle21h7",
                             "tagCircle49h12"}) {
    SCOPED_TRACE(family);
    const Json summary =
        print({"tags", "--family", family, "--ids", "3-6,0", "--size", "3cm"});
    const auto pictures = draw();
    expect_tags(summary, pictures, family, {0, 3, 4, 5, 6});
    expect_ruler(summary, pictures);
  }
}

TEST_F(PrintToScale, TagsOnSeveralPagesOfLetterAreFound) {
  const Json summary = print({"tags",
                              "--ids",
                              "40-43,90",
                              "--size",
                              "80mm",
                              "--page",
                              "Letter",
                              "--margin",
                              "12mm"});
  const auto pictures = draw();
  EXPECT_EQ(summary.at("pages").size(), 3U);
  // Two tags fit side by side on the long edge.
  EXPECT_NEAR(pictures.at(0).cols, 11.0 * kDotsPerInch, 1.0);
  EXPECT_NEAR(pictures.at(0).rows, 8.5 * kDotsPerInch, 1.0);
  expect_tags(summary, pictures, "tag36h11", {40, 41, 42, 43, 90});
  expect_ruler(summary, pictures);
}

TEST_F(PrintToScale, FoldedPlatesAreFound) {
  const Json summary = print({"tags",
                              "--ids",
                              "41:leftLowerArm,44:leftLowerArm,7-8",
                              "--size",
                              "50mm",
                              "--plates"});
  expect_tags(summary, draw(), "tag36h11", {7, 8, 41, 44});
}

TEST_F(PrintToScale, SessionsTagsHaveTheirOwnSizes) {
  const Json summary = print(
      {"tags", "--session", marey::testing::sample_session().string(), "--page", "A3"});
  std::set<int> ids;
  std::set<double> sizes_mm;
  for (const Json& page : summary.at("pages")) {
    for (const Json& tag : page.at("tags")) {
      ids.insert(tag.at("id").get<int>());
      sizes_mm.insert(std::round(1e3 * tag.at("size_m").get<double>()));
    }
  }
  EXPECT_EQ(ids.size(), 29U);
  EXPECT_GT(sizes_mm.size(), 1U);
  expect_tags(summary, draw(), "tag36h11", ids);
}

/// Fits a similarity to pairs of points, and returns the largest residual. Complex
/// numbers make the fit linear: b = scale_and_turn * a + shift.
double worst_after_similarity(const std::vector<glm::dvec2>& from,
                              const std::vector<glm::dvec2>& to) {
  using Complex = std::complex<double>;
  Complex mean_from;
  Complex mean_to;
  const auto count = static_cast<double>(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) {
    mean_from += Complex(from[i].x, from[i].y) / count;
    mean_to += Complex(to[i].x, to[i].y) / count;
  }
  Complex product;
  double squares = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Complex a = Complex(from[i].x, from[i].y) - mean_from;
    product += std::conj(a) * (Complex(to[i].x, to[i].y) - mean_to);
    squares += std::norm(a);
  }
  const Complex scale_and_turn = product / squares;
  // A page is neither scaled nor turned.
  EXPECT_NEAR(std::abs(scale_and_turn), 1.0, 5e-4);
  EXPECT_NEAR(std::arg(scale_and_turn), 0.0, 5e-4);
  double worst = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Complex a = Complex(from[i].x, from[i].y) - mean_from;
    const Complex b = Complex(to[i].x, to[i].y) - mean_to;
    worst = std::max(worst, std::abs(scale_and_turn * a - b));
  }
  return worst;
}

/// From the lower left corner of the page, y up.
glm::dvec2 on_page(const glm::dvec2& p_px, const cv::Mat& page) {
  return glm::dvec2(p_px.x + 0.5, page.rows - (p_px.y + 0.5)) / kPxPerM;
}

TEST_F(PrintToScale, AprilGridIsTheBoardOfTheProgram) {
  const Json summary = print({"board",
                              "--type",
                              "aprilgrid",
                              "--columns",
                              "5",
                              "--rows",
                              "7",
                              "--tag-size",
                              "23mm",
                              "--gap",
                              "7mm",
                              "--first-id",
                              "100"});
  const AprilGrid grid{7, 5, 0.023, 0.007, 100, 0.0};
  const auto pictures = draw();
  ASSERT_EQ(pictures.size(), 1U);
  std::vector<glm::dvec2> wanted;
  std::vector<glm::dvec2> found;
  for (const TagDetection& tag : tags_in(pictures[0], "tag36h11", grid.tag_size_m)) {
    for (int corner = 0; corner < 4; ++corner) {
      const auto p_in_board = grid.corner_in_board(tag.id, corner);
      ASSERT_TRUE(p_in_board) << number(tag.id);
      wanted.emplace_back(*p_in_board);
      found.push_back(
          on_page(tag.corners_px[static_cast<std::size_t>(corner)], pictures[0]));
    }
  }
  ASSERT_EQ(found.size(), 4U * 35U);
  EXPECT_LT(worst_after_similarity(wanted, found), kTolerance_m);
  EXPECT_EQ(summary.at("board_toml"),
            "[board]\ntype = \"aprilgrid\"\nfamily = \"tag36h11\"\nrows = 7\ncolumns = "
            "5\ntag_size_m = 0.023\n"
            "gap_m = 0.007\nfirst_id = 100\nthickness_m = 0.0\n");
  expect_ruler(summary, pictures);
}

// Also with an even number of rows, where boards differ by OpenCV's version.
TEST_F(PrintToScale, CharucoIsTheBoardOfOpenCv) {
  namespace aruco = cv::aruco;
  struct Case {
    const char* name;
    aruco::PREDEFINED_DICTIONARY_NAME code;
    int rows;
  };
  for (const Case& one : {Case{"DICT_5X5_100", aruco::DICT_5X5_100, 7},
                          Case{"DICT_APRILTAG_36h11", aruco::DICT_APRILTAG_36h11, 6}}) {
    SCOPED_TRACE(one.name);
    print({"board",
           "--type",
           "charuco",
           "--squares-x",
           "5",
           "--squares-y",
           std::to_string(one.rows),
           "--square-size",
           "30mm",
           "--marker-size",
           "22mm",
           "--dictionary",
           one.name});
    const auto pictures = draw();
    ASSERT_EQ(pictures.size(), 1U);
    const auto dictionary = aruco::getPredefinedDictionary(one.code);
    const auto board =
        aruco::CharucoBoard::create(5, one.rows, 0.03F, 0.022F, dictionary);
    std::vector<std::vector<cv::Point2f>> markers;
    std::vector<int> marker_ids;
    aruco::detectMarkers(pictures[0], dictionary, markers, marker_ids);
    EXPECT_EQ(marker_ids.size(), static_cast<std::size_t>(5 * one.rows / 2));
    cv::Mat corners;
    cv::Mat ids;
    aruco::interpolateCornersCharuco(
        markers, marker_ids, pictures[0], board, corners, ids);
    ASSERT_EQ(ids.rows, 4 * (one.rows - 1));
    std::vector<glm::dvec2> wanted;
    std::vector<glm::dvec2> found;
    for (int i = 0; i < ids.rows; ++i) {
      const auto id = static_cast<std::size_t>(ids.at<int>(i));
      const cv::Point3f p_in_board = board->chessboardCorners[id];
      const auto p_px = corners.at<cv::Point2f>(i);
      wanted.emplace_back(p_in_board.x, -p_in_board.y);  // Its y is down.
      found.push_back(on_page({p_px.x, p_px.y}, pictures[0]));
    }
    EXPECT_LT(worst_after_similarity(wanted, found), kTolerance_m);
  }
}

}  // namespace
}  // namespace marey::testing
