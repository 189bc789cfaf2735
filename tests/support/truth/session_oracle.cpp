// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/truth/session_oracle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <vector>

#include <Eigen/Dense>
#include <glm/geometric.hpp>

#include "core/base/cross_matrix.h"

namespace marey::testing {
namespace {

using B = HumanBone;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr int kMinMovingFrames = 15;
constexpr int kMinStandingFrames = 3;
constexpr double kMaxSigma_m = 0.020;
constexpr double kFacesBone_m = 0.020;
constexpr double kSlipTurn_rad = 0.01;

/// A joint between two needed segments; for shoulders and hips the trunk is one of them.
struct JointPair {
  B trunkward;
  B joint;
};
constexpr std::array<JointPair, 8> kPairs{{{B::kUpperChest, B::kLeftUpperArm},
                                           {B::kUpperChest, B::kRightUpperArm},
                                           {B::kLeftUpperArm, B::kLeftLowerArm},
                                           {B::kRightUpperArm, B::kRightLowerArm},
                                           {B::kHips, B::kLeftUpperLeg},
                                           {B::kHips, B::kRightUpperLeg},
                                           {B::kLeftUpperLeg, B::kLeftLowerLeg},
                                           {B::kRightUpperLeg, B::kRightLowerLeg}}};
constexpr std::array<B, 10> kNeeded{B::kHips,
                                    B::kUpperChest,
                                    B::kLeftUpperArm,
                                    B::kRightUpperArm,
                                    B::kLeftLowerArm,
                                    B::kRightLowerArm,
                                    B::kLeftUpperLeg,
                                    B::kRightUpperLeg,
                                    B::kLeftLowerLeg,
                                    B::kRightLowerLeg};

Eigen::Vector3d eigen(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

Eigen::Matrix3d eigen(const glm::dquat& q) {
  return Eigen::Quaterniond(q.w, q.x, q.y, q.z).toRotationMatrix();
}

/// Derivative of a point's pixel over the point.
Eigen::Matrix<double, 2, 3> pixel_derivative(const Camera& camera, const glm::dvec3& p) {
  constexpr double kStep_m = 1e-4;
  Eigen::Matrix<double, 2, 3> derivative = Eigen::Matrix<double, 2, 3>::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 step(0.0);
    step[axis] = kStep_m;
    const auto plus = project(camera, p + step);
    const auto minus = project(camera, p - step);
    if (!plus || !minus) continue;
    const glm::dvec2 d = (*plus - *minus) / (2.0 * kStep_m);
    derivative.col(axis) = Eigen::Vector2d(d.x, d.y);
  }
  return derivative;
}

/// A segment's pose in one frame, with the information on a turn [rad] and a shift [m] in
/// the world's axes about the segment's origin.
struct Located {
  RigidTransform world_from_segment;
  Matrix6 information = Matrix6::Zero();
};
using LocatedFrame = std::map<B, Located>;

/// One tag in one frame: its sightings by all cameras.
struct TagSights {
  Matrix6 information = Matrix6::Zero();
  int cameras = 0;
  bool is_clear = false;  ///< To one camera alone.
};

/// Returns true when a single camera distinguishes a tag's tilt from the mirrored tilt.
/// The tilt's perspective makes opposite edges differ in length; the difference is
/// compared with the corners' noise.
bool is_clear(const RigidTransform& camera_from_tag,
              const TagDetection& detection,
              double size_m) {
  constexpr double kClearSigmas = 4.0;
  const double distance_m = glm::length(camera_from_tag.translation);
  const glm::dvec3 sight = camera_from_tag.translation / distance_m;
  const double tilt_sine =
      glm::length(glm::cross(camera_from_tag.rotation * glm::dvec3(0, 0, 1), sight));
  const double side_px =
      glm::distance(detection.corners_px[0], detection.corners_px[2]) / std::sqrt(2.0);
  return side_px * size_m * tilt_sine / distance_m > kClearSigmas * detection.sigma_px;
}

class Locator {
 public:
  Locator(const SimulatedSession& session, const SimulatedTrial& trial)
      : session_(session), trial_(trial) {}

  [[nodiscard]] LocatedFrame locate(std::size_t frame) const {
    const BoneFrames bones =
        session_.truth(trial_, static_cast<double>(frame) / trial_.hz);
    std::map<std::size_t, TagSights> sights;
    for (std::size_t c = 0; c < trial_.detections.size(); ++c) {
      for (const TagDetection& tag : trial_.detections[c].frames[frame].tags) {
        add(bones, c, tag, sights);
      }
    }
    std::map<B, int> seen;
    std::set<B> clear;
    LocatedFrame located;
    for (const auto& [tag, sight] : sights) {
      const B segment = session_.tags[tag].tag.segment;
      seen[segment] += sight.cameras;
      if (sight.is_clear) clear.insert(segment);
      Located& here = located[segment];
      here.world_from_segment = bones[index(segment)];
      here.information += with_slip(sight.information, tag);
    }
    std::erase_if(located, [&](const auto& entry) {
      return seen[entry.first] < 2 && !clear.contains(entry.first);
    });
    return located;
  }

 private:
  void add(const BoneFrames& bones,
           std::size_t c,
           const TagDetection& detection,
           std::map<std::size_t, TagSights>& sights) const {
    const auto tag = std::find_if(
        session_.tags.begin(), session_.tags.end(), [&](const GluedTag& glued) {
          return glued.tag.id == detection.id;
        });
    const auto i = static_cast<std::size_t>(tag - session_.tags.begin());
    const RigidTransform& segment = bones[index(tag->tag.segment)];
    const RigidTransform world_from_tag = segment * tag->segment_from_tag;
    const Camera& camera = session_.rig.cameras[c];
    TagSights& sight = sights[i];
    for (int corner = 0; corner < 4; ++corner) {
      const glm::dvec3 p = world_from_tag * corner_in_tag(corner, tag->tag.size_m);
      // A wrong read has no information.
      const auto pixel = project(camera, p);
      const auto place = static_cast<std::size_t>(corner);
      if (!pixel || glm::distance(*pixel, detection.corners_px[place]) > 20.0) return;
      Eigen::Matrix<double, 3, 6> motion;
      motion << -cross_matrix<Eigen::Matrix3d>(eigen(p - segment.translation)),
          Eigen::Matrix3d::Identity();
      const Eigen::Matrix<double, 2, 6> j =
          pixel_derivative(camera, p) * motion / detection.sigma_px;
      sight.information += j.transpose() * j;
    }
    sight.is_clear |=
        is_clear(camera.camera_from_world * world_from_tag, detection, tag->tag.size_m);
    ++sight.cameras;
  }

  [[nodiscard]] Matrix6 with_slip(const Matrix6& information, std::size_t tag) const {
    const double slide_m = slide_sigma_m(session_.tags[tag]);
    Matrix6 covariance =
        (information + 1e-6 * Matrix6::Identity()).ldlt().solve(Matrix6::Identity());
    covariance.topLeftCorner<3, 3>() +=
        kSlipTurn_rad * kSlipTurn_rad * Eigen::Matrix3d::Identity();
    covariance.bottomRightCorner<3, 3>() +=
        slide_m * slide_m * Eigen::Matrix3d::Identity();
    return covariance.ldlt().solve(Matrix6::Identity());
  }

  /// Standard deviation of a tag's slide over the range of motion, per coordinate.
  [[nodiscard]] double slide_sigma_m(const GluedTag& tag) const {
    const bool is_firm = tag.pulls.empty();
    return is_firm ? 0.0005 : 0.0005 + session_.style.slide_m / std::sqrt(3.0);
  }

  const SimulatedSession& session_;
  const SimulatedTrial& trial_;
};

/// Lines through tags along their normals pass the bone: information on a point of it.
Eigen::Matrix3d soft_tissue_information(const SimulatedSession& session, B segment) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  const bool is_trunk = segment == B::kHips || segment == B::kUpperChest;
  if (is_trunk) return information;
  const glm::dvec3 along = glm::normalize(end_of(segment, session.body.proportions));
  for (const GluedTag& tag : session.tags) {
    if (tag.tag.segment != segment) continue;
    const glm::dvec3 normal = tag.segment_from_tag.rotation * glm::dvec3(0, 0, 1);
    const glm::dvec3 across = glm::cross(along, normal);
    if (glm::length(across) < 0.3) continue;
    const Eigen::Vector3d e = eigen(glm::normalize(across)) / kFacesBone_m;
    information += e * e.transpose();
  }
  return information;
}

/// Worst standard deviation of a joint's place in the frames of both segments. Slides of
/// tags are correlated in frames near in time, so the information is limited to that of
/// kMaxFrames frames.
double joint_sigma_m(const SimulatedSession& session,
                     const std::vector<LocatedFrame>& frames,
                     const JointPair& pair) {
  constexpr double kMaxFrames = 100.0;
  const glm::dvec3 in_trunkward = pair.trunkward == B::kUpperChest
                                      ? session.body.proportions[*parent(pair.joint)] +
                                            session.body.proportions[pair.joint]
                                      : session.body.proportions[pair.joint];
  Matrix6 normal = Matrix6::Zero();
  double count = 0.0;
  for (const LocatedFrame& frame : frames) {
    const auto a = frame.find(pair.trunkward);
    const auto b = frame.find(pair.joint);
    if (a == frame.end() || b == frame.end()) continue;
    const auto covariance = [](const Located& segment, const Eigen::Vector3d& arm) {
      Eigen::Matrix<double, 3, 6> motion;
      motion << -cross_matrix<Eigen::Matrix3d>(arm), Eigen::Matrix3d::Identity();
      const Matrix6 pose = (segment.information + 1e-6 * Matrix6::Identity())
                               .ldlt()
                               .solve(Matrix6::Identity());
      return Eigen::Matrix3d(motion * pose * motion.transpose());
    };
    const Eigen::Matrix3d ra = eigen(a->second.world_from_segment.rotation);
    const Eigen::Matrix3d rb = eigen(b->second.world_from_segment.rotation);
    const Eigen::Matrix3d noise = covariance(a->second, ra * eigen(in_trunkward)) +
                                  covariance(b->second, Eigen::Vector3d::Zero());
    Eigen::Matrix<double, 3, 6> j;
    j << ra, -rb;
    normal += j.transpose() * noise.ldlt().solve(j);
    count += 1.0;
  }
  normal *= std::min(1.0, kMaxFrames / std::max(1.0, count));
  normal.topLeftCorner<3, 3>() += soft_tissue_information(session, pair.trunkward);
  normal.bottomRightCorner<3, 3>() += soft_tissue_information(session, pair.joint);
  const Matrix6 covariance =
      (normal + Matrix6::Identity()).ldlt().solve(Matrix6::Identity());
  const auto worst = [&](int from) {
    const Eigen::Matrix3d block = covariance.block<3, 3>(from, from);
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(block).eigenvalues()[2];
  };
  return std::sqrt(std::max(worst(0), worst(3)));
}

std::vector<LocatedFrame> locate_all(const SimulatedSession& session,
                                     const SimulatedTrial& trial) {
  const Locator locator(session, trial);
  std::vector<LocatedFrame> frames;
  for (std::size_t f = 0; f < trial.detections.front().frames.size(); ++f) {
    frames.push_back(locator.locate(f));
  }
  return frames;
}

int count_of(const std::vector<LocatedFrame>& frames, B segment) {
  return static_cast<int>(
      std::count_if(frames.begin(), frames.end(), [&](const LocatedFrame& frame) {
        return frame.contains(segment);
      }));
}

}  // namespace

Sufficiency judge_sufficiency(const SimulatedSession& session) {
  Sufficiency out;
  std::vector<LocatedFrame> frames = locate_all(session, session.moving);
  const std::vector<LocatedFrame> standing = locate_all(session, session.standing);
  const auto lack = [&](const std::string& what, B bone) {
    if (!out.lacking.empty()) out.lacking += ", ";
    out.lacking += what + " " + std::string(name(bone));
  };
  for (const B segment : kNeeded) {
    if (count_of(frames, segment) < kMinMovingFrames) lack("frames of", segment);
  }
  for (const B segment : {B::kHips, B::kUpperChest}) {
    if (count_of(standing, segment) < kMinStandingFrames) {
      lack("standing frames of", segment);
    }
  }
  frames.insert(frames.end(), standing.begin(), standing.end());
  for (const JointPair& pair : kPairs) {
    const double sigma_m = joint_sigma_m(session, frames, pair);
    out.joint_sigma_m[pair.joint] = sigma_m;
    if (sigma_m > kMaxSigma_m) lack("movement at", pair.joint);
  }
  out.is_sufficient = out.lacking.empty();
  return out;
}

}  // namespace marey::testing
