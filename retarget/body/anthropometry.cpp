// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/body/anthropometry.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace marey::retarget {
namespace {

using B = HumanBone;

constexpr double kAverageAdultKg = 70.0;

const SegmentRow& row_of(const SegmentTable& t, B bone) {
  switch (bone) {
    case B::kHead:
      return t.head;
    case B::kHips:
      return t.trunk;
    case B::kLeftUpperArm:
    case B::kRightUpperArm:
      return t.upper_arm;
    case B::kLeftLowerArm:
    case B::kRightLowerArm:
      return t.forearm;
    case B::kLeftHand:
    case B::kRightHand:
      return t.hand;
    case B::kLeftUpperLeg:
    case B::kRightUpperLeg:
      return t.thigh;
    case B::kLeftLowerLeg:
    case B::kRightLowerLeg:
      return t.shank;
    default:
      return t.foot;
  }
}

Error bad_mass(std::string cause, std::string next) {
  return bad_input("character: masses", std::move(cause), std::move(next));
}

// Heights of the trunk's parts: omphalion and xiphoid over MIDH-CERV, with de Leva's
// lengths OMPH-MIDH, XYPH-OMPH and CERV-MIDH in mm.
constexpr SegmentTable kDeLevaFemale{{0.0668, 1.0 - 0.4841, {0.271, 0.295, 0.261}},
                                     {0.4257, 1.0 - 0.3782, {0.379, 0.361, 0.182}},
                                     {0.0255, 0.5754, {0.278, 0.26, 0.148}},
                                     {0.0138, 0.4559, {0.261, 0.257, 0.094}},
                                     {0.0056, 0.3427, {0.244, 0.208, 0.154}},
                                     {0.1478, 0.3612, {0.369, 0.364, 0.162}},
                                     {0.0481, 0.4352, {0.267, 0.263, 0.092}},
                                     {0.0129, 0.4014, {0.299, 0.279, 0.139}},
                                     0.1247 / 0.4257,
                                     181.5 / 614.8,
                                     (0.1247 + 0.1465) / 0.4257,
                                     (181.5 + 205.3) / 614.8};
constexpr SegmentTable kDeLevaMale{{0.0694, 1.0 - 0.5002, {0.303, 0.315, 0.261}},
                                   {0.4346, 1.0 - 0.4310, {0.384, 0.358, 0.197}},
                                   {0.0271, 0.5772, {0.285, 0.269, 0.158}},
                                   {0.0162, 0.4574, {0.276, 0.265, 0.121}},
                                   {0.0061, 0.3624, {0.288, 0.235, 0.184}},
                                   {0.1416, 0.4095, {0.329, 0.329, 0.149}},
                                   {0.0433, 0.4395, {0.251, 0.246, 0.102}},
                                   {0.0137, 0.4415, {0.257, 0.245, 0.124}},
                                   0.1117 / 0.4346,
                                   145.7 / 603.3,
                                   (0.1117 + 0.1633) / 0.4346,
                                   (145.7 + 215.5) / 603.3};

constexpr GyrationRadii mean(const GyrationRadii& a, const GyrationRadii& b) {
  return {0.5 * (a.sagittal + b.sagittal),
          0.5 * (a.transverse + b.transverse),
          0.5 * (a.longitudinal + b.longitudinal)};
}

constexpr SegmentRow mean(const SegmentRow& a, const SegmentRow& b) {
  return {0.5 * (a.mass_share + b.mass_share),
          0.5 * (a.com_at + b.com_at),
          mean(a.gyration, b.gyration)};
}

constexpr SegmentTable mean(const SegmentTable& a, const SegmentTable& b) {
  return {mean(a.head, b.head),
          mean(a.trunk, b.trunk),
          mean(a.upper_arm, b.upper_arm),
          mean(a.forearm, b.forearm),
          mean(a.hand, b.hand),
          mean(a.thigh, b.thigh),
          mean(a.shank, b.shank),
          mean(a.foot, b.foot),
          0.5 * (a.lower_mass + b.lower_mass),
          0.5 * (a.lower_height + b.lower_height),
          0.5 * (a.middle_mass + b.middle_mass),
          0.5 * (a.middle_height + b.middle_height)};
}

constexpr SegmentTable kDeLeva = mean(kDeLevaFemale, kDeLevaMale);

// Masses and centres of Dempster. Radii of gyration of de Leva.
constexpr SegmentTable kDempster{{0.081, 1.0, kDeLeva.head.gyration},
                                 {0.497, 0.66, kDeLeva.trunk.gyration},
                                 {0.028, 0.436, kDeLeva.upper_arm.gyration},
                                 {0.016, 0.43, kDeLeva.forearm.gyration},
                                 {0.006, 0.506, kDeLeva.hand.gyration},
                                 {0.1, 0.433, kDeLeva.thigh.gyration},
                                 {0.0465, 0.433, kDeLeva.shank.gyration},
                                 {0.0145, 0.5, kDeLeva.foot.gyration},
                                 0.5,
                                 0.5,
                                 0.75,
                                 0.75};

}  // namespace

const SegmentTable& segment_table(MassTable table) {
  switch (table) {
    case MassTable::kDempster:
      return kDempster;
    case MassTable::kDeLevaFemale:
      return kDeLevaFemale;
    case MassTable::kDeLevaMale:
      return kDeLevaMale;
    case MassTable::kDeLeva:
      return kDeLeva;
  }
  return kDeLeva;
}

Result<std::array<double, kHumanBoneCount>> weigh_segments(const MassSpec& spec) {
  const SegmentTable& table = segment_table(spec.table);
  const auto is_mass = [](double kg) { return std::isfinite(kg) && kg >= 0.0; };
  double given_kg = 0.0;
  double share_left = 0.0;
  std::size_t given = 0;
  std::string_view missing;
  for (const MassSegment& segment : kMassSegments) {
    if (const auto& kg = spec.segment_kg[index(segment.bone)]) {
      if (!is_mass(*kg)) {
        return bad_mass(
            "the mass of " + std::string(segment.name) + " is not a valid mass",
            "give it in kg, zero or more");
      }
      given_kg += *kg;
      ++given;
    } else {
      share_left += row_of(table, segment.bone).mass_share;
      if (missing.empty()) missing = segment.name;
    }
  }
  const bool all = given == kMassSegments.size();
  if (!spec.total_kg && given > 0 && !all) {
    return bad_mass("neither the total nor " + std::string(missing) + " is given",
                    "give the total, or every segment");
  }
  const double total_kg = spec.total_kg.value_or(all ? given_kg : kAverageAdultKg);
  if (!std::isfinite(total_kg) || total_kg <= 0.0) {
    return bad_mass("the total is not above zero", "give it in kg");
  }
  // Scales and sums are rounded.
  const double tolerance_kg = 1e-6 * total_kg;
  if (given_kg > total_kg + tolerance_kg || (all && given_kg < total_kg - tolerance_kg)) {
    return bad_mass("the segments do not add up to the total",
                    "correct them, or leave the total out");
  }
  std::array<double, kHumanBoneCount> kg{};
  for (const MassSegment& segment : kMassSegments) {
    const std::size_t i = index(segment.bone);
    kg[i] = spec.segment_kg[i].value_or(std::max(total_kg - given_kg, 0.0) *
                                        row_of(table, segment.bone).mass_share /
                                        std::max(share_left, 1e-12));
  }
  return kg;
}

}  // namespace marey::retarget
