// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/session/plan_file.h"

#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "recordings/session/calibration_file.h"
#include "tests/support/files/text_file.h"

namespace marey::recordings {
namespace {

/// The example of docs/formats/plan.md.
std::string plan_text() {
  return R"(format = 1
tag_size_m = 0.08
stature_m = 1.75

[volume]
least_m = [-2.0, -1.5]
greatest_m = [2.0, 1.5]
step_m = 0.25

[[camera]]
name = "left"
place_m = [-2.5, 2.2, 2.5]
looks_at_m = [0.0, 1.0, 0.0]
width_px = 1280
height_px = 720
field_of_view_deg = 90.0

[[camera]]
name = "right"
place_m = [2.5, 2.2, 2.5]
looks_at_m = [0.0, 1.0, 0.0]
width_px = 1920
height_px = 1080
focal_px = 1400
)";
}

std::string mistake_of(const std::string& text) {
  const auto plan = parse_plan(text, "plan.toml");
  return plan ? "none" : plan.error().message();
}

TEST(PlanFile, ReadsPositionsAndDirectionsOfCameras) {
  const auto plan = parse_plan(plan_text(), "plan.toml");
  ASSERT_TRUE(plan) << plan.error().message();
  ASSERT_EQ(plan->cameras.size(), 2U);
  const Camera& left = plan->cameras[0];
  EXPECT_EQ(left.name, "left");
  EXPECT_LT(glm::distance(centre_in_world(left), {-2.5, 2.2, 2.5}), 1e-12);
  const auto target = project(left, {0.0, 1.0, 0.0});
  ASSERT_TRUE(target);
  EXPECT_LT(glm::distance(*target, {639.5, 359.5}), 1e-9);
  // Up in the world is up in the picture, and its right is the camera's.
  EXPECT_LT(project(left, {0.0, 1.5, 0.0})->y, 300.0);
  EXPECT_NEAR(project(left, {0.0, 1.5, 0.0})->x, 639.5, 1e-9);
  EXPECT_GT(project(left, {0.5, 1.0, 0.5})->x, 700.0);
  // Half of 1280 px at 45 degrees.
  EXPECT_NEAR(left.intrinsics.focal_px.x, 640.0, 1e-9);
  EXPECT_EQ(plan->cameras[1].intrinsics.focal_px, glm::dvec2(1400.0));
  EXPECT_EQ(plan->tag_size_m, 0.08);
  EXPECT_EQ(plan->stature_m, 1.75);
  ASSERT_TRUE(plan->volume);
  EXPECT_EQ(plan->volume->max_m, glm::dvec2(2.0, 1.5));
}

TEST(PlanFile, MayBeTheCamerasOfACalibration) {
  const auto planned = parse_plan(plan_text(), "plan.toml");
  ASSERT_TRUE(planned);
  const Calibration calibration{
      planned->cameras, std::vector<CameraQuality>(2), std::vector<CameraClock>(2), 0.0};
  const auto found = parse_plan(calibration_text(calibration), "calibration.toml");
  ASSERT_TRUE(found) << found.error().message();
  ASSERT_EQ(found->cameras.size(), 2U);
  EXPECT_EQ(found->cameras[1].camera_from_world.translation,
            planned->cameras[1].camera_from_world.translation);
  EXPECT_FALSE(found->volume || found->tag_size_m || found->stature_m);
}

TEST(PlanFile, MayListTheWornTags) {
  const auto plan = parse_plan(
      "format = 1\ntag_size_m = 0.07\n[[tag]]\nsegment = \"hips\"\n"
      "[[tag]]\nsegment = \"leftHand\"\nsize_m = 0.05\n" +
          plan_text().substr(plan_text().find("[[camera]]")),
      "plan.toml");
  ASSERT_TRUE(plan) << plan.error().message();
  ASSERT_EQ(plan->tags.size(), 2U);
  EXPECT_EQ(plan->tags[0].segment, HumanBone::kHips);
  EXPECT_EQ(plan->tags[0].size_m, 0.07);
  EXPECT_EQ(plan->tags[1].size_m, 0.05);
  EXPECT_EQ(number(plan->tags[1].id), 1);
  EXPECT_NE(mistake_of("format = 1\n[[tag]]\nsegment = \"tail\"\n" +
                       plan_text().substr(plan_text().find("[[camera]]")))
                .find("plan.toml:3: \"tail\" is not a segment of a body"),
            std::string::npos);
}

TEST(PlanFile, BoundsTheVolumeBeforeAnybodyCountsIt) {
  const auto refusal = [](const char* minimum, const char* greatest) {
    return mistake_of(testing::replace_first(
        testing::replace_first(plan_text(), "[-2.0, -1.5]", minimum),
        "[2.0, 1.5]",
        greatest));
  };
  const std::string far = "is more than a kilometre from the origin. Next: give metres: ";
  EXPECT_EQ(refusal("[0.0, 0.0]", "[1e5, 0.001]"),
            "plan.toml:7: \"greatest_m\" " + far + "[x, z] on the floor.");
  EXPECT_EQ(refusal("[1e17, 0.0]", "[1.0000000000000002e17, 1.0]"),
            "plan.toml:6: \"least_m\" " + far + "[x, z] on the floor.");
  EXPECT_NE(refusal("[0.0, 0.0]", "[1e10, 1e-7]").find(far), std::string::npos);
  // A strip of 4001 by 1 places is few, of 40001 many: its width holds one row.
  const auto strip = [&](const char* step) {
    return testing::replace_first(
        testing::replace_first(
            testing::replace_first(plan_text(), "[-2.0, -1.5]", "[0.0, 0.0]"),
            "[2.0, 1.5]",
            "[1000, 1e-3]"),
        "step_m = 0.25",
        step);
  };
  EXPECT_EQ(mistake_of(strip("step_m = 0.25")), "none");
  EXPECT_NE(mistake_of(strip("step_m = 0.025")).find("more than 40000 places"),
            std::string::npos);
  // Both ends of a side are places: 200 by 200 steps are 201 by 201 places.
  const std::string square = testing::replace_first(
      testing::replace_first(plan_text(), "[-2.0, -1.5]", "[0.0, 0.0]"),
      "[2.0, 1.5]",
      "[50.0, 50.0]");
  EXPECT_NE(mistake_of(square).find("more than 40000 places"), std::string::npos);
  EXPECT_EQ(mistake_of(testing::replace_first(square, "[50.0, 50.0]", "[49.75, 49.75]")),
            "none");
}

TEST(PlanFile, NamesTheMistakeAndItsLine) {
  EXPECT_EQ(
      mistake_of(testing::replace_first(plan_text(), "looks_at_m", "look_at_m")),
      "plan.toml:13: unknown key \"look_at_m\" in [[camera]]. Next: perhaps you mean "
      "\"looks_at_m\".");
  EXPECT_EQ(
      mistake_of(
          testing::replace_first(plan_text(), "[0.0, 1.0, 0.0]", "[-2.5, 1.0, 2.5]")),
      "plan.toml:13: the camera looks at itself, or straight up or down. Next: move "
      "looks_at_m a little to the side where the picture's top is to be.");
  EXPECT_EQ(mistake_of(testing::replace_first(plan_text(),
                                              "focal_px = 1400",
                                              "focal_px = 1400\n"
                                              "field_of_view_deg = 60")),
            "plan.toml:24: both \"focal_px\" and \"field_of_view_deg\" are given. Next: "
            "remove one: they have the same meaning.");
  EXPECT_EQ(mistake_of(testing::replace_first(plan_text(), "\"right\"", "\"left\"")),
            "plan.toml:19: another camera has this name. Next: give each a name of its "
            "own.");
  EXPECT_EQ(
      mistake_of(testing::replace_first(plan_text(), "step_m = 0.25", "step_m = 0.01")),
      "plan.toml:8: the volume has more than 40000 places. Next: make step_m "
      "larger.");
  EXPECT_EQ(
      mistake_of(testing::replace_first(
          plan_text(), "greatest_m = [2.0, 1.5]", "greatest_m = [2.0, -1.5]")),
      "plan.toml:7: \"greatest_m\" must be more than \"least_m\", along x and along "
      "z. Next: give two opposite corners of the floor as [x, z].");
  EXPECT_EQ(mistake_of("format = 1\n"),
            "plan.toml:1: no [[camera]] in it. Next: add a [[camera]] for each that you "
            "plan.");
  EXPECT_EQ(mistake_of("[metadata]\nerror = 0.0\n"),
            "plan.toml:1: no camera in it. Next: run marey calibrate, or name another "
            "file.");
  EXPECT_EQ(mistake_of("[board]\ntype = \"aprilgrid\"\n"),
            "plan.toml: this is a session, not a plan. Next: give a plan as "
            "docs/formats/plan.md describes it.");
}

}  // namespace
}  // namespace marey::recordings
