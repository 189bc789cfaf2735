// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "recordings/body/mannequin_figure.h"

namespace marey::recordings {
namespace {

using B = HumanBone;

constexpr std::size_t kLimbSegments = 20;

struct LimbShape {
  std::array<B, 3> bones;             ///< Upper, lower, end.
  std::span<const Section> sections;  ///< at: 0 upper, 1 lower, 2 end joint.
  double blend;                       ///< Half the length over which the limb bends.
};

SkinWeights limb_skin(
    const LimbShape& limb, double at, double upper_m, double lower_m, double blend_m) {
  const double past_middle_m = at < 1.0 ? (at - 1.0) * upper_m : (at - 1.0) * lower_m;
  const double lower = ease(-blend_m, blend_m, past_middle_m);
  // The wrist's skin already contains half of the hand's rotation.
  const double end = 0.5 * ease(1.7, 2.0, at);
  return carried_by({{limb.bones[0], 1.0 - lower},
                     {limb.bones[1], lower * (1.0 - end)},
                     {limb.bones[2], lower * end}});
}

void add_limb(Figure& figure, const LimbShape& limb) {
  const glm::dvec3 upper = figure.at(limb.bones[1]) - figure.at(limb.bones[0]);
  const glm::dvec3 lower = figure.at(limb.bones[2]) - figure.at(limb.bones[1]);
  const glm::dvec3 fallback(0, -1, 0);
  const glm::dvec3 upper_along = direction(upper, fallback);
  const glm::dvec3 lower_along = direction(lower, upper_along);
  const double blend_m = limb.blend * figure.thickness_m;
  std::vector<Ring> rings;
  for (const double at : places_along(limb.sections, 26)) {
    const Section section = section_at(limb.sections, at);
    Ring ring;
    ring.skin = limb_skin(limb, at, glm::length(upper), glm::length(lower), blend_m);
    const double bent = ease(0.85, 1.15, at);
    ring.along = direction(glm::mix(upper_along, lower_along, bent), upper_along);
    ring.front = unit_across({0, 0, 1}, ring.along);
    ring.centre = figure.at(limb.bones[1]) + (at < 1.0 ? upper : lower) * (at - 1.0) +
                  section.shift * figure.thickness_m * ring.front;
    ring.half_width = section.half_width * figure.thickness_m;
    ring.half_depth = section.half_depth * figure.thickness_m;
    ring.part = kSkin;
    rings.push_back(ring);
  }
  (void)figure.builder.add_turned(rings, kLimbSegments);
}

/// Returns the height of a foot's sole: the floor, unless the toe joint has another
/// height.
double sole_height_m(const Figure& figure, B toes) {
  const double height_m = figure.at(toes).y - kToeJointHeight * figure.size_m;
  return std::abs(height_m) < 0.02 * figure.size_m ? 0.0 : height_m;
}

}  // namespace

void add_arm(Figure& figure, const HumanLimb& arm) {
  static constexpr std::array<Section, 11> kSections{{{-0.06, 0.018, 0.018, 0},
                                                      {0.0, 0.027, 0.027, 0},
                                                      {0.2, 0.0290, 0.0295, 0.001},
                                                      {0.5, 0.0270, 0.0285, 0.002},
                                                      {0.8, 0.0225, 0.0235, 0},
                                                      {1.0, 0.0195, 0.0195, 0},
                                                      {1.12, 0.0220, 0.0225, 0},
                                                      {1.3, 0.0240, 0.0255, 0},
                                                      {1.65, 0.0195, 0.0215, 0},
                                                      {1.92, 0.0140, 0.0175, 0},
                                                      {2.0, 0.0120, 0.0150, 0}}};
  add_limb(figure, {{arm.upper, arm.lower, arm.end}, kSections, 0.024});
  figure.add_ball(arm.upper, 0.0335);
  figure.add_ball(arm.lower, 0.0235);
  figure.add_ball(arm.end, 0.0175);
}

void add_leg(Figure& figure, const HumanLimb& leg) {
  static constexpr std::array<Section, 11> kSections{{{-0.12, 0.020, 0.026, 0},
                                                      {0.0, 0.041, 0.047, 0},
                                                      {0.18, 0.0460, 0.0520, 0},
                                                      {0.5, 0.0420, 0.0470, 0.003},
                                                      {0.8, 0.0335, 0.0360, 0.002},
                                                      {1.0, 0.0270, 0.0280, 0},
                                                      {1.12, 0.0285, 0.0305, -0.001},
                                                      {1.32, 0.0320, 0.0360, -0.006},
                                                      {1.65, 0.0245, 0.0270, -0.004},
                                                      {1.92, 0.0180, 0.0205, -0.001},
                                                      {2.0, 0.0160, 0.0180, 0}}};
  add_limb(figure, {{leg.upper, leg.lower, leg.end}, kSections, 0.032});
  figure.add_ball(leg.upper, 0.0390);
  figure.add_ball(leg.lower, 0.0320);
  figure.add_ball(leg.end, 0.0220);
}

/// A mitten with a thumb, palm down and thumb to the front in the T-pose.
void add_hand(Figure& figure, B hand, const glm::dvec3& tip_in_hand) {
  static constexpr std::array<Section, 7> kSections{{{0.0, 0.060, 0.060, 0},
                                                     {0.10, 0.085, 0.115, 0.005},
                                                     {0.30, 0.088, 0.185, 0.018},
                                                     {0.50, 0.078, 0.205, 0.020},
                                                     {0.75, 0.062, 0.190, 0.010},
                                                     {0.92, 0.045, 0.135, 0.0},
                                                     {1.0, 0.020, 0.050, 0}}};
  const double length_m = glm::length(tip_in_hand);
  Ring ring;
  ring.along = direction(tip_in_hand, {hand == B::kLeftHand ? 1.0 : -1.0, 0, 0});
  ring.front = unit_across({0, 0, 1}, ring.along);
  ring.skin = carried_by({{hand, 1.0}});
  std::vector<Ring> rings;
  for (const double at : places_along(kSections, 16)) {
    const Section section = section_at(kSections, at);
    ring.centre =
        figure.at(hand) + at * tip_in_hand + section.shift * length_m * ring.front;
    ring.half_width = section.half_width * length_m;
    ring.half_depth = section.half_depth * length_m;
    ring.exponent = 2.5;
    rings.push_back(ring);
  }
  (void)figure.builder.add_turned(rings, kLimbSegments);

  Ring thumb = ring;
  const glm::dvec3 outward = ring.front;
  thumb.along = glm::normalize(0.72 * ring.along + 0.69 * outward);
  thumb.front = unit_across(outward, thumb.along);
  thumb.centre = figure.at(hand) + length_m * (0.36 * ring.along + 0.22 * outward);
  thumb.half_width = thumb.half_depth = 0.062 * length_m;
  figure.builder.add_ellipsoid(thumb, 0.23 * length_m, 12);
}

void add_foot(Figure& figure, B foot, B toes, const glm::dvec3& tip_in_toes) {
  // at: -1 heel, 0 ankle, 1 toe joint, 2 tip. half_depth is half the height here, as a
  // fraction of the ankle's height up to the ankle, of the size beyond.
  static constexpr std::array<Section, 10> kSections{{{-1.0, 0.008, 0.20, 0},
                                                      {-0.9, 0.016, 0.34, 0},
                                                      {-0.5, 0.0225, 0.47, 0},
                                                      {0.0, 0.0240, 0.57, 0},
                                                      {0.35, 0.0260, 0.50, 0},
                                                      {0.75, 0.0300, 0.37, 0},
                                                      {1.05, 0.0310, 0.29, 0},
                                                      {1.5, 0.0280, 0.235, 0},
                                                      {1.88, 0.0190, 0.19, 0},
                                                      {2.0, 0.010, 0.13, 0}}};
  const glm::dvec3 ankle = figure.at(foot);
  const glm::dvec3 up(0, 1, 0);
  const auto level = [](glm::dvec3 v) { return glm::dvec3(v.x, 0.0, v.z); };
  const glm::dvec3 to_toes = level(figure.at(toes) - ankle);
  const glm::dvec3 to_tip = level(tip_in_toes);
  const glm::dvec3 along = direction(to_toes + to_tip, {0, 0, 1});
  const glm::dvec3 to_heel = -0.036 * figure.size_m * along;
  const double sole_m = sole_height_m(figure, toes);
  const double height_m = std::max(ankle.y - sole_m, 0.02 * figure.size_m);
  std::vector<Ring> rings;
  for (const double at : places_along(kSections, 26)) {
    const Section section = section_at(kSections, at);
    Ring ring;
    ring.centre = ankle;
    if (at < 0.0) ring.centre -= at * to_heel;
    if (at > 0.0) ring.centre += std::min(at, 1.0) * to_toes;
    if (at > 1.0) ring.centre += (at - 1.0) * to_tip;
    ring.half_depth = section.half_depth * height_m;
    ring.centre.y = sole_m + ring.half_depth;
    ring.half_width = section.half_width * figure.thickness_m;
    ring.along = along;
    ring.front = up;
    ring.exponent = 3.2;
    const double toe_part = ease(0.8, 1.2, at);
    ring.skin = carried_by({{foot, 1.0 - toe_part}, {toes, toe_part}});
    rings.push_back(ring);
  }
  (void)figure.builder.add_turned(rings, kLimbSegments);
}

}  // namespace marey::recordings
