// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/camera.h"

#include <array>
#include <limits>

#include <ceres/jet.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace marey {
namespace {

/// A wide webcam: barrel distortion that bends the corners of the image by 70 px.
Intrinsics webcam() {
  Intrinsics k;
  k.width_px = 1280;
  k.height_px = 720;
  k.focal_px = {905.0, 903.0};
  k.centre_px = {641.5, 352.0};
  k.distortion = {-0.28, 0.09, 0.0008, -0.0006, -0.012};
  return k;
}

glm::dvec2 project_ray(const Intrinsics& k, const glm::dvec2& ray) {
  const std::array<double, 3> p_in_camera{ray.x, ray.y, 1.0};
  glm::dvec2 pixel_px{0.0};
  EXPECT_TRUE(project(k, p_in_camera.data(), &pixel_px.x));
  return pixel_px;
}

TEST(Intrinsics, ComeBackFromTheirParameters) {
  const Intrinsics k = webcam();
  Intrinsics back;
  back.set_parameters(k.parameters());
  EXPECT_EQ(back.parameters(), k.parameters());
  EXPECT_EQ(back.distortion, k.distortion);
}

TEST(Project, IsBrownsFormulaInOpenCvsOrder) {
  Intrinsics k;
  k.focal_px = {1000.0, 1000.0};
  k.centre_px = {640.0, 360.0};
  k.distortion = {0.1, 0.01, 0.001, 0.002, 0.003};
  // By hand for x = 0.2, y = -0.1: r2 = 0.05, radial factor 1.005025375, tangential
  // terms (-0.00004 + 0.00026, 0.00007 - 0.00008).
  const glm::dvec2 pixel_px = project_ray(k, {0.2, -0.1});
  EXPECT_NEAR(pixel_px.x, 841.225075, 1e-9);
  EXPECT_NEAR(pixel_px.y, 259.4874625, 1e-9);
}

/// A lens of 130 degrees across.
Intrinsics fisheye() {
  Intrinsics k = webcam();
  k.lens = LensModel::kFisheye;
  k.focal_px = {640.0, 638.0};
  k.distortion = {-0.021, 0.013, -0.006, 0.0011};
  return k;
}

/// The same picture as a strong barrel, with a denominator.
Intrinsics rational() {
  Intrinsics k = webcam();
  k.lens = LensModel::kRational;
  k.distortion = {0.31, 0.02, 0.0004, -0.0003, 0.002, 0.52, 0.03, 0.001};
  return k;
}

TEST(Project, IsOpenCvsRationalFormula) {
  Intrinsics k = rational();
  k.focal_px = {1000.0, 1000.0};
  k.centre_px = {640.0, 360.0};
  // cv2.projectPoints of (0.2, -0.1, 1) with these terms.
  const glm::dvec2 pixel_px = project_ray(k, {0.2, -0.1});
  EXPECT_NEAR(pixel_px.x, 837.89351766, 1e-6);
  EXPECT_NEAR(pixel_px.y, 261.06574117, 1e-6);
}

TEST(Project, IsOpenCvsFisheyeFormula) {
  // cv2.fisheye.projectPoints of (1.5, -0.8, 1) with these terms.
  const glm::dvec2 pixel_px = project_ray(fisheye(), {1.5, -0.8});
  EXPECT_NEAR(pixel_px.x, 1220.30435330, 1e-6);
  EXPECT_NEAR(pixel_px.y, 44.26901883, 1e-6);
}

TEST(Project, HasADerivativeOnTheAxisOfAFisheye) {
  using Jet = ceres::Jet<double, 2>;
  const Intrinsics k = fisheye();
  const std::array<Jet, 3> p{Jet(0.0, 0), Jet(0.0, 1), Jet(1.0)};
  std::array<Jet, 2> pixel_px;
  ASSERT_TRUE(project(k, p.data(), pixel_px.data()));
  EXPECT_DOUBLE_EQ(pixel_px[0].v[0], k.focal_px.x);
  EXPECT_DOUBLE_EQ(pixel_px[1].v[1], k.focal_px.y);
}

TEST(Unproject, UndoesEveryLens) {
  for (const Intrinsics& k : {webcam(), rational(), fisheye()}) {
    for (double x_px = 0.0; x_px < 1280.0; x_px += 79.9) {
      for (double y_px = 0.0; y_px < 720.0; y_px += 71.9) {
        const auto ray = unproject(k, {x_px, y_px});
        ASSERT_TRUE(ray) << x_px << ", " << y_px;
        EXPECT_LT(glm::distance(project_ray(k, *ray), {x_px, y_px}), 1e-8);
      }
    }
  }
}

TEST(Project, DeclinesAPointBehindTheCameraAndLeavesThePixelAlone) {
  const Intrinsics k = webcam();
  for (const double depth_m : {-1.0, 0.0, 1e-7}) {
    const std::array<double, 3> p_in_camera{0.1, 0.1, depth_m};
    std::array<double, 2> pixel_px{-7.0, -8.0};
    EXPECT_FALSE(project(k, p_in_camera.data(), pixel_px.data()));
    EXPECT_EQ(pixel_px, (std::array<double, 2>{-7.0, -8.0}));
  }
  const Camera camera{"front", k, {}, {}};
  EXPECT_FALSE(project(camera, glm::dvec3(0.0, 0.0, -2.0)));
}

TEST(Project, DeclinesAPointThatIsNotANumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Intrinsics lens;
  std::array<double, 2> pixel_px{1.0, 2.0};
  const std::array<double, 3> p{0.1, 0.2, nan};
  EXPECT_FALSE(project(lens, p.data(), pixel_px.data()));
  EXPECT_EQ(pixel_px[0], 1.0);
  using Jet = ceres::Jet<double, 3>;
  const std::array<Jet, 3> p_jet{Jet(0.1, 0), Jet(0.2, 1), Jet(nan, 2)};
  std::array<Jet, 2> jet_px;
  EXPECT_FALSE(project(lens, p_jet.data(), jet_px.data()));
}

TEST(Project, GivesTheSameValueToJetsAndToDoubles) {
  using Jet = ceres::Jet<double, 3>;
  const Intrinsics k = webcam();
  const std::array<double, 3> p{0.4, -0.25, 2.0};
  const std::array<Jet, 3> p_jet{Jet(p[0], 0), Jet(p[1], 1), Jet(p[2], 2)};
  std::array<double, 2> plain_px{};
  std::array<Jet, 2> jet_px;
  ASSERT_TRUE(project(k, p.data(), plain_px.data()));
  ASSERT_TRUE(project(k, p_jet.data(), jet_px.data()));
  for (std::size_t i = 0; i < 2; ++i) EXPECT_DOUBLE_EQ(jet_px[i].a, plain_px[i]);
}

TEST(Project, HasTheDerivativesThatFiniteDifferencesShow) {
  using Jet = ceres::Jet<double, 3>;
  const Intrinsics k = webcam();
  const std::array<double, 3> p{0.4, -0.25, 2.0};
  const std::array<Jet, 3> p_jet{Jet(p[0], 0), Jet(p[1], 1), Jet(p[2], 2)};
  std::array<Jet, 2> jet_px;
  ASSERT_TRUE(project(k, p_jet.data(), jet_px.data()));
  constexpr double kStep_m = 1e-6;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::array<double, 3> before = p;
    std::array<double, 3> after = p;
    before[axis] -= kStep_m;
    after[axis] += kStep_m;
    std::array<double, 2> before_px{};
    std::array<double, 2> after_px{};
    ASSERT_TRUE(project(k, before.data(), before_px.data()));
    ASSERT_TRUE(project(k, after.data(), after_px.data()));
    for (std::size_t i = 0; i < 2; ++i) {
      // Rounding of pixels (1e-13) over the step: 1e-7 px/m, of some 450.
      EXPECT_NEAR(jet_px[i].v[static_cast<int>(axis)],
                  (after_px[i] - before_px[i]) / (2.0 * kStep_m),
                  1e-5);
    }
  }
}

TEST(Project, AppliesTheCameraPoseToAWorldPoint) {
  Camera camera{"side", webcam(), {}, {}};
  // Turned a quarter about Y: the camera looks along the world's X.
  const RigidTransform world_from_camera{
      rotation_from_vector({0.0, glm::radians(90.0), 0.0}), {1.0, 2.0, 3.0}};
  camera.camera_from_world = inverse(world_from_camera);
  const auto pixel_px = project(camera, {4.0, 2.0, 3.0});
  ASSERT_TRUE(pixel_px);
  EXPECT_LT(glm::distance(*pixel_px, camera.intrinsics.centre_px), 1e-9);
  EXPECT_LT(glm::distance(centre_in_world(camera), {1.0, 2.0, 3.0}), 1e-12);
}

TEST(Unproject, FindsTheRayOfEveryPixelOfTheImage) {
  const Intrinsics k = webcam();
  for (double x_px = -0.5; x_px < 1280.0; x_px += 42.7) {
    for (double y_px = -0.5; y_px < 720.0; y_px += 40.0) {
      const auto ray = unproject(k, {x_px, y_px});
      ASSERT_TRUE(ray) << x_px << ", " << y_px;
      // Newton's method stops at 1e-9 px.
      EXPECT_LT(glm::distance(project_ray(k, *ray), {x_px, y_px}), 1e-8);
    }
  }
}

TEST(Unproject, GivesTheRayThatWasProjected) {
  const Intrinsics k = webcam();
  for (const glm::dvec2& ray : {glm::dvec2(0.0, 0.0),
                                glm::dvec2(0.3, -0.2),
                                glm::dvec2(-0.7, 0.4),
                                glm::dvec2(0.75, 0.42)}) {
    const auto back = unproject(k, project_ray(k, ray));
    ASSERT_TRUE(back);
    // 1e-9 px over a focal length of 900 px, less than halved by the distortion.
    EXPECT_LT(glm::distance(*back, ray), 1e-11);
  }
}

TEST(Unproject, DeclinesAPixelThatNoRayReaches) {
  Intrinsics k = webcam();
  k.distortion = {-0.28, 0.0, 0.0, 0.0, 0.0};
  // r (1 - 0.28 r2) is never more than 0.73, at r = 1.09: 657 px from the centre.
  EXPECT_FALSE(unproject(k, k.centre_px + glm::dvec2(900.0, 0.0)));
}

}  // namespace
}  // namespace marey
