// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/motion/neutral.h"

#include <charconv>

#include "app/motion/raw_body.h"
#include "core/base/extension.h"
#include "core/pose.h"
#include "retarget/bones/body_frame.h"
#include "retarget/bones/identify_bones.h"
#include "retarget/bones/set_rest_pose.h"
#include "retarget/bones/up_of_motion.h"

namespace marey::app {
namespace {

bool is_neutral_file(const std::filesystem::path& file) {
  const std::string kind = kind_by_extension(file);
  return is_gltf(file) || kind == ".bvh" || kind == ".amc";
}

Error no_neutral(const std::string& word) {
  std::string names;
  for (const retarget::NamedNeutral& known : retarget::named_neutrals()) {
    names += ", " + std::string(known.name);
  }
  std::string quoted("\"");
  quoted.append(word, 0, 80).append("\" is not a neutral posture");
  return bad_input("--neutral",
                   quoted,
                   "give auto, rest, t-pose, frame:N" + names +
                       ", or a .bvh, .amc, .glb, .gltf, .vrm or .vrma file");
}

Status check_stands(const Motion& motion,
                    const retarget::FoundBones& found,
                    const std::string& what) {
  if (retarget::stands_at_rest(motion.skeleton, found)) return Done{};
  return bad_input("",
                   what +
                       " is not a standing posture: its feet are not below its hips and "
                       "its head above",
                   "give another frame or file in which the body stands, or --neutral "
                   "t-pose");
}

Status take_frame(int frame,
                  const retarget::FoundBones& found,
                  const glm::dvec3& up,
                  Motion& motion) {
  const std::size_t count = motion.poses.size();
  if (frame < 0 || static_cast<std::size_t>(frame) >= count) {
    return bad_input("",
                     "there is no frame " + std::to_string(frame) +
                         " for the neutral: "
                         "the motion has " +
                         std::to_string(count) + " frames, from 0",
                     "give a frame from 0 to " + std::to_string(count - 1));
  }
  const Pose pose = motion.poses[static_cast<std::size_t>(frame)];
  retarget::set_rest_pose(motion, found, up, pose);
  return check_stands(motion, found, "frame " + std::to_string(frame));
}

Status take_file(const std::filesystem::path& file,
                 const retarget::FoundBones& found,
                 const glm::dvec3& up,
                 Motion& motion) {
  auto raw = read_raw_body(file);
  if (!raw) return raw.error();
  Skeleton& other = raw->motion.skeleton;
  const auto bones = retarget::identify_bones(other);
  if (!bones) return bones.error();
  if (!retarget::stands_at_rest(other, *bones) && !raw->motion.poses.empty()) {
    const Pose& first = raw->motion.poses.front();
    for (std::size_t i = 0; i < other.joints.size(); ++i) {
      other.joints[i].parent_from_joint.rotation = first.parent_from_joint[i];
    }
  }
  if (const Status ok = retarget::copy_rest_pose(other, found, up, motion); !ok) {
    Error error = ok.error();
    error.where = file.string();
    return error;
  }
  return check_stands(motion, found, file.string());
}

}  // namespace

std::string name(NeutralKind kind) {
  switch (kind) {
    case NeutralKind::kAuto:
      return "auto";
    case NeutralKind::kRest:
      return "rest";
    case NeutralKind::kTPose:
      return "t-pose";
    case NeutralKind::kFrame:
      return "frame";
    case NeutralKind::kFile:
      return "file";
    case NeutralKind::kNamed:
      return "named";
  }
  return "";
}

Result<Neutral> read_neutral(const std::string& word) {
  Neutral neutral;
  for (const NeutralKind kind :
       {NeutralKind::kAuto, NeutralKind::kRest, NeutralKind::kTPose}) {
    if (word != name(kind)) continue;
    neutral.kind = kind;
    return neutral;
  }
  constexpr std::string_view kFrame = "frame:";
  if (word.starts_with(kFrame)) {
    const char* const end = word.data() + word.size();
    const auto [rest, error] =
        std::from_chars(word.data() + kFrame.size(), end, neutral.frame);
    if (error != std::errc() || rest != end || neutral.frame < 0) return no_neutral(word);
    neutral.kind = NeutralKind::kFrame;
    return neutral;
  }
  neutral.named = retarget::named_neutral(std::string_view(word));
  if (neutral.named != nullptr) {
    neutral.kind = NeutralKind::kNamed;
    return neutral;
  }
  if (!is_neutral_file(word)) return no_neutral(word);
  neutral.kind = NeutralKind::kFile;
  neutral.file = word;
  return neutral;
}

Result<NeutralKind> set_neutral(const Neutral& neutral,
                                const retarget::FoundBones& found,
                                Motion& motion,
                                const std::optional<glm::dvec3>& up_in_file) {
  if (motion.poses.empty()) return NeutralKind::kRest;
  const glm::dvec3 up = up_in_file ? glm::normalize(*up_in_file)
                                   : retarget::up_of_motion(motion, found).axis;
  Status ok = Done{};
  switch (neutral.kind) {
    case NeutralKind::kAuto: {
      if (retarget::stands_at_rest(motion.skeleton, found)) return NeutralKind::kRest;
      const auto* const known = retarget::named_neutral(motion.skeleton);
      retarget::set_rest_t_pose(motion, found, up, known);
      return known != nullptr ? NeutralKind::kNamed : NeutralKind::kTPose;
    }
    case NeutralKind::kRest:
      ok = check_stands(motion, found, "the file's rest");
      break;
    case NeutralKind::kTPose:
    case NeutralKind::kNamed:
      retarget::set_rest_t_pose(motion, found, up, neutral.named);
      break;
    case NeutralKind::kFrame:
      ok = take_frame(neutral.frame, found, up, motion);
      break;
    case NeutralKind::kFile:
      ok = take_file(neutral.file, found, up, motion);
      break;
  }
  if (!ok) return ok.error();
  return neutral.kind;
}

std::string neutral_mistake(const std::string& word) {
  const auto neutral = read_neutral(word);
  return neutral ? "" : neutral.error().cause + "; " + neutral.error().next;
}

}  // namespace marey::app
