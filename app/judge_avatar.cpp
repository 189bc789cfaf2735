// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/judge_avatar.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

#include <glm/trigonometric.hpp>

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
  out.problems.push_back(
      {{Errc::kQuality, where, std::move(cause), std::move(next)}, is_poor});
}

void judge_skin(const std::string& name, AvatarVerdict& out) {
  const double deep_mm = 1e3 * out.beyond_source.depth_m;
  if (deep_mm <= kDeepSkin_mm) return;
  const std::string part(retarget::name(out.beyond_source.part));
  add(name + ", frame " + std::to_string(out.beyond_source.frame),
      text("the skin of the %s is %.0f mm below the floor, where the source is not",
           part.c_str(),
           deep_mm),
      "look at it with marey view; adapt the result with a constraint on that part, or "
      "give the body a bone map if its bones are mistaken",
      deep_mm > kPoorSkin_mm,
      out);
}

void judge_direction(const std::string& name,
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
           direction.worst_frame),
      "check with marey inspect --picture that the bones of both bodies are the right "
      "ones, and that their rest poses are postures",
      apart_deg > poor_deg,
      out);
}

void judge_posture(const std::string& name, AvatarVerdict& out) {
  const retarget::PostureFigures& posture = out.posture;
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
  judge_direction(name, posture.legs, kFarPosture_deg, kPoorPosture_deg, out);
  judge_direction(name, posture.trunk, kFarPosture_deg, kPoorPosture_deg, out);
  judge_direction(name, posture.arms, kFarArms_deg, kPoorArms_deg, out);
  if (posture.fastest > kPoorSpeed && posture.fastest > 2.0 * posture.source_fastest) {
    add(name + ", frame " + std::to_string(posture.fastest_frame),
        text("%s moves at %.0f body heights per second, the source at most at %.0f",
             std::string(marey::name(posture.fastest_bone)).c_str(),
             posture.fastest,
             posture.source_fastest),
        "look at that frame with marey view; without --balance or with --no-hands a "
        "jump of the posture may go away",
        true,
        out);
  }
}

}  // namespace

double AvatarVerdict::penetration_mm(const retarget::RetargetReport& report) const {
  return skin ? 1e3 * skin->depth_m : report.after.deepest_penetration_mm;
}

Result<AvatarVerdict> judge_avatar(const std::string& name,
                                   const Motion& source,
                                   const retarget::RetargetedMotion& made,
                                   const retarget::Skin& skin,
                                   bool grounded) {
  const auto source_map = retarget::map_body(source.skeleton);
  if (!source_map) return source_map.error();
  const auto map = retarget::map_body(made.motion.skeleton);
  if (!map) return map.error();
  AvatarVerdict out;
  for (const double depth_m : made.report.source_depth_m) {
    out.source_depth_m = std::max(out.source_depth_m, depth_m);
  }
  if (!skin.empty()) {
    out.skin = retarget::deepest_skin(made.motion, skin);
    out.beyond_source =
        retarget::deepest_skin(made.motion, skin, made.report.source_depth_m);
  }
  out.posture = retarget::compare_postures(source, *source_map, made.motion, *map);
  out.arms_in_body_mm = 1e3 * made.report.hands.arms.deepest_after_m;
  if (grounded) judge_skin(name, out);
  judge_posture(name, out);
  if (out.arms_in_body_mm > kDeepArms_mm) {
    add(name + ", frame " + std::to_string(made.report.hands.arms.worst_frame),
        text("an arm is %.0f mm deeper in the body than the source's",
             out.arms_in_body_mm),
        "look at that frame with marey view",
        false,
        out);
  }
  return out;
}

}  // namespace marey::app
