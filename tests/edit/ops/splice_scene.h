// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "edit/ops/splice.h"
#include "edit/state/move_state.h"
#include "edit/state/resample_state.h"
#include <gtest/gtest.h>

#include "tests/edit/ops/op_scene.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::edit {

/// Frames of one cycle of synthetic_walk() at 100 Hz.
inline constexpr int kSpliceCycle = 110;

/// A walk of three cycles at 100 Hz, disturbed by noise.
inline EditState splice_walk(double noise_rad = 0.0, int frames = 3 * kSpliceCycle) {
  auto walk = testing::synthetic_walk(frames, 100.0, noise_rad, 0.1 * noise_rad);
  auto state = make_edit_state(std::move(walk.motion));
  EXPECT_TRUE(state) << (state ? "" : state.error().message());
  return *std::move(state);
}

/// The frames of a state as another source.
inline EditState as_source(const EditState& state, const FrameRange& frames, int source) {
  EditState out = slice_state(state, frames);
  for (FrameLineage& entry : out.lineage.frames) entry.source = source;
  return out;
}

inline EditState moved_on_floor(EditState state, double turn_rad, glm::dvec3 to) {
  move_state(turn_about({0.3, 0.0, -0.2}, turn_rad, to), state);
  return state;
}

/// A splice with the source "next".
inline OpScene<SpliceOp> splice_scene(EditState next, SpliceOp op = {}) {
  op.source = "next";
  OpScene<SpliceOp> scene(std::move(op));
  scene.inputs.sources.emplace("next", std::move(next));
  return scene;
}

inline EditState walk_with_notes() {
  EditState walk = splice_walk(0.02);
  walk.annotations.notes = {{"walk", 0.0, 3.2}, {"clap", 1.5, 1.5}, {"clap", 2.5, 2.5}};
  walk.annotations.curves = {{"gain", std::vector<double>(330, 0.1)}};
  Constraint reach;
  reach.id = "reach";
  reach.point.segment = "leftHand";
  reach.goal = DistanceToPoint{0.0, {0.3, 1.1, 2.0}};
  reach.activation.start_s = 1.0;
  reach.activation.stop_s = 2.0;
  walk.constraints.constraints = {reach};
  return walk;
}

}  // namespace marey::edit
