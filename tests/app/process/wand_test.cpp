// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// `marey calibrate` on pictures of a box of tags that is carried about before four
// cameras, from the pictures to calibration.html.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "recordings/session/calibration_file.h"
#include "tests/app/process/painted_tags.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/run_program.h"
#include "tests/support/program/scratch_folder.h"
#include "tests/support/simulation/synthetic_rig.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;

constexpr double kPi = std::numbers::pi;
constexpr double kHz = 10.0;
constexpr double kSize_m = 0.2;
constexpr int kFirstLying = 20;

/// Cameras of 640 x 480 around a volume of a metre and a half.
std::vector<Camera> truth() {
  const glm::dvec3 middle(0.0, 0.8, 0.0);
  std::vector<Camera> cameras{webcam_at("north", {0.3, 1.9, 2.1}, middle),
                              webcam_at("east", {2.2, 1.7, 0.2}, middle),
                              webcam_at("south", {-0.4, 2.0, -2.1}, middle),
                              webcam_at("west", {-2.0, 1.8, 0.5}, middle)};
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    Intrinsics& k = cameras[c].intrinsics;
    k.width_px = 640;
    k.height_px = 480;
    k.focal_px = glm::dvec2(520.0 + 6.0 * static_cast<double>(c));
    k.centre_px = {322.0, 238.0};
  }
  return cameras;
}

/// A tag on each of four sides of a box, and on its top.
RigidTransform wand_from_tag(int side) {
  const glm::dvec3 turn = side < 4 ? glm::dvec3(0.0, 0.5 * kPi * side, 0.0)
                                   : glm::dvec3(-0.5 * kPi, 0.0, 0.0);
  const glm::dquat rotation = rotation_from_vector(turn);
  return {rotation, rotation * glm::dvec3(0.0, 0.0, -0.14)};
}

RigidTransform world_from_wand(double time_s) {
  return {rotation_from_vector({0.0, 0.9 * time_s, 0.0}) *
              rotation_from_vector({kPi + 0.5 * std::sin(2.1 * time_s), 0.0, 0.0}) *
              rotation_from_vector({0.0, 0.0, 0.5 * std::sin(1.6 * time_s + 1.0)}),
          {0.55 * std::sin(1.3 * time_s),
           0.85 + 0.4 * std::sin(1.9 * time_s + 0.5),
           0.55 * std::cos(1.1 * time_s)}};
}

std::vector<PaintedTag> tags_at(double time_s) {
  std::vector<PaintedTag> tags;
  for (int side = 0; side < 5; ++side) {
    tags.push_back({TagId{side}, kSize_m, world_from_wand(time_s) * wand_from_tag(side)});
  }
  return tags;
}

/// Tags of no matter what size on the floor, face up.
std::vector<PaintedTag> lying_tags() {
  const glm::dquat face_up = rotation_from_vector({0.5 * kPi, 0.0, 0.0});
  return {{TagId{kFirstLying}, 0.25, {face_up, {0.5, 0.0, 0.3}}},
          {TagId{kFirstLying + 1}, 0.22, {face_up, {-0.5, 0.0, 0.4}}},
          {TagId{kFirstLying + 2}, 0.25, {face_up, {0.1, 0.0, -0.5}}}};
}

/// A session in a folder of its own, its pictures painted.
class PaintedSession {
 public:
  /// Camera c begins `late_s[c]` seconds after the first.
  PaintedSession(int frames, const std::vector<double>& late_s, bool with_floor) {
    const auto cameras = truth();
    for (std::size_t c = 0; c < cameras.size(); ++c) {
      for (int f = 0; f < frames; ++f) {
        auto tags = with_floor ? lying_tags() : std::vector<PaintedTag>();
        for (const PaintedTag& tag : tags_at(f / kHz + late_s[c])) tags.push_back(tag);
        write("waved", c, f, paint_tags(cameras[c], tags, seed_++));
      }
      for (int f = 0; f < 4 && with_floor; ++f) {
        write("floor", c, f, paint_tags(cameras[c], lying_tags(), seed_++));
      }
      cameras_ += "[[camera]]\nname = \"" + cameras[c].name + "\"\n";
    }
    trials_ = trial("waved", "calibration");
    if (with_floor) trials_ += trial("floor", "floor");
  }

  /// Runs `marey calibrate`; `target` is the part of session.toml that describes the
  /// wand.
  [[nodiscard]] ProgramRun calibrate(const std::string& target) const {
    std::ofstream(folder_ / "session.toml") << "format = 1\nname = \"wand\"\n"
                                            << target << cameras_ << trials_;
    return run_program(
        marey::testing::program(),
        {"calibrate", folder_.path().string(), "--out", (folder_ / "out").string()});
  }

  [[nodiscard]] recordings::Calibration calibration() const {
    auto found = recordings::read_calibration(folder_ / "out/calibration.toml");
    EXPECT_TRUE(found) << found.error().message();
    return found ? std::move(*found) : recordings::Calibration{};
  }

  [[nodiscard]] std::string text_of(const std::string& name) const {
    std::ifstream in(folder_ / "out" / name, std::ios::binary);
    EXPECT_TRUE(in) << name;
    return {std::istreambuf_iterator<char>(in), {}};
  }

  [[nodiscard]] nlohmann::json figures() const {
    return nlohmann::json::parse(text_of("calibration.json"));
  }

 private:
  void write(const std::string& trial, std::size_t c, int frame, const cv::Mat& picture) {
    const fs::path place = folder_ / trial / truth()[c].name;
    fs::create_directories(place);
    std::string number = std::to_string(frame);
    number.insert(0, 4 - number.size(), '0');
    ASSERT_TRUE(cv::imwrite((place / (number + ".png")).string(), picture));
  }

  [[nodiscard]] static std::string trial(const std::string& name,
                                         const std::string& kind) {
    std::string text = "[[trial]]\nname = \"" + name + "\"\nkind = \"" + kind +
                       "\"\nfps = 10\nvideos = {";
    for (const Camera& camera : truth()) {
      text += (text.back() == '{' ? " " : ", ") + camera.name + " = \"" + name + "/" +
              camera.name + "\"";
    }
    return text + " }\n";
  }

  ScratchFolder folder_;
  std::string cameras_;
  std::string trials_;
  unsigned seed_ = 1;
};

std::string wand_of_tags() {
  std::string text = "[wand]\n";
  for (int side = 0; side < 5; ++side) {
    text += "[[wand.tag]]\nid = " + std::to_string(side) + "\nsize_m = 0.2\n";
  }
  return text;
}

double worst_distance_m(const recordings::Calibration& found) {
  const auto cameras = truth();
  EXPECT_EQ(found.cameras.size(), cameras.size());
  double worst = 0.0;
  for (std::size_t a = 0; a < found.cameras.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const double is = glm::distance(centre_in_world(found.cameras[a]),
                                      centre_in_world(found.cameras[b]));
      const double should =
          glm::distance(centre_in_world(cameras[a]), centre_in_world(cameras[b]));
      worst = std::max(worst, std::abs(is - should));
    }
  }
  return worst;
}

TEST(WandProgram, CalibratesFromPicturesAndStandsOnTheFloor) {
  const PaintedSession session(48, {0.0, 0.0, 0.0, 0.0}, true);
  const ProgramRun run = session.calibrate(wand_of_tags());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err.find("clocks"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("the floor is where the tags of trial floor lie"),
            std::string::npos)
      << run.err;
  const auto found = session.calibration();
  EXPECT_LT(worst_distance_m(found), 0.008);
  const auto cameras = truth();
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    EXPECT_NEAR(
        centre_in_world(found.cameras[c]).y, centre_in_world(cameras[c]).y, 0.008);
  }
  const auto figures = session.figures();
  EXPECT_EQ(figures["target"], "wand of 5 tags");
  EXPECT_TRUE(figures["has_floor"]);
  EXPECT_LT(figures["rms_px"], 0.5);
  EXPECT_LT(figures["middle_error_mm"], 8.0);
  EXPECT_EQ(figures["error_map"]["heights"][0]["height"], "ankle");
  EXPECT_FALSE(figures["cross_validation"].is_null());
  for (const auto& finding : figures["findings"]) {
    EXPECT_NE(finding["severity"], "poor") << finding;
    EXPECT_EQ(finding["cause"].get<std::string>().find("board"), std::string::npos)
        << finding;
  }
  EXPECT_NE(session.text_of("calibration.html").find("wand of 5 tags"),
            std::string::npos);
}

// The wand is a person's hips; the webcams start at different times.
TEST(WandProgram, FindsClocksFromTheTagsOfASegment) {
  const std::vector<double> late_s{0.0, 0.43, -0.27, 1.15};
  const PaintedSession session(70, late_s, false);
  std::string target = "[tags]\nfamily = \"tag36h11\"\n";
  for (int side = 0; side < 5; ++side) {
    target += "[[tags.tag]]\nid = " + std::to_string(side) +
              "\nsegment = \"hips\"\nsize_m = 0.2\n";
  }
  const ProgramRun run = session.calibrate(target + "[wand]\nsegment = \"hips\"\n");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.err.find("the cameras' clocks in the calibration"), std::string::npos)
      << run.err;
  const auto found = session.calibration();
  ASSERT_EQ(found.clocks.size(), late_s.size());
  for (std::size_t c = 0; c < late_s.size(); ++c) {
    EXPECT_NEAR(found.clocks[c].offset_s, late_s[c], 0.002) << c;
  }
  EXPECT_LT(worst_distance_m(found), 0.012);
}

// The session declares that the cameras start together. The program assumes this and
// reports the cameras that contradict it.
TEST(WandProgram, NamesCamerasThatDoNotStartTogetherAsDeclared) {
  const PaintedSession session(48, {0.0, 0.43, -0.27, 0.0}, false);
  const ProgramRun run = session.calibrate(
      "[calibration]\nclocks = \"shared\"\ncross_validate = false\n" + wand_of_tags());
  EXPECT_EQ(run.exit_code, 4) << run.err;
  for (const char* camera : {"east", "south"}) {
    EXPECT_NE(run.err.find("error: calibration, camera " + std::string(camera)),
              std::string::npos)
        << run.err;
  }
  EXPECT_NE(run.err.find("that its video starts with the others'"), std::string::npos)
      << run.err;
}

}  // namespace
}  // namespace marey::testing
