// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live_chain/body_handles.h"

#include <string>
#include <utility>

#include "retarget/constraints/resolve_segment.h"

namespace marey::app {
namespace {

Activation by_hand(double fade_s) {
  return {kNotByItself_s, std::nullopt, fade_s, fade_s};
}

}  // namespace

std::vector<BodyHandle> body_handles(const Skeleton& skeleton) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kWords{
      {{"head", "head"},
       {"left hand", "leftHand"},
       {"right hand", "rightHand"},
       {"left foot", "leftFoot"},
       {"right foot", "rightFoot"},
       {"hips", "hips"}}};
  std::vector<BodyHandle> handles;
  for (const auto& [id, segment] : kWords) {
    const auto joint = retarget::resolve_segment(skeleton, segment);
    if (joint) handles.push_back({id, segment, *joint});
  }
  return handles;
}

Constraint handle_constraint(const BodyHandle& handle, double fade_s) {
  Constraint out;
  out.id = handle.id;
  out.point.segment = handle.segment;
  out.goal = DistanceToPoint{};
  out.activation = by_hand(fade_s);
  return out;
}

std::vector<Constraint> foot_supports(const Skeleton& skeleton, double fade_s) {
  std::vector<Constraint> out;
  for (const char* foot : {"leftFoot", "rightFoot"}) {
    if (!retarget::resolve_segment(skeleton, foot)) continue;
    Constraint& support = out.emplace_back();
    support.id = std::string(foot) + " stands";
    support.point.segment = foot;
    support.goal = Support{};
    support.activation = by_hand(fade_s);
  }
  return out;
}

}  // namespace marey::app
