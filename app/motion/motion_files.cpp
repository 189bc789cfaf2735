// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/motion/motion_files.h"

#include <array>
#include <utility>
#include <vector>

#include "app/motion/angle_table.h"
#include "app/motion/error_of_file.h"
#include "app/motion/foot_contacts.h"
#include "app/shell/option_checks.h"
#include "app/shell/word_list.h"
#include "core/base/extension.h"
#include "core/base/in_quotes.h"
#include "core/pose.h"
#include "recordings/base/atomic_file.h"
#include "recordings/gltf/vrma.h"
#include "recordings/motion/mot.h"
#include "recordings/motion/motion_tables.h"
#include "recordings/motion/npz.h"
#include "retarget/body/body_map.h"

namespace marey::app {
namespace {

constexpr std::array kFormats{MotionFormat::kGlb,
                              MotionFormat::kBvh,
                              MotionFormat::kVrma,
                              MotionFormat::kNpz,
                              MotionFormat::kCsv,
                              MotionFormat::kMot};

/// Returns a motion of one frame, at rest.
Motion at_rest(const Skeleton& skeleton) {
  return {skeleton, FrameRate{60.0}, 0, {rest_pose(skeleton)}};
}

Status write_bytes(const std::filesystem::path& out, const Result<std::string>& bytes) {
  if (bytes) return recordings::write_file(out, *bytes);
  return of_file(out, bytes.error());
}

Error no_angles() {
  return bad_input("",
                   "joint angles need a body made by marey: all 22 bones of VRM's "
                   "humanoid, at rest without rotations",
                   "retarget the motion to such a body first: marey mannequin makes one");
}

}  // namespace

std::vector<glm::dquat> t_pose_of(const Skeleton& skeleton,
                                  const retarget::BodyMap& map) {
  std::vector<glm::dquat> world;
  for (std::size_t i = 0; i < skeleton.joints.size(); ++i) {
    const Joint& joint = skeleton.joints[i];
    if (map.joints[i].role != retarget::JointRole::kFree) {
      world.push_back(map.joints[i].t_pose_from_joint);
    } else if (joint.parent) {
      world.push_back(world[index(*joint.parent)] * joint.parent_from_joint.rotation);
    } else {
      world.push_back(joint.parent_from_joint.rotation);
    }
  }
  return world;
}

std::span<const MotionFormat> motion_formats() {
  return kFormats;
}

std::string_view name(MotionFormat format) {
  switch (format) {
    case MotionFormat::kGlb:
      return "glb";
    case MotionFormat::kBvh:
      return "bvh";
    case MotionFormat::kVrma:
      return "vrma";
    case MotionFormat::kNpz:
      return "npz";
    case MotionFormat::kCsv:
      return "csv";
    case MotionFormat::kMot:
      return "mot";
  }
  return "";
}

std::optional<MotionFormat> motion_format(std::string_view wanted) {
  for (const MotionFormat format : kFormats) {
    if (name(format) == wanted) return format;
  }
  return std::nullopt;
}

Result<MotionFormat> output_format(const std::filesystem::path& out) {
  if (const Status ok = check_out_file(out); !ok) return ok.error();
  const std::string kind = kind_by_extension(out);
  const auto format =
      kind.empty() ? std::optional<MotionFormat>() : motion_format(kind.substr(1));
  if (format) return *format;
  return bad_input(out.string(),
                   "cannot write a " + in_quotes(kind) + " file",
                   "name the result " + motion_extensions());
}

std::string motion_extensions() {
  std::vector<std::string> extensions;
  for (const MotionFormat format : kFormats) {
    extensions.push_back("." + std::string(name(format)));
  }
  return or_list(extensions);
}

Result<std::string> vrma_of(const Motion& motion, const std::string& clip) {
  const auto map = retarget::map_body(motion.skeleton);
  if (!map) return map.error();
  const std::vector<glm::dquat> t_pose = t_pose_of(motion.skeleton, *map);
  return recordings::vrma_bytes(motion, {.t_pose_from_joint = t_pose, .clip = clip});
}

Status can_hold(MotionFormat format, const Skeleton& skeleton, const BodyLook& look) {
  if (format == MotionFormat::kGlb && look.file.empty()) {
    return bad_input("",
                     "the body has no mesh to put into a .glb",
                     "give a GLB or VRM avatar, or name the result .bvh");
  }
  if (format == MotionFormat::kVrma) {
    const auto bytes = vrma_of(at_rest(skeleton), "");
    if (!bytes) return bytes.error();
  }
  if (format == MotionFormat::kMot && !angle_table(at_rest(skeleton), "")) {
    return no_angles();
  }
  return Done{};
}

Status write_motion_file(const std::filesystem::path& out,
                         MotionFormat format,
                         const Motion& motion,
                         const BodyLook& look,
                         const MotionFileOptions& options) {
  switch (format) {
    case MotionFormat::kGlb:
      if (look.file.empty()) break;
      return recordings::write_retargeted(
          look.file, out, motion, options.clip, look.changed);
    case MotionFormat::kBvh:
      return recordings::write_bvh(out, motion, options.bvh);
    case MotionFormat::kVrma:
      return write_bytes(out, vrma_of(motion, options.clip));
    case MotionFormat::kNpz: {
      const recordings::NpzExtras extras{{}, foot_contacts(motion), {}};
      return recordings::write_npz(out, motion, extras);
    }
    case MotionFormat::kCsv:
      return recordings::write_places_csv(out, motion);
    case MotionFormat::kMot: {
      const auto table = angle_table(motion, out.stem().string());
      if (table) return recordings::write_mot(out, *table);
      break;
    }
  }
  Error error = can_hold(format, motion.skeleton, look).error();
  error.where = out.string();
  return error;
}

}  // namespace marey::app
