// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/motion/reread_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <glm/geometric.hpp>

#include "core/pose.h"
#include "recordings/base/motion_limits.h"
#include "recordings/gltf/posed_places.h"
#include "recordings/motion/bvh.h"
#include "recordings/motion/npz.h"

namespace marey::app {
namespace {

using JointPlaces = std::vector<std::vector<glm::dvec3>>;

JointPlaces joint_places(const Motion& motion) {
  JointPlaces out;
  for (const Pose& pose : motion.poses) {
    std::vector<glm::dvec3>& places = out.emplace_back();
    for (const RigidTransform& joint : world_from_joints(motion.skeleton, pose)) {
      places.push_back(joint.translation);
    }
  }
  return out;
}

/// Reads the positions of a file's joints and of its lowest skin vertex. [m]
Result<recordings::PosedPlaces> read_places(const WrittenFile& file) {
  if (file.format == MotionFormat::kBvh) {
    const auto read = recordings::read_bvh(file.path, {.unit_m = file.unit_m});
    if (!read) return read.error();
    return recordings::PosedPlaces{joint_places(read->motion), {}};
  }
  if (file.format == MotionFormat::kNpz) {
    const auto read = recordings::read_npz(file.path);
    if (!read) return read.error();
    return recordings::PosedPlaces{joint_places(read->motion), {}};
  }
  auto read = recordings::read_posed_places(file.path);
  if (!read) return read.error();
  for (auto& places : read->joints) {
    for (glm::dvec3& place : places) place *= file.unit_m;
  }
  for (double& lowest : read->lowest_skin) lowest *= file.unit_m;
  return read;
}

bool is_gltf(MotionFormat format) {
  return format == MotionFormat::kGlb || format == MotionFormat::kVrma;
}

/// Slow keys are read at 30 Hz (recordings/base/motion_limits.h). Returns which of the
/// read frames are the motion's: every first, second, third...; 0: none are.
std::size_t step_between_keys(const Motion& motion, std::size_t read_frames) {
  const double step = recordings::kBlendedKeysHz / motion.rate.hz;
  const double whole = std::round(step);
  if (whole < 1.0 || std::abs(step - whole) > 1e-6 * step) return 0;
  const auto frames = static_cast<std::size_t>(whole) * (motion.poses.size() - 1) + 1;
  return frames == read_frames ? static_cast<std::size_t>(whole) : 0;
}

double nearest_m(const glm::dvec3& place, const std::vector<glm::dvec3>& others) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const glm::dvec3& other : others) {
    nearest = std::min(nearest, glm::distance(place, other));
  }
  return nearest;
}

/// Sums the changes of distance, relative to rest, between each bone and the next bone
/// above it, along a chain. A format that stores only bones loses these changes. [m]
class LostDistance {
 public:
  explicit LostDistance(const Skeleton& skeleton)
      : skeleton_(skeleton), rest_(world_from_joints(skeleton, rest_pose(skeleton))) {}

  [[nodiscard]] double of(std::size_t joint,
                          std::span<const RigidTransform> world) const {
    double lost_m = 0.0;
    std::size_t below = joint;
    for (auto at = skeleton_.joints[joint].parent; at; at = skeleton_[*at].parent) {
      if (!skeleton_[*at].bone) continue;
      lost_m += std::abs(
          glm::distance(world[below].translation, world[index(*at)].translation) -
          glm::distance(rest_[below].translation, rest_[index(*at)].translation));
      below = index(*at);
    }
    return lost_m;
  }

 private:
  const Skeleton& skeleton_;
  std::vector<RigidTransform> rest_;
};

}  // namespace

WrittenFile written_file(const std::filesystem::path& out,
                         MotionFormat format,
                         const BodyLook& look,
                         const MotionFileOptions& options) {
  WrittenFile file{out, format, 1.0};
  if (format == MotionFormat::kGlb) file.unit_m = look.changed.scale;
  if (format == MotionFormat::kBvh) file.unit_m = options.bvh.unit_m;
  return file;
}

Result<std::optional<RereadFigures>> reread_motion(const WrittenFile& file,
                                                   const Motion& motion) {
  if (file.format == MotionFormat::kCsv || file.format == MotionFormat::kMot) {
    return std::optional<RereadFigures>{};
  }
  auto read = read_places(file);
  if (!read) return read.error();
  std::size_t step = 1;
  if (read->joints.size() != motion.poses.size() && is_gltf(file.format) &&
      motion.rate.hz < recordings::kMinKeysHz) {
    step = step_between_keys(motion, read->joints.size());
    if (step == 0) return std::optional<RereadFigures>{};
  } else if (read->joints.size() != motion.poses.size()) {
    return Error{Errc::kInternal,
                 file.path.string(),
                 "the written file has " + std::to_string(read->joints.size()) +
                     " frames instead of " + std::to_string(motion.poses.size()),
                 "report this as a bug, with the body's file"};
  }
  RereadFigures out;
  const LostDistance lost(motion.skeleton);
  for (std::size_t t = 0; t < motion.poses.size(); ++t) {
    const auto world = world_from_joints(motion.skeleton, motion.poses[t]);
    for (std::size_t j = 0; j < world.size(); ++j) {
      const auto& bone = motion.skeleton.joints[j].bone;
      if (!bone) continue;
      double off_m = nearest_m(world[j].translation, read->joints[step * t]);
      if (file.format == MotionFormat::kVrma) {
        const double lost_m = std::min(off_m, lost.of(j, world));
        off_m -= lost_m;
        if (lost_m > out.lost_m) {
          out.lost_m = lost_m;
          out.lost_bone = *bone;
          out.lost_frame = static_cast<int>(t);
        }
      }
      if (out.worst_frame && off_m <= out.worst_place_m) continue;
      out.worst_place_m = off_m;
      out.worst_bone = *bone;
      out.worst_frame = static_cast<int>(t);
    }
  }
  for (std::size_t t = 0; t < read->lowest_skin.size(); t += step) {
    out.lowest_skin_m.push_back(read->lowest_skin[t]);
  }
  return std::optional<RereadFigures>{std::move(out)};
}

}  // namespace marey::app
