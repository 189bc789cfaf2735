// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// All operations on motions of a few frames and with keys that suit no motion. Each gives
// a whole result, or a message with its name, the cause and the next step.
#include <cmath>
#include <cstddef>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "edit/render.h"
#include <gtest/gtest.h>

#include "core/edit/edit_recipe.h"
#include "tests/support/files/random_recipe.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::edit {
namespace {

/// Returns a walk of this many frames, with uncertainties.
EditState short_walk(int frames, double hz, int source = 0) {
  Motion motion = testing::synthetic_walk(frames, hz, 0.002, 0.0005).motion;
  const std::size_t joints = motion.skeleton.joints.size();
  std::vector<std::vector<JointUncertainty>> uncertainty(
      static_cast<std::size_t>(frames),
      std::vector<JointUncertainty>(joints, {0.004, Source::kMeasured, {}}));
  auto state = make_edit_state(std::move(motion), std::move(uncertainty), source);
  EXPECT_TRUE(state) << state.error().message();
  return *std::move(state);
}

bool is_finite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Checks that all parts of a state belong to its frames and are numbers.
void expect_whole(const EditState& state, const std::string& what) {
  const std::size_t frames = state.motion.poses.size();
  ASSERT_GT(frames, 0U) << what;
  EXPECT_TRUE(state.motion.rate.hz > 0.0 && std::isfinite(state.motion.rate.hz)) << what;
  EXPECT_EQ(state.lineage.frames.size(), frames) << what;
  EXPECT_EQ(state.contacts.frame_count, static_cast<int>(frames)) << what;
  EXPECT_TRUE(state.uncertainty.empty() || state.uncertainty.size() == frames) << what;
  for (const Pose& pose : state.motion.poses) {
    ASSERT_EQ(pose.parent_from_joint.size(), state.motion.skeleton.joints.size()) << what;
    ASSERT_TRUE(is_finite(pose.root_in_world)) << what;
    for (const glm::dquat& q : pose.parent_from_joint) {
      ASSERT_NEAR(glm::length(q), 1.0, 1e-6) << what;
    }
  }
  for (const auto& joints : state.uncertainty) {
    ASSERT_EQ(joints.size(), state.motion.skeleton.joints.size()) << what;
    for (const JointUncertainty& joint : joints) {
      ASSERT_TRUE(std::isfinite(joint.sigma_m)) << what;
    }
  }
  for (const FrameLineage& frame : state.lineage.frames) {
    ASSERT_TRUE(std::isfinite(frame.source_frame)) << what;
    if (frame.history) {
      ASSERT_LT(*frame.history, state.lineage.touches.size()) << what;
    }
  }
  for (const auto& foot : state.contacts.feet) {
    for (const auto* runs : {&foot.heel, &foot.ball, &foot.stance, &foot.heel_up}) {
      for (const FrameRange& run : *runs) {
        ASSERT_LE(0, run.first) << what;
        ASSERT_LE(run.first, run.last) << what;
        ASSERT_LT(run.last, static_cast<int>(frames)) << what;
      }
    }
  }
  for (const Annotation& note : state.annotations.notes) {
    ASSERT_TRUE(std::isfinite(note.start_s) && note.start_s <= note.end_s) << what;
  }
  for (const ValueCurve& curve : state.annotations.curves) {
    ASSERT_EQ(curve.values.size(), frames) << what;
    for (const double value : curve.values) ASSERT_TRUE(std::isfinite(value)) << what;
  }
}

/// Motions of `frames` frames, and an avatar, under the names of random recipes.
EditInputs inputs_of(int frames, double hz) {
  EditInputs inputs;
  inputs.sources.emplace("", short_walk(frames, hz));
  inputs.sources.emplace("s1", short_walk(frames, hz, 1));
  inputs.sources.emplace("s2", short_walk(60, 60.0, 2));
  inputs.avatars.emplace("avatar.glb", inputs.sources.at("s2").motion.skeleton);
  return inputs;
}

/// Applies one operation; expects a whole result or a message. Returns true if it worked.
bool works(EditOp op, const EditInputs& inputs, const std::string& what) {
  if (auto* retarget = std::get_if<RetargetOp>(&op.parameters)) {
    retarget->avatar = "avatar.glb";
  }
  EditRecipe recipe;
  recipe.sources = {{"", "a", "", 1}, {"s1", "b", "", 2}, {"s2", "c", "", 3}};
  recipe.ops.push_back(std::move(op));
  recipe.ops.front().line = 7;
  RenderOptions options;
  options.recipe_file = "r.edit.toml";
  const auto rendered = render(recipe, inputs, options);
  const std::string wanted =
      "r.edit.toml:7: " + std::string(name(recipe.ops.front().parameters)) + "@1";
  if (!rendered) {
    const Error& error = rendered.error();
    EXPECT_EQ(error.code, Errc::kBadInput) << what;
    EXPECT_TRUE(error.where.starts_with(wanted)) << what << ": " << error.message();
    EXPECT_FALSE(error.cause.empty()) << what << ": " << error.message();
    EXPECT_FALSE(error.next.empty()) << what << ": " << error.message();
    EXPECT_EQ(error.message().find("nan"), std::string::npos) << error.message();
    EXPECT_EQ(error.message().find("inf "), std::string::npos) << error.message();
    return false;
  }
  EXPECT_FALSE(rendered->outputs.empty()) << what;
  for (const EditState& state : rendered->outputs) expect_whole(state, what);
  for (const OpReport& report : rendered->reports) {
    for (const auto& [figure, value] : report.figures) {
      EXPECT_TRUE(std::isfinite(value)) << what << " " << figure;
    }
    for (const Finding& finding : report.findings) {
      EXPECT_FALSE(finding.cause.empty()) << what;
    }
  }
  return true;
}

/// An operation that has no optional key, at the start of the motion.
EditOp plain_op(std::string_view op_name) {
  EditOp op;
  op.parameters = *edit_op(op_name);
  std::visit(
      [](auto& parameters) {
        using Op = std::decay_t<decltype(parameters)>;
        if constexpr (std::is_same_v<Op, KeepOp>) parameters.spans.emplace_back();
        if constexpr (std::is_same_v<Op, SplitOp>) parameters.at = {AtFrame{1.0}};
        if constexpr (std::is_same_v<Op, SpliceOp>) parameters.source = "s1";
        if constexpr (std::is_same_v<Op, PlaceOp>) parameters.heading_rad = 1.0;
        if constexpr (std::is_same_v<Op, PathOp>) parameters.turn_rad = 0.5;
        if constexpr (std::is_same_v<Op, RetimeOp>) parameters.speed = 0.5;
        if constexpr (std::is_same_v<Op, ContactsOp>) parameters.detect = true;
        if constexpr (std::is_same_v<Op, ConstrainOp>) {
          parameters.detect = DetectConstraints::kSupports;
        }
        if constexpr (std::is_same_v<Op, PoseOp>) {
          parameters.bone = HumanBone::kLeftHand;
          parameters.moved_m = glm::dvec3(0.0, 0.05, 0.0);
        }
        if constexpr (std::is_same_v<Op, OffsetOp>) {
          parameters.rotation = glm::dquat(0.8, 0.6, 0.0, 0.0);
        }
        if constexpr (std::is_same_v<Op, TagOp>) parameters.text = "a";
        if constexpr (std::is_same_v<Op, EventOp>) parameters.text = "b";
        if constexpr (std::is_same_v<Op, CurveOp>) {
          parameters.name = "c";
          parameters.keys = {{AtFrame{0.0}, 2.0}};
        }
      },
      op.parameters);
  return op;
}

TEST(DegenerateMotions, EveryOperationWorksOrNamesTheReason) {
  // Which operations work on a single frame.
  std::set<std::string> on_one_frame;
  for (const int frames : {1, 2, 3, 4, 5, 7, 19, 20, 21, 60}) {
    for (const double hz : {120.0, 30.0, 1.0}) {
      const EditInputs inputs = inputs_of(frames, hz);
      for (const std::string_view op_name : edit_op_names()) {
        const std::string what = std::string(op_name) + ", " + std::to_string(frames) +
                                 " frames at " + std::to_string(hz);
        const bool worked = works(plain_op(op_name), inputs, what);
        if (frames == 1 && worked) on_one_frame.emplace(op_name);
        if (frames == 60 && hz == 120.0 && op_name != "jump" && op_name != "cyclify") {
          EXPECT_TRUE(worked) << what;
        }
      }
    }
  }
  for (const char* op_name : {"cut",
                              "keep",
                              "filter",
                              "place",
                              "mirror",
                              "plant",
                              "contacts",
                              "pose",
                              "offset",
                              "tag",
                              "event",
                              "curve"}) {
    EXPECT_TRUE(on_one_frame.contains(op_name)) << op_name;
  }
}

TEST(DegenerateMotions, SpansWithoutAFrameOrTheWrongWayRound) {
  const EditInputs inputs = inputs_of(60, 120.0);
  const std::vector<std::pair<EditSpan, const char*>> spans{
      {{AtFrame{10.25}, AtFrame{10.75}}, "between two frames"},
      {{AtFrame{10.0}, AtFrame{10.0}}, "one frame"},
      {{AtFrame{59.0}, std::nullopt}, "the last frame"},
      {{std::nullopt, AtTime{0.0}}, "the first frame"},
      {{AtFrame{20.0}, AtFrame{10.0}}, "reversed"},
      {{AtTime{2.0}, AtTime{3.0}}, "after the end"},
      {{AtAnnotation{"gone", 0}, std::nullopt}, "an annotation that does not exist"},
      {{std::nullopt, AtAnnotation{"left.strike", 7}}, "a strike that does not exist"}};
  for (const auto& [span, what] : spans) {
    const bool may_work = std::string(what).find("frame") != std::string::npos;
    for (const std::string_view op_name : edit_op_names()) {
      for (const double blend_s : {0.0, 0.1}) {
        EditOp op = plain_op(op_name);
        op.span = span;
        op.blend_s = blend_s;
        const std::string text = std::string(op_name) + " on " + what;
        EXPECT_TRUE(!works(std::move(op), inputs, text) || may_work) << text;
      }
    }
  }
}

TEST(DegenerateMotions, RandomKeysOfEveryOperation) {
  for (const int frames : {1, 2, 5, 60, 600}) {
    const EditInputs inputs = inputs_of(frames, frames == 600 ? 10.0 : 60.0);
    for (std::size_t kind = 0; kind < edit_op_names().size(); ++kind) {
      for (std::uint64_t seed = 0; seed < (frames == 600 ? 6 : 24); ++seed) {
        EditOp op = testing::random_edit_op(seed, kind);
        const std::string what = std::string(name(op.parameters)) + ", seed " +
                                 std::to_string(seed) + ", " + std::to_string(frames) +
                                 " frames";
        (void)works(std::move(op), inputs, what);
      }
    }
  }
}

}  // namespace
}  // namespace marey::edit
