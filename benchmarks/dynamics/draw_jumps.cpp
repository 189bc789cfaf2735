// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// draw_jumps DATA docs/figures/changed_jumps.svg
//
// Draws a captured jump, and the same jump with 0.25 and 1.75 of its rise (figure 6.12 of
// the thesis): the body at P1 to P5 and the apex, and the height of its centre of mass
// over time. DATA is the folder of the shared recordings; the jump is the rendered one.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dynamics/push/push_ends.h"
#include "edit/apply_op.h"
#include "edit/jump/planned_jump.h"

#include "benchmarks/dynamics/jump_clips.h"
#include "benchmarks/dynamics/jump_panel.h"
#include "core/human/centre_of_mass.h"

namespace marey {
namespace {

constexpr double kPictureWidth = 1200.0;
constexpr Colours kGrey{"#4c4c4c", "#6b6b6b", "#9c9c9c"};
constexpr Colours kBlue{"#155a94", "#1f77bf", "#86b8dd"};
constexpr Colours kOrange{"#b34700", "#e0681a", "#f0ae80"};

/// Returns the direction of the picture's right: bodies are seen from their right side,
/// and somewhat from the front.
glm::dvec3 right_of_view(const edit::EditState& state, double time_s) {
  const auto joints = world_from_joints(
      state.motion.skeleton,
      state.motion.poses[static_cast<std::size_t>(time_s * state.motion.rate.hz)]);
  const auto at = [&](HumanBone bone) {
    return joints[index(*state.map.joint_of[index(bone)])].translation;
  };
  glm::dvec3 left = at(HumanBone::kLeftUpperLeg) - at(HumanBone::kRightUpperLeg);
  left = glm::normalize(glm::dvec3(left.x, 0.0, left.z));
  const glm::dvec3 forward = glm::cross(left, glm::dvec3(0.0, 1.0, 0.0));
  constexpr double kTurn_rad = 0.42;
  return std::cos(kTurn_rad) * forward + std::sin(kTurn_rad) * left;
}

void find_centres(const std::vector<PointMass>& masses, ShownJump& jump) {
  for (const Pose& pose : jump.motion.poses) {
    const auto joints = world_from_joints(jump.motion.skeleton, pose);
    jump.com_in_world.push_back(centre_of_mass(masses, joints));
  }
}

/// Returns the jump with `share` of its captured rise; 1: as captured.
std::optional<ShownJump> shown_jump(const edit::EditState& state,
                                    const edit::FoundJumps& found,
                                    double share) {
  const dynamics::Jump& captured = found.jumps[found.chosen];
  JumpOp op;
  op.jump = static_cast<int>(found.chosen) + 1;
  if (share == 1.0) {
    op.gravity_m_s2 = captured.gravity_m_s2;  // Nothing changes.
  } else {
    op.apex_by_m = (share - 1.0) * captured.rise_m();
  }
  const auto reference = edit::jump_reference(found);
  if (!reference) return std::nullopt;
  const auto plan = edit::plan_of_op(op, **reference, state.motion.rate);
  if (!plan || !plan->touchdown() || !plan->rest()) return std::nullopt;
  const EditOp one{op};
  const edit::EditInputs inputs;
  edit::OpReport report;
  auto made = edit::apply_op({one, 0, inputs}, state, report);
  if (!made) return std::nullopt;
  ShownJump out;
  out.motion = std::move(made->front().motion);
  out.times_s = {plan->start_s(),
                 plan->lowest_s(),
                 plan->takeoff().time_s,
                 plan->apex_s(),
                 plan->touchdown()->time_s,
                 plan->rest()->time_s};
  out.apex_m = plan->apex_m();
  out.rise_m = plan->apex_m() - plan->takeoff().p_in_world.y;
  for (double t = plan->start_s(); t < plan->takeoff().time_s; t += 1e-3) {
    out.peak_push_g = std::max(
        out.peak_push_g,
        plan->push_g(t) * plan->gravity_m_s2() / dynamics::kStandardGravity_m_s2);
  }
  find_centres(found.masses, out);
  return out;
}

std::optional<std::string> jumps_picture(const char* data) {
  const auto clip = read_rendered_jump(data);
  if (!clip) return std::nullopt;
  const auto state = edit::make_edit_state(clip->motion);
  if (!state) return std::nullopt;
  const JumpOp any;
  const EditOp op{any};
  const edit::EditInputs inputs;
  const auto found = edit::find_state_jumps(any, {op, 0, inputs}, *state);
  if (!found) return std::nullopt;
  const auto low = shown_jump(*state, *found, 0.25);
  const auto same = shown_jump(*state, *found, 1.0);
  const auto high = shown_jump(*state, *found, 1.75);
  if (!low || !same || !high) return std::nullopt;
  const glm::dvec3 right_in_world = right_of_view(*state, same->times_s[0]);
  const std::array panels{
      JumpPanel{44.0, "0.25 of the captured rise", *low, kBlue, &*same},
      JumpPanel{434.0, "Captured", *same, kGrey},
      JumpPanel{824.0, "1.75 of the captured rise", *high, kOrange, &*same}};
  Drawing drawing;
  for (const JumpPanel& panel : panels) {
    draw_panel(drawing, state->map, right_in_world, panel);
  }
  return drawing.svg(kPictureWidth, kPictureHeight);
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: draw_jumps DATA OUT.svg\n", stderr);
    return 2;
  }
  const auto picture = marey::jumps_picture(argv[1]);
  if (!picture) {
    std::fprintf(stderr, "%s: no jump that can be changed\n", argv[1]);
    return 3;
  }
  std::ofstream out(argv[2]);
  out << *picture;
  out.close();
  if (!out) {
    std::fprintf(stderr, "%s: cannot be written\n", argv[2]);
    return 3;
  }
  return 0;
}
