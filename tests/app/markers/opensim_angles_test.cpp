// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// OpenSim's own models, in the poses that OpenSim found for them: their bodies'
// rotations, by the axes of the model's file and the angles of the motion's, become a
// motion of this skeleton, and its joint angles are OpenSim's. Proves axes, orders and
// signs of every column. Does not test the fit of a skeleton to markers.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>
#include <pugixml.hpp>

#include "core/base/degrees.h"
#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "reconstruct/motion/joint_angles.h"
#include "recordings/motion/mot.h"
#include "tests/support/program/paths.h"
#include "tests/support/truth/rotation_of_axes.h"

namespace marey {
namespace {

namespace fs = std::filesystem;
using reconstruct::Coordinate;
using recordings::MotTable;
using B = HumanBone;

constexpr double kPi = std::numbers::pi;

std::vector<double> numbers(const pugi::xml_node& node) {
  std::istringstream words(node.text().as_string());
  std::vector<double> out;
  for (double value = 0.0; words >> value;) out.push_back(value);
  return out;
}

glm::dquat about(const glm::dvec3& axis, double angle_rad) {
  return glm::angleAxis(angle_rad, glm::normalize(axis));
}

/// A function of a coordinate. Splines as straight lines between their knots, which are
/// a tenth of a degree off at most.
std::function<double(double)> function_of(const pugi::xml_node& axis) {
  if (const auto linear = axis.child("LinearFunction")) {
    const auto c = numbers(linear.child("coefficients"));
    return [c](double x) { return c[0] * x + c[1]; };
  }
  if (const auto polynomial = axis.child("PolynomialFunction")) {
    const auto c = numbers(polynomial.child("coefficients"));
    return [c](double x) {
      double y = 0.0;
      for (const double coefficient : c) y = y * x + coefficient;
      return y;
    };
  }
  if (const auto spline = axis.child("SimmSpline")) {
    const auto xs = numbers(spline.child("x"));
    const auto ys = numbers(spline.child("y"));
    return [xs, ys](double x) {
      std::size_t i = 1;
      while (i + 1 < xs.size() && xs[i] < x) ++i;
      return ys[i - 1] + (x - xs[i - 1]) / (xs[i] - xs[i - 1]) * (ys[i] - ys[i - 1]);
    };
  }
  return [](double) { return 0.0; };
}

/// Rotations of a model's bodies, joint by joint as the file lists them.
class OpenSimModel {
 public:
  using Values = std::map<std::string, double>;

  explicit OpenSimModel(const fs::path& path) {
    loaded_ = file_.load_file(path.c_str());
    joints_ = file_.child("OpenSimDocument").child("Model").child("JointSet");
  }
  [[nodiscard]] bool loaded() const { return loaded_; }

  [[nodiscard]] std::map<std::string, glm::dquat> bodies(const Values& values) const {
    std::map<std::string, glm::dquat> ground_from{{"ground", {1, 0, 0, 0}}};
    for (const pugi::xml_node& joint : joints_.child("objects").children()) {
      const Frame parent = frame(joint, "socket_parent_frame");
      const Frame child = frame(joint, "socket_child_frame");
      ground_from[child.body] = ground_from[parent.body] * parent.body_from_frame *
                                rotation(joint, values) *
                                glm::conjugate(child.body_from_frame);
    }
    return ground_from;
  }

 private:
  struct Frame {
    std::string body;
    glm::dquat body_from_frame{1, 0, 0, 0};
  };

  static Frame frame(const pugi::xml_node& joint, const char* socket) {
    const auto found = joint.child("frames").find_child_by_attribute(
        "name", joint.child(socket).text().as_string());
    const std::string body = found.child("socket_parent").text().as_string();
    const auto xyz = numbers(found.child("orientation"));
    return {
        body.substr(body.rfind('/') + 1),
        about({1, 0, 0}, xyz[0]) * about({0, 1, 0}, xyz[1]) * about({0, 0, 1}, xyz[2])};
  }

  static double value(const Values& values, const std::string& coordinate) {
    const auto found = values.find(coordinate);
    return found == values.end() ? 0.0 : found->second;
  }

  static glm::dquat rotation(const pugi::xml_node& joint, const Values& values) {
    const std::string kind = joint.name();
    const auto coordinate = joint.child("coordinates").first_child();
    const auto named = [&](const pugi::xml_node& c) {
      return value(values, c.attribute("name").as_string());
    };
    if (kind == "PinJoint") return about({0, 0, 1}, named(coordinate));
    if (kind == "UniversalJoint") {
      return about({1, 0, 0}, named(coordinate)) *
             about({0, 1, 0}, named(coordinate.next_sibling()));
    }
    glm::dquat all(1, 0, 0, 0);
    for (const auto& axis : joint.child("SpatialTransform").children()) {
      if (!std::string(axis.attribute("name").as_string()).starts_with("rot")) continue;
      const auto v = numbers(axis.child("axis"));
      const std::string of = axis.child("coordinates").text().as_string();
      all = all * about({v[0], v[1], v[2]}, function_of(axis)(value(values, of)));
    }
    return all;
  }

  pugi::xml_document file_;
  pugi::xml_node joints_;
  bool loaded_ = false;
};

/// The bones' rotations in the ground where the model's bodies have these.
std::vector<glm::dquat> bones(std::map<std::string, glm::dquat>& bodies) {
  const glm::dvec3 x(1, 0, 0);
  const glm::dvec3 y(0, 1, 0);
  const glm::dvec3 z(0, 0, 1);
  const glm::dquat axes = marey::testing::rotation_of_axes(z, y, x, y);
  std::vector<glm::dquat> out(kHumanBoneCount, bodies["torso"] * axes);
  const auto put = [&](B bone, const glm::dquat& q) { out[index(bone)] = q; };
  put(B::kHips, bodies["pelvis"] * axes);
  for (const bool left : {false, true}) {
    const std::string s = left ? "_l" : "_r";
    const double side = left ? -1.0 : 1.0;
    const auto bone = [&](B right) { return left ? mirrored(right) : right; };
    put(bone(B::kRightUpperLeg), bodies["femur" + s] * axes);
    put(bone(B::kRightLowerLeg), bodies["tibia" + s] * axes);
    put(bone(B::kRightFoot), bodies["calcn" + s] * axes);
    put(bone(B::kRightToes), bodies["toes" + s] * axes);
    // The T-pose's arms point to the sides, palms down; the model's zero has them
    // hanging, elbow axes as in its file, palms forward.
    const glm::dvec3 hinge = glm::normalize(glm::dvec3(0.22604696 * side, 0, 0.97386183));
    const glm::dquat arm =
        marey::testing::rotation_of_axes(-side * x, side * y, -y, hinge);
    put(bone(B::kRightUpperArm), bodies["humerus" + s] * arm);
    put(bone(B::kRightLowerArm), bodies["ulna" + s] * arm);
    put(bone(B::kRightHand),
        bodies["hand" + s] * marey::testing::rotation_of_axes(-side * x, -y, -y, x));
  }
  return out;
}

struct Case {
  const char* name;
  const char* model;
  const char* motion;
  double knee_sign;
};

class OpenSimAngles : public ::testing::TestWithParam<Case> {
 protected:
  static fs::path folder() { return marey::testing::shared_data() / "mocap"; }
  void SetUp() override {
    if (!fs::exists(folder())) GTEST_SKIP() << folder() << " is not there";
  }
};

/// Returns the tolerance of a column, for the parts of the model that the column's
/// definition leaves out: docs/formats/README.md. [rad]
double allowed(const std::string& column) {
  // Eight decimals in the file.
  constexpr double kDigits = 1e-6;
  // The knee's axis leans by 4 degrees and turns with flexion.
  if (column.starts_with("knee")) return 1.0 * kRadiansPerDegree;
  // The elbow's axis leans along the arm by 1.3 degrees, that of pronation by 3.
  if (column.starts_with("elbow")) return 0.3 * kRadiansPerDegree;
  if (column.starts_with("pro_sup") || column.starts_with("wrist"))
    return 2.0 * kRadiansPerDegree;
  return kDigits;
}

TEST_P(OpenSimAngles, MatchTheAnglesThatPosedTheModel) {
  const OpenSimModel model(folder() / GetParam().model);
  ASSERT_TRUE(model.loaded());
  const auto theirs = recordings::read_mot(folder() / GetParam().motion);
  ASSERT_TRUE(theirs) << theirs.error().message();
  Motion motion;
  motion.skeleton = make_humanoid(average_proportions(1.75));
  motion.rate = FrameRate{100.0};
  for (std::size_t row = 0; row < theirs->rows(); ++row) {
    OpenSimModel::Values values;
    for (std::size_t i = 0; i < theirs->columns.size(); ++i) {
      values[theirs->columns[i].name] = theirs->at(row, i);
    }
    auto bodies = model.bodies(values);
    motion.poses.push_back(pose_from_world(motion.skeleton, {0, 1, 0}, bones(bodies)));
  }
  const auto mine = reconstruct::joint_angles(motion);
  int columns = 0;
  for (int i = 0; i < static_cast<int>(reconstruct::kCoordinateCount); ++i) {
    const std::string name(reconstruct::name(Coordinate{i}));
    const auto column = theirs->find(name);
    if (!column || !reconstruct::is_angle(Coordinate{i})) continue;
    const double sign = name.starts_with("knee") ? GetParam().knee_sign : 1.0;
    double worst = 0.0;
    for (std::size_t row = 0; row < theirs->rows(); ++row) {
      const double off = mine.at(row, Coordinate{i}) - sign * theirs->at(row, *column);
      worst = std::max(worst, std::abs(std::remainder(off, 2 * kPi)));
    }
    EXPECT_LT(worst, allowed(name)) << name;
    ++columns;
  }
  EXPECT_GE(columns, 30);
}

INSTANTIATE_TEST_SUITE_P(
    Recordings,
    OpenSimAngles,
    ::testing::Values(
        Case{"Running3",
             "addbiomechanics/Expert2/hand_scaled.osim",
             "addbiomechanics/Expert2/run0350cms.mot",
             1.0},
        Case{"Running9",
             "addbiomechanics/Expert2/hand_scaled.osim",
             "addbiomechanics/Expert2/run0900cms.mot",
             1.0},
        Case{"DropJump",
             "nimblephysics/osim/LaiArnoldSubject5/"
             "LaiArnoldModified2017_poly_withArms_weldHand_scaled.osim",
             "nimblephysics/osim/LaiArnoldSubject5/DJ2.mot",
             1.0},
        Case{"HamnersRunning",
             "opensim-models/Hamner/outputReference/subject02_scaled.osim",
             "opensim-models/Hamner/outputReference/ResultsIK/subject02_running_ik.mot",
             -1.0}),
    [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace marey
