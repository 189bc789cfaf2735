// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/motion/assess_avatar.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

#include <glm/trigonometric.hpp>
#include <glm/vec4.hpp>

#include "core/pose.h"
#include "retarget/body/normalized_skeleton.h"
#include "retarget/feet/unroll_feet.h"

namespace marey::app {
namespace {

template <class... Values>
std::string text(const char* pattern, Values... values) {
  std::array<char, 300> buffer{};
  std::snprintf(buffer.data(), buffer.size(), pattern, values...);
  return buffer.data();
}

void add(const std::string& where,
         std::string cause,
         std::string next,
         bool is_poor,
         AvatarVerdict& out) {
  out.problems.push_back({is_poor ? Severity::kPoor : Severity::kFair,
                          "avatar",
                          where,
                          std::move(cause),
                          std::move(next)});
}

void assess_skin(const std::string& name, AvatarVerdict& out) {
  const double deep_mm = 1e3 * out.beyond_source.depth_m;
  if (deep_mm <= kDeepSkin_mm) return;
  const std::optional<retarget::SkinPart> part = out.beyond_source.part;
  const std::string words =
      part ? " of the " + std::string(retarget::name(*part)) : std::string();
  add(name + ", frame " + std::to_string(*out.beyond_source.frame),
      text("the skin%s is %.0f mm below the floor, where the source is not",
           words.c_str(),
           deep_mm),
      "look at it with marey view; adapt the result with a constraint on the part that "
      "is too low, or give the body a bone map if its bones are wrong",
      deep_mm > kPoorSkin_mm,
      out);
}

void assess_direction(const std::string& name,
                      const retarget::DirectionFigures& direction,
                      double far_deg,
                      double poor_deg,
                      AvatarVerdict& out) {
  const double apart_deg = glm::degrees(direction.median_rad);
  if (apart_deg <= far_deg) return;
  const std::string segment(retarget::segment_name(direction));
  add(name,
      text("the %s points %.0f degrees away from the source's (median over frames; %.0f "
           "in frame %d)",
           segment.c_str(),
           apart_deg,
           glm::degrees(direction.worst_rad),
           *direction.worst_frame),
      "check with marey inspect --picture that the bones of both bodies are right, and "
      "that their rest poses are those of a body",
      apart_deg > poor_deg,
      out);
}

void assess_foot(const std::string& name,
                 const retarget::DirectionFigures& foot,
                 AvatarVerdict& out) {
  const double apart_deg = glm::degrees(foot.sustained_rad);
  if (apart_deg <= kFarFoot_deg) return;
  add(name + ", frame " + std::to_string(*foot.sustained_frame),
      text(
          "the %s points %.0f degrees or more away from the source's for %.2f s (at most "
          "%.0f, in frame %d)",
          std::string(retarget::segment_name(foot)).c_str(),
          apart_deg,
          retarget::kSustained_s,
          glm::degrees(foot.worst_rad),
          *foot.worst_frame),
      "look at that frame with marey view; --no-ground keeps feet as the source has them",
      apart_deg > kPoorFoot_deg,
      out);
}

void assess_posture(const std::string& name, AvatarVerdict& out) {
  const retarget::PostureFigures& posture = out.posture;
  if (posture.source_max_speed > kPoorSourceSpeed) {
    add(name + ", frame " + std::to_string(*posture.source_fastest_frame),
        text("the source motion moves its %s at %.0f body heights per second: a sample "
             "there is wrong, and it affects the frames around it",
             std::string(marey::name(posture.source_fastest_bone)).c_str(),
             posture.source_max_speed),
        "repair or cut that frame in the motion, then retarget it again",
        true,
        out);
  }
  assess_foot(name, posture.feet, out);
  if (posture.exchanged_share > kPoorExchanged) {
    add(name,
        text("left and right are exchanged in %.0f %% of the frames: its feet point "
             "backwards where the source's do not",
             100.0 * posture.exchanged_share),
        "check left and right in the bone maps of the body and of the motion, and "
        "`front`",
        true,
        out);
  }
  assess_direction(name, posture.legs, kFarPosture_deg, kPoorPosture_deg, out);
  assess_direction(name, posture.trunk, kFarPosture_deg, kPoorPosture_deg, out);
  assess_direction(name, posture.arms, kFarArms_deg, kPoorArms_deg, out);
  for (const retarget::DirectionFigures& segment : posture.segments) {
    if (segment.bone != HumanBone::kNeck) continue;
    assess_direction(name, segment, kFarPosture_deg, kPoorPosture_deg, out);
  }
  if (posture.max_speed > kPoorSpeed &&
      posture.max_speed > 2.0 * posture.source_max_speed) {
    add(name + ", frame " + std::to_string(*posture.fastest_frame),
        text("%s moves at %.0f body heights per second, the source at most at %.0f",
             std::string(marey::name(posture.fastest_bone)).c_str(),
             posture.max_speed,
             posture.source_max_speed),
        "look at that frame with marey view; without --balance or with --no-hands a "
        "jump of the posture may go away",
        true,
        out);
  }
}

/// Returns the reason for a far segment: the first step after which it was too far.
std::string reason_for(std::size_t segment, const retarget::RetargetReport& report) {
  using retarget::RetargetStep;
  for (const auto& [step, posture] : report.steps) {
    if (glm::degrees(posture.segments[segment].median_rad) <= kNamedPosture_deg) continue;
    switch (step) {
      case RetargetStep::kPosture:
        return "its bones have other proportions than the source's";
      case RetargetStep::kGround:
        return "feet are kept on the floor, with legs and hips of other proportions";
      case RetargetStep::kHands:
        return "hands touch what the source's touch, and arms are kept out of the body";
      case RetargetStep::kSkin:
        return "the skin is raised out of the floor";
    }
  }
  return "the steps were not compared";
}

void name_far_segments(const retarget::RetargetReport& report, AvatarVerdict& out) {
  for (std::size_t i = 0; i < out.posture.segments.size(); ++i) {
    const retarget::DirectionFigures& direction = out.posture.segments[i];
    if (glm::degrees(direction.median_rad) <= kNamedPosture_deg) continue;
    out.far_segments.push_back({direction, reason_for(i, report)});
  }
}

/// Reports joints that are mapped as feet although other skin touches the floor at rest.
void assess_feet(const std::string& name,
                 const Skeleton& body,
                 const retarget::BodyMap& map,
                 const retarget::Skin& skin,
                 AvatarVerdict& out) {
  using retarget::SkinPart;
  const auto world = world_from_joints(body, rest_pose(body));
  std::vector<glm::dvec4> rows(body.joints.size());
  retarget::SkinLows lows{};
  skin.lows(world, retarget::kNoSkin_m, rows, lows);
  for (int side = 0; side < 2; ++side) {
    const auto low = [&](SkinPart left) {
      return lows[retarget::index(retarget::on_side(left, side))];
    };
    const double leg_m = std::min(low(SkinPart::kLeftThigh), low(SkinPart::kLeftShank));
    const double above_m = low(SkinPart::kLeftFoot) - leg_m;
    if (leg_m >= retarget::kNoSkin_m || above_m <= kFootAboveSkin * map.leg_length_m) {
      continue;
    }
    const bool is_bare = low(SkinPart::kLeftFoot) >= retarget::kNoSkin_m;
    // Skin of a part below the leg belongs to the real foot, which was not mapped.
    const double lowest_m = *std::ranges::min_element(lows);
    const bool stays_behind = lowest_m < leg_m - kFootAboveSkin * map.leg_length_m / 4.0;
    const std::string bone(
        marey::name(side == 0 ? HumanBone::kLeftFoot : HumanBone::kRightFoot));
    const std::string& joint =
        body[*map.joint_of[index(side == 0 ? HumanBone::kLeftFoot
                                           : HumanBone::kRightFoot)]]
            .name;
    add(name,
        "the joint '" + joint + "' is mapped as " + bone + ", but " +
            (is_bare ? std::string("no skin is bound to it")
                     : text("at rest the leg's skin is %.0f mm lower than its own skin",
                            1e3 * above_m)),
        "give the body a bone map that names the foot's joint: marey inspect FILE "
        "--write-map stores one to edit",
        !is_bare || stays_behind,
        out);
  }
}

/// Reports feet that are upside down in the source; they were turned back.
void assess_source_feet(const Motion& source,
                        const retarget::BodyMap& map,
                        AvatarVerdict& out) {
  retarget::FootUnroller unroller;
  std::vector<RigidTransform> world(source.skeleton.joints.size());
  retarget::NormalizedPose posture;
  for (const Pose& pose : source.poses) {
    world_from_joints(source.skeleton, pose, world);
    retarget::normalize(map, world, posture);
    unroller.step(map, world, posture);
  }
  const retarget::RolledFeet& rolled = unroller.found();
  for (std::size_t side = 0; side < 2; ++side) {
    if (!rolled.first_frame[side]) continue;
    const HumanBone foot = side == 0 ? HumanBone::kLeftFoot : HumanBone::kRightFoot;
    add("the motion, frame " + std::to_string(*rolled.first_frame[side]),
        text("its %s is upside down against its shin in %d of %zu frames; it was turned "
             "the right way up",
             std::string(marey::name(foot)).c_str(),
             rolled.frames[side],
             source.poses.size()),
        "look at the motion there with marey view, and correct its ankle",
        false,
        out);
  }
}

/// Reads the written files again and reports bones that are not at their solved
/// positions.
Status assess_files(const Motion& made,
                    std::span<const double> allowed_m,
                    std::span<const WrittenFile> files,
                    AvatarVerdict& out) {
  for (const WrittenFile& file : files) {
    const auto reread = reread_motion(file, made);
    if (!reread) return reread.error();
    if (!*reread) continue;
    const RereadFigures& figures = **reread;
    const double off_mm = 1e3 * figures.worst_place_m;
    out.reread_off_mm = std::max(out.reread_off_mm.value_or(0.0), off_mm);
    if (off_mm > kRereadPlace_mm) {
      add(file.path.string() + ", frame " + std::to_string(*figures.worst_frame),
          text("the file has %s %.0f mm from where it was solved",
               std::string(marey::name(figures.worst_bone)).c_str(),
               off_mm),
          "do not use this file; report this as a bug, with the body's file",
          true,
          out);
    }
    const double lost_mm = 1e3 * figures.lost_m;
    if (lost_mm > kLostPlace_mm) {
      add(file.path.string() + ", frame " + std::to_string(*figures.lost_frame),
          text("the file has %s %.0f mm from where it was solved: a joint above it is no "
               "bone of VRM",
               std::string(marey::name(figures.lost_bone)).c_str(),
               lost_mm),
          "use the .glb or .bvh if this distance matters",
          false,
          out);
    }
    if (figures.lowest_skin_m.empty()) continue;
    retarget::SkinDepth deepest;
    retarget::SkinDepth beyond;
    for (std::size_t t = 0; t < figures.lowest_skin_m.size(); ++t) {
      const double depth_m = -figures.lowest_skin_m[t];
      const double beyond_m = depth_m - (t < allowed_m.size() ? allowed_m[t] : 0.0);
      const int frame = static_cast<int>(t);
      if (depth_m > deepest.depth_m) deepest = {depth_m, {}, frame};
      if (beyond_m > beyond.depth_m) beyond = {beyond_m, {}, frame};
    }
    // The depths of the file's skin are used. It has no named parts, so the part of the
    // body's skin is kept; it is unknown where the body's skin is not too low.
    if (out.skin) deepest.part = out.skin->part;
    beyond.part = out.beyond_source.part;
    out.skin = deepest;
    out.beyond_source = beyond;
  }
  return Done{};
}

}  // namespace

double AvatarVerdict::penetration_mm(const retarget::RetargetReport& report) const {
  return skin ? 1e3 * skin->depth_m : report.after.max_penetration_mm;
}

Result<AvatarVerdict> assess_avatar(const std::string& name,
                                    const Motion& source,
                                    const retarget::RetargetedMotion& made,
                                    const retarget::Skin& skin,
                                    bool grounded,
                                    std::span<const WrittenFile> files) {
  const auto source_map = retarget::map_body(source.skeleton);
  if (!source_map) return source_map.error();
  const auto map = retarget::map_body(made.motion.skeleton);
  if (!map) return map.error();
  AvatarVerdict out;
  for (const double depth_m : made.report.source_depth_m) {
    out.source_depth_m = std::max(out.source_depth_m, depth_m);
  }
  if (!skin.empty()) {
    out.skin = retarget::max_skin_depth(made.motion, skin);
    out.beyond_source =
        retarget::max_skin_depth(made.motion, skin, made.report.source_depth_m);
  }
  if (const Status ok = assess_files(made.motion, made.report.source_depth_m, files, out);
      !ok) {
    return ok.error();
  }
  out.posture = retarget::compare_postures(source, *source_map, made.motion, *map);
  name_far_segments(made.report, out);
  out.arms_in_body_mm = 1e3 * made.report.hands.arms.max_depth_after_m;
  if (!skin.empty()) assess_feet(name, made.motion.skeleton, *map, skin, out);
  assess_source_feet(source, *source_map, out);
  if (grounded) assess_skin(name, out);
  assess_posture(name, out);
  if (out.arms_in_body_mm > kDeepArms_mm) {
    add(name + ", frame " + std::to_string(*made.report.hands.arms.worst_frame),
        text("an arm is %.0f mm deeper in the body than the source's",
             out.arms_in_body_mm),
        "look at that frame with marey view",
        false,
        out);
  }
  return out;
}

}  // namespace marey::app
