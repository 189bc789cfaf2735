// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/retarget/retarget_json.h"

#include <array>
#include <cstdio>
#include <utility>

#include <glm/trigonometric.hpp>
#include <nlohmann/json.hpp>

#include "app/motion/zmp_figures.h"
#include "app/pages/report_json.h"
#include "core/base/assert.h"
#include "retarget/body/place_masses.h"

namespace marey::app {
namespace {

using Json = nlohmann::ordered_json;

/// Returns the joints of the bones that both bodies have, in the order of bones.
std::array<std::vector<JointIndex>, 2> common_joints(const retarget::BodyMap& a,
                                                     const retarget::BodyMap& b) {
  std::array<std::vector<JointIndex>, 2> out;
  for (std::size_t bone = 0; bone < a.joint_of.size(); ++bone) {
    if (!a.joint_of[bone] || !b.joint_of[bone]) continue;
    out[0].push_back(*a.joint_of[bone]);
    out[1].push_back(*b.joint_of[bone]);
  }
  return out;
}

Json contact_list(const retarget::ContactFigures& figures) {
  Json list = Json::array();
  for (const retarget::ContactDrift& drift : figures.drifts) {
    const auto point = static_cast<std::size_t>(drift.point);
    list.push_back({{"bone", name(retarget::kContactBones[point])},
                    {"first_frame", drift.frames.first},
                    {"last_frame", drift.frames.last},
                    {"drift_mm", rounded(drift.drift_mm, 3)}});
  }
  return list;
}

/// Uses tabulated mass shares: the centre of mass does not depend on the total mass.
Result<retarget::BalanceTrack> balance_of(const Motion& motion,
                                          const retarget::BodyMap& map,
                                          const Contacts& contacts) {
  const auto masses = retarget::place_masses(motion.skeleton, map, {});
  if (!masses) return masses.error();
  return retarget::track_balance(motion, map, *masses, contacts);
}

double percent(const retarget::BalanceFigures& figures) {
  return rounded(100.0 * figures.over_share(), 2);
}

Json balance_json(const RetargetRun& run, const AvatarResult& avatar) {
  const auto source = retarget::balance_measures(run.balance);
  const auto made = retarget::balance_measures(avatar.balance, run.balance);
  const auto& report = avatar.retargeted.report.balance;
  Json out{{"kept", report.has_value()},
           {"source_over_percent", percent(source)},
           {"over_percent", percent(made)},
           {"supported_frames", made.supported_frames},
           {"lost_frames", made.lost_frames}};
  if (!report) return out;
  out["before_over_percent"] = percent(report->before);
  out["before_lost_frames"] = report->before.lost_frames;
  out["mean_off_before_mm"] = rounded(1e3 * report->kept.mean_off_before_m, 2);
  out["mean_off_mm"] = rounded(1e3 * report->kept.mean_off_m, 2);
  out["root_moved_mm"] = rounded(1e3 * report->kept.max_shift_m, 2);
  return out;
}

/// Adds the checks of the written motion.
void add_verdict(const AvatarVerdict& verdict,
                 const retarget::RetargetReport& report,
                 Json& out) {
  out["deepest_penetration_mm"] = rounded(verdict.penetration_mm(report), 3);
  out["skin"] = nullptr;
  if (verdict.skin) {
    const retarget::SkinDepth& skin = *verdict.skin;
    out["skin"] = {{"part", skin.part ? Json(retarget::name(*skin.part)) : Json(nullptr)},
                   {"frame", skin.frame ? Json(*skin.frame) : Json(nullptr)},
                   {"beyond_source_mm", rounded(1e3 * verdict.beyond_source.depth_m, 3)},
                   {"before_mm", rounded(1e3 * report.skin.before.depth_m, 3)},
                   {"body_raised_mm", rounded(1e3 * report.skin.max_root_m, 3)},
                   {"foot_raised_mm", rounded(1e3 * report.skin.max_foot_m, 3)}};
  }
  out["source_depth_mm"] = rounded(1e3 * verdict.source_depth_m, 3);
  const retarget::PostureFigures& posture = verdict.posture;
  const auto direction = [](const retarget::DirectionFigures& figures) {
    return Json{{"segment", retarget::segment_name(figures)},
                {"median_deg", rounded(glm::degrees(figures.median_rad), 2)},
                {"worst_deg", rounded(glm::degrees(figures.worst_rad), 2)},
                {"worst_frame", figures.worst_frame.value_or(-1)},
                {"sustained_deg", rounded(glm::degrees(figures.sustained_rad), 2)},
                {"sustained_frame", figures.sustained_frame.value_or(-1)}};
  };
  out["posture"] = {
      {"legs", direction(posture.legs)},
      {"arms", direction(posture.arms)},
      {"trunk", direction(posture.trunk)},
      {"feet", direction(posture.feet)},
      {"exchanged_percent", rounded(100.0 * posture.exchanged_share, 2)},
      {"fastest_heights_per_s", rounded(posture.max_speed, 3)},
      {"source_fastest_heights_per_s", rounded(posture.source_max_speed, 3)},
      {"arms_in_body_mm", rounded(verdict.arms_in_body_mm, 2)}};
  out["far_segments"] = Json::array();
  for (const FarSegment& far : verdict.far_segments) {
    Json one = direction(far.direction);
    one["because"] = far.because;
    out["far_segments"].push_back(std::move(one));
  }
  out["reread_off_mm"] = nullptr;
  if (verdict.reread_off_mm) out["reread_off_mm"] = rounded(*verdict.reread_off_mm, 4);
  out["problems"] = Json::array();
  for (const Finding& problem : verdict.problems) {
    out["problems"].push_back(problem.message());
  }
}

}  // namespace

Status measure_source(RetargetRun& run) {
  auto map = retarget::map_body(run.source.skeleton);
  if (!map) return map.error();
  run.map = *std::move(map);
  const auto paths = retarget::contact_paths(run.source, run.map);
  run.labels = retarget::label_contacts(paths, run.source.rate.hz);
  // The source's floor is where its feet rest, at any height.
  auto rest_heights_m = retarget::rest_heights_m(run.map);
  for (std::size_t side = 0; side < 2; ++side) {
    const FootContacts& foot = run.contacts.feet[side];
    if (foot.stance.empty()) continue;
    rest_heights_m[side] = foot.ankle_height_m;
    rest_heights_m[side + 2] = foot.ball_height_m;
  }
  run.figures =
      retarget::measure_contacts(paths, run.labels, rest_heights_m, run.source.rate.hz);
  auto balance = balance_of(run.source, run.map, run.contacts);
  if (!balance) return balance.error();
  run.balance = *std::move(balance);
  return Done{};
}

Status measure_avatar(const RetargetRun& run, AvatarResult& avatar) {
  const Motion& motion = avatar.retargeted.motion;
  MAREY_ASSERT(motion.poses.size() == run.source.poses.size());
  auto map = retarget::map_body(motion.skeleton);
  if (!map) return map.error();
  avatar.map = *std::move(map);
  retarget::apply_soles(avatar.soles, avatar.map);
  avatar.own_contacts = retarget::detect_contacts(motion, avatar.map);
  avatar.contacts =
      retarget::measure_contacts(retarget::contact_paths(motion, avatar.map),
                                 run.labels,
                                 retarget::rest_heights_m(avatar.map),
                                 motion.rate.hz);
  const auto joints = common_joints(run.map, avatar.map);
  const double source = retarget::mean_jerk(run.source, joints[0]) *
                        retarget::head_height_m(motion.skeleton, avatar.map) /
                        retarget::head_height_m(run.source.skeleton, run.map);
  const double jerk = retarget::mean_jerk(motion, joints[1]);
  avatar.jerk_ratio = source > 0.0 ? jerk / source : 1.0;
  auto balance = balance_of(motion, avatar.map, avatar.retargeted.report.contacts);
  if (!balance) return balance.error();
  avatar.balance = *std::move(balance);
  const auto masses = retarget::place_masses(motion.skeleton, avatar.map, {});
  if (!masses) return masses.error();
  avatar.zmp =
      motion_zmp(motion, avatar.map, avatar.retargeted.report.contacts, *masses).figures;
  return Done{};
}

Json avatar_json(const RetargetRun& run, const AvatarResult& avatar) {
  Json out{{"avatar", avatar.avatar.string()}};
  if (avatar.error) {
    out["error"] = avatar.error->message();
    return out;
  }
  if (!avatar.files.empty()) out["out"] = avatar.files.front().string();
  out["files"] = Json::array();
  for (const auto& file : avatar.files) out["files"].push_back(file.string());
  const retarget::RetargetReport& report = avatar.retargeted.report;
  out["frames"] = run.source.poses.size();
  out["rate_hz"] = run.source.rate.hz;
  out["live"] = run.live;
  out["slide_before_cm_per_s"] = report.before.mean_slide_cm_per_s;
  out["slide_after_cm_per_s"] = report.after.mean_slide_cm_per_s;
  add_verdict(avatar.verdict, report, out);
  out["unreachable_frames"] = report.ground.unreachable_frames;
  const retarget::HandReport& hands = report.hands;
  out["worst_touch_error_mm"] = rounded(1e3 * hands.worst_touch_error_m, 3);
  out["mean_touch_error_mm"] = rounded(1e3 * hands.mean_touch_error_m, 3);
  const retarget::ContactFigures& c = avatar.contacts;
  out["contacts"] = {
      {"source_slide_cm_per_s", rounded(run.figures.mean_slide_cm_per_s, 3)},
      {"slide_cm_per_s", rounded(c.mean_slide_cm_per_s, 3)},
      {"worst_drift_mm", rounded(c.worst_drift_mm, 3)},
      {"median_drift_mm", rounded(c.median_drift_mm, 3)},
      {"sinking_mm", rounded(c.sinking_mm, 3)},
      {"float_mm", rounded(c.float_mm, 3)},
      {"floating_frames", c.floating_frames},
      {"jerk_over_source", rounded(avatar.jerk_ratio, 4)},
      {"drifts", contact_list(c)}};
  out["balance"] = balance_json(run, avatar);
  out["zmp"] = zmp_json(avatar.zmp);
  return out;
}

Json retarget_json(const RetargetRun& run) {
  Json out{{"motion", run.motion.string()},
           {"frames", run.source.poses.size()},
           {"rate_hz", run.source.rate.hz},
           {"avatars", Json::array()}};
  for (const AvatarResult& avatar : run.avatars) {
    out["avatars"].push_back(avatar_json(run, avatar));
  }
  return out;
}

std::string summary_of(const AvatarResult& avatar) {
  const retarget::RetargetReport& report = avatar.retargeted.report;
  std::string files;
  for (const auto& file : avatar.files) {
    files += files.empty() ? file.string() : ", " + file.extension().string();
  }
  std::array<char, 160> text{};
  std::snprintf(text.data(),
                text.size(),
                ": %zu frames, stance feet slide %.2f cm/s (%.2f before feet were fixed "
                "to the ground), "
                "deepest skin %.1f mm",
                avatar.retargeted.motion.poses.size(),
                report.after.mean_slide_cm_per_s,
                report.before.mean_slide_cm_per_s,
                avatar.verdict.penetration_mm(report));
  return files + text.data();
}

}  // namespace marey::app
