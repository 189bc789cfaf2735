// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/edit/edit_recipe_file.h"

#include <cmath>
#include <string>
#include <variant>

#include <gtest/gtest.h>

#include "core/base/degrees.h"
#include "tests/support/files/text_file.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

/// Returns the parameters of an operation, from its name and its other keys.
template <class T>
T op_of(const std::string& do_and_keys) {
  const std::string text = "[[op]]\ndo = " + do_and_keys;
  const Result<EditOp> op = parse_edit_op(text, "t");
  EXPECT_TRUE(op) << (op ? "" : op.error().message()) << "\n" << text;
  if (!op || !std::holds_alternative<T>(op->parameters)) {
    ADD_FAILURE() << "another operation: " << text;
    return T{};
  }
  // Its text is canonical.
  const Result<EditOp> again = parse_edit_op(edit_op_text(*op), "t");
  EXPECT_TRUE(again) << (again ? "" : again.error().message());
  if (again) {
    EXPECT_EQ(edit_op_text(*again), edit_op_text(*op));
  }
  return std::get<T>(op->parameters);
}

EditRecipe recipe_of(const std::string& text) {
  const Result<EditRecipe> recipe = parse_edit_recipe(text, "r.edit.toml");
  EXPECT_TRUE(recipe) << (recipe ? "" : recipe.error().message());
  return recipe ? *recipe : EditRecipe{};
}

TEST(EditRecipeFile, ReadsTheWholeFile) {
  const std::string sum(64, 'B');
  const EditRecipe recipe = recipe_of(
      "format = 1\nname = \"walk.loop\"\n"
      "[[source]]\npath = \"out/walk\"\nsha256 = \"" +
      sum +
      "\"\n[[source]]\nid = \"stop\"\npath = \"stop.bvh\"\n"
      "[limits]\nslide_mm = 1\ndisplaced_mm = 30.5\nconstraint_mm = 2\n"
      "acceleration_ratio = 1.1\n"
      "[[op]]\ndo = \"cut@1\"\nfrom_s = 1.2\nto = \"left.strike[2]\"\n"
      "[[op]]\ndo = \"plant@1\"\noff = true\nwhy = \"the feet\\nslide\"\n"
      "from_frame = 3\nto_frame = 7.5\ngroups = [\"left_leg\", \"root\"]\n"
      "blend_s = 0.2\n");
  EXPECT_EQ(recipe.name, "walk.loop");
  ASSERT_EQ(recipe.sources.size(), 2U);
  EXPECT_EQ(recipe.sources[0], (EditSource{"", "out/walk", std::string(64, 'b'), 3}));
  EXPECT_EQ(recipe.sources[1], (EditSource{"stop", "stop.bvh", "", 6}));
  EXPECT_EQ(recipe.limits, (EditLimits{1.0, 30.5, 2.0, 1.1}));
  ASSERT_EQ(recipe.ops.size(), 2U);
  const EditOp& cut = recipe.ops[0];
  EXPECT_EQ(name(cut.parameters), "cut");
  EXPECT_EQ(cut.version, 1);
  EXPECT_EQ(cut.line, 14);
  EXPECT_EQ(cut.span, (EditSpan{AtTime{1.2}, AtAnnotation{"left.strike", 2}}));
  EXPECT_FALSE(cut.off);
  const EditOp& plant = recipe.ops[1];
  EXPECT_TRUE(plant.off);
  EXPECT_EQ(plant.why, "the feet\nslide");
  EXPECT_EQ(plant.span, (EditSpan{AtFrame{3.0}, AtFrame{7.5}}));
  EXPECT_EQ(plant.groups, (std::vector{EditGroup::kRoot, EditGroup::kLeftLeg}));
  EXPECT_EQ(plant.blend_s, 0.2);
}

TEST(EditRecipeFile, ARecipeWithoutOperationsIsValid) {
  const EditRecipe recipe = recipe_of("format = 1\n[source]\npath = \"a.bvh\"\n");
  EXPECT_TRUE(recipe.ops.empty());
  EXPECT_EQ(edit_recipe_text(recipe),
            "# A recipe of marey edit: docs/formats/edit_recipe.md describes its keys.\n"
            "format = 1\n\n[source]\npath = \"a.bvh\"\n");
}

TEST(EditRecipeFile, TheCanonicalTextLeavesDefaultsOut) {
  EditOp op;
  op.parameters = FilterOp{};
  EXPECT_EQ(edit_op_text(op), "[[op]]\ndo = \"filter@1\"\n");
  // A spline has no cut-off, so a value of it is not part of the text.
  op.parameters = FilterOp{FilterMethod::kGcvSpline, 3, CutoffRule::kGiven, 6.0, false};
  EXPECT_EQ(edit_op_text(op),
            "[[op]]\ndo = \"filter@1\"\norder = 3\nkeep_contacts = false\n");
}

TEST(EditRecipeFile, WritesListsWithALineForEachEntry) {
  EditOp op;
  op.parameters = KeepOp{{{AtTime{0.5}, AtFrame{90.0}}, {AtAnnotation{"x[1]", 0}, {}}}};
  EXPECT_EQ(edit_op_text(op),
            "[[op]]\ndo = \"keep@1\"\nspans = [\n"
            "  { from_s = 0.5, to_frame = 90 },\n"
            "  { from = \"x[1][0]\" },\n]\n");
}

TEST(EditRecipeFile, ReadsEveryKeyOfCuts) {
  const auto keep =
      op_of<KeepOp>("\"keep@1\"\nspans = [{from_s = 1, to_s = 2}, {to = \"a\"}]\n");
  ASSERT_EQ(keep.spans.size(), 2U);
  EXPECT_EQ(keep.spans[0], (EditSpan{AtTime{1.0}, AtTime{2.0}}));
  EXPECT_EQ(keep.spans[1], (EditSpan{std::nullopt, AtAnnotation{"a", 0}}));
  const auto split =
      op_of<SplitOp>("\"split@1\"\ninstants = [{at_s = 1}, {at_frame = 90}]\n");
  EXPECT_EQ(split.at, (std::vector<Moment>{AtTime{1.0}, AtFrame{90.0}}));
  const auto splice = op_of<SpliceOp>(
      "\"splice@1\"\nsource = \"b\"\nat_s = 2\nenter_at_frame = 4\noverlap_s = 0\n"
      "align = false\n");
  EXPECT_EQ(splice.source, "b");
  EXPECT_EQ(splice.at, Moment(AtTime{2.0}));
  EXPECT_EQ(splice.enter_at, Moment(AtFrame{4.0}));
  EXPECT_EQ(splice.overlap_s, 0.0);
  EXPECT_FALSE(splice.align);
  EXPECT_EQ(op_of<SpliceOp>("\"splice@1\"\nsource = \"b\"\n").overlap_s, std::nullopt);
}

TEST(EditRecipeFile, ReadsEveryKeyOfFilters) {
  const auto spline = op_of<FilterOp>(
      "\"filter@1\"\nmethod = \"gcv\"\norder = 3\nkeep_contacts = false\n");
  EXPECT_EQ(spline.method, FilterMethod::kGcvSpline);
  EXPECT_EQ(spline.order, 3);
  EXPECT_FALSE(spline.keep_contacts);
  const std::string butterworth = "\"filter@1\"\nmethod = \"butterworth\"\n";
  EXPECT_EQ(op_of<FilterOp>(butterworth).cutoff, CutoffRule::kWinter);
  EXPECT_EQ(op_of<FilterOp>(butterworth + "cutoff = \"yu\"\n").cutoff, CutoffRule::kYu);
  const auto given = op_of<FilterOp>(butterworth + "cutoff_hz = 6\n");
  EXPECT_EQ(given.cutoff, CutoffRule::kGiven);
  EXPECT_EQ(given.cutoff_hz, 6.0);
  const auto exaggerate =
      op_of<ExaggerateOp>("\"exaggerate@1\"\ngain = 2\nlow_hz = 0.5\nhigh_hz = 3\n");
  EXPECT_EQ(exaggerate.gain, 2.0);
  EXPECT_EQ(exaggerate.low_hz, 0.5);
  EXPECT_EQ(exaggerate.high_hz, 3.0);
}

TEST(EditRecipeFile, ReadsEveryKeyOfPlaces) {
  const auto level = op_of<LevelOp>("\"level@1\"\ntilt = false\nfloor_height_m = 0.01\n");
  EXPECT_FALSE(level.tilt);
  EXPECT_EQ(level.floor_height_m, 0.01);
  const auto place = op_of<PlaceOp>(
      "\"place@1\"\nposition_xz_m = [1, -2]\nheading_deg = 90\nat_s = 0.5\n");
  EXPECT_EQ(place.position_xz_m, glm::dvec2(1.0, -2.0));
  EXPECT_EQ(place.heading_rad, 90.0 * kRadiansPerDegree);
  EXPECT_EQ(place.at, Moment(AtTime{0.5}));
  const auto points =
      op_of<PathOp>("\"path@1\"\npoints_xz_m = [[0, 0], [1.5, 2], [3, 2]]\n");
  ASSERT_EQ(points.points_xz_m.size(), 3U);
  EXPECT_EQ(points.points_xz_m[1], glm::dvec2(1.5, 2.0));
  const auto turn =
      op_of<PathOp>("\"path@1\"\nturn_deg = -45\nlength = 1.2\nstraight = true\n");
  EXPECT_EQ(turn.turn_rad, -45.0 * kRadiansPerDegree);
  EXPECT_EQ(turn.length, 1.2);
  EXPECT_TRUE(turn.straight);
}

TEST(EditRecipeFile, ReadsEveryKeyOfTimes) {
  const auto knots = op_of<RetimeOp>(
      "\"retime@1\"\nknots = [{at_s = 0, time_s = 0}, {at = \"x\", time_s = 2.5}]\n"
      "rate_hz = 60\n");
  ASSERT_EQ(knots.knots.size(), 2U);
  EXPECT_EQ(knots.knots[1], (RetimeKnot{AtAnnotation{"x", 0}, 2.5}));
  EXPECT_EQ(knots.rate_hz, 60.0);
  EXPECT_EQ(op_of<RetimeOp>("\"retime@1\"\nspeed = 0.5\n").speed, 0.5);
  EXPECT_EQ(op_of<RetimeOp>("\"retime@1\"\nduration_s = 3\n").duration_s, 3.0);
  EXPECT_EQ(op_of<ScaleTimeOp>("\"scale_time@1\"\nspeed = 2\n").speed, 2.0);
  const auto cyclify = op_of<CyclifyOp>(
      "\"cyclify@1\"\nmin_period_s = 0.8\nmax_period_s = 1.4\ncycle_from_frame = 3\n"
      "cycle_to = \"left.strike[1]\"\ndrift = \"none\"\ncycles = 4\nforce = true\n");
  EXPECT_EQ(cyclify.min_period_s, 0.8);
  EXPECT_EQ(cyclify.max_period_s, 1.4);
  EXPECT_EQ(cyclify.from, Moment(AtFrame{3.0}));
  EXPECT_EQ(cyclify.to, Moment(AtAnnotation{"left.strike", 1}));
  EXPECT_EQ(cyclify.drift, CycleDrift::kNone);
  EXPECT_EQ(cyclify.cycles, 4);
  EXPECT_TRUE(cyclify.force);
}

TEST(EditRecipeFile, BracketsWithoutAWholeNumberBelongToTheName) {
  for (const char* const text : {"left.strike[-12]", "left.strike[2x]", "a[]", "a[ 1]"}) {
    const auto event =
        op_of<EventOp>("\"event@1\"\ntext = \"e\"\nat = \"" + std::string(text) + "\"\n");
    EXPECT_EQ(event.at, Moment(AtAnnotation{text, 0}));
  }
}

TEST(EditRecipeFile, ReadsEveryKeyOfContacts) {
  const auto contacts = op_of<ContactsOp>(
      "\"contacts@1\"\ndetect = true\nedits = [\n"
      "{do = \"set\", foot = \"right\", part = \"ball\", from_s = 1, to_s = 2},\n"
      "{do = \"move_end\", foot = \"left\", part = \"heel\", from_s = 2, to_s = 1.9}]\n");
  EXPECT_TRUE(contacts.detect);
  using Kind = ContactEdit::Kind;
  EXPECT_EQ(contacts.edits,
            (std::vector<ContactEdit>{{Kind::kSet, 1, FootPart::kBall, 1.0, 2.0},
                                      {Kind::kMoveEnd, 0, FootPart::kHeel, 2.0, 1.9}}));
  (void)op_of<PlantOp>("\"plant@1\"\n");
  (void)op_of<MirrorOp>("\"mirror@1\"\n");
  (void)op_of<CutOp>("\"cut@1\"\n");
  EXPECT_EQ(op_of<BalanceOp>("\"balance@1\"\nmode = \"horizontal\"\n").mode,
            EditBalance::kHorizontal);
  EXPECT_EQ(op_of<BalanceOp>("\"balance@1\"\nmode = \"zmp\"\n").mode, EditBalance::kZmp);
}

TEST(EditRecipeFile, ReadsEveryKeyOfJumps) {
  const auto jump = op_of<JumpOp>(
      "\"jump@1\"\njump = 2\napex_by_m = -0.1\nairtime_s = 0.5\nlength_m = 1.25\n"
      "box_m = 0.4\npush_s = 0.3\npush_start = \"squat\"\nlaw = \"thesis\"\n"
      "lowest = {at = 0.6, height_m = 0.7}\nstrength_g = 3\ngravity_m_s2 = 3.7\n"
      "ballistic = true\nkeep_momentum = false\n");
  EXPECT_EQ(jump.jump, 2);
  EXPECT_FALSE(jump.apex_m || jump.landing_in_world);
  EXPECT_EQ(jump.apex_by_m, -0.1);
  EXPECT_EQ(jump.airtime_s, 0.5);
  EXPECT_EQ(jump.length_m, 1.25);
  EXPECT_EQ(jump.box_m, 0.4);
  EXPECT_EQ(jump.push_s, 0.3);
  EXPECT_EQ(jump.push_start, Moment(AtAnnotation{"squat", 0}));
  EXPECT_EQ(jump.law, EditPushLaw::kThesis);
  EXPECT_EQ(jump.lowest, (EditLowestPoint{0.6, 0.7}));
  EXPECT_EQ(jump.strength_g, 3.0);
  EXPECT_EQ(jump.gravity_m_s2, 3.7);
  EXPECT_TRUE(jump.ballistic);
  EXPECT_FALSE(jump.keep_momentum);
  const auto landing =
      op_of<JumpOp>("\"jump@1\"\napex_m = 1.4\nland_m = [0.1, 0.4, 2]\n");
  EXPECT_EQ(landing.apex_m, 1.4);
  EXPECT_EQ(landing.landing_in_world, glm::dvec3(0.1, 0.4, 2.0));
}

TEST(EditRecipeFile, AJumpWithoutKeysHasTheDefaults) {
  const auto jump = op_of<JumpOp>("\"jump@1\"\n");
  EXPECT_EQ(jump.jump, 1);
  EXPECT_FALSE(jump.apex_m || jump.apex_by_m || jump.airtime_s || jump.length_m);
  EXPECT_FALSE(jump.landing_in_world || jump.box_m || jump.push_s || jump.push_start);
  EXPECT_EQ(jump.law, EditPushLaw::kForce);
  EXPECT_EQ(jump.gravity_m_s2, 9.81);
  EXPECT_FALSE(jump.ballistic);
  EXPECT_TRUE(jump.keep_momentum);
}

TEST(EditRecipeFile, ReadsEveryKeyOfPoses) {
  const auto pose = op_of<PoseOp>(
      "\"pose@1\"\nat = \"grasp\"\nbone = \"rightHand\"\nrotation_deg = [0, 90, 0]\n"
      "moved_m = [0.1, 0, -0.2]\nwidth_s = 0.4\n");
  EXPECT_EQ(pose.at, Moment(AtAnnotation{"grasp", 0}));
  EXPECT_EQ(pose.bone, HumanBone::kRightHand);
  ASSERT_TRUE(pose.rotation);
  EXPECT_NEAR(pose.rotation->w, std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(pose.rotation->y, std::sqrt(0.5), 1e-15);
  EXPECT_EQ(pose.moved_m, glm::dvec3(0.1, 0.0, -0.2));
  EXPECT_EQ(pose.width_s, 0.4);
  const auto offset = op_of<OffsetOp>(
      "\"offset@1\"\nbone = \"head\"\nrotation_wxyz = [0.6, 0, 0.8, 0]\n");
  EXPECT_EQ(offset.bone, HumanBone::kHead);
  EXPECT_EQ(offset.rotation, glm::dquat(0.6, 0.0, 0.8, 0.0));
  EXPECT_FALSE(offset.moved_m);
}

TEST(EditRecipeFile, ReadsEveryKeyOfAnnotations) {
  EXPECT_EQ(op_of<TagOp>("\"tag@1\"\ntext = \"locomotion:walk\"\n").text,
            "locomotion:walk");
  const auto event = op_of<EventOp>("\"event@1\"\ntext = \"grasp\"\nat_s = 1.5\n");
  EXPECT_EQ(event.text, "grasp");
  EXPECT_EQ(event.at, Moment(AtTime{1.5}));
  const auto curve = op_of<CurveOp>(
      "\"curve@1\"\nname = \"w\"\nkeys = [{at_s = 0, value = 0}, {at_s = 1, value = "
      "-2}]\n");
  EXPECT_EQ(curve.name, "w");
  EXPECT_EQ(curve.keys, (std::vector<CurveKey>{{AtTime{0.0}, 0.0}, {AtTime{1.0}, -2.0}}));
  const auto retarget =
      op_of<RetargetOp>("\"retarget@1\"\navatar = \"a.glb\"\nkeep_world = true\n");
  EXPECT_EQ(retarget.avatar, "a.glb");
  EXPECT_TRUE(retarget.keep_world);
}

TEST(EditRecipeFile, ReadsAConstraintWithTheWordsOfItsFile) {
  const auto op = op_of<ConstrainOp>(
      "\"constrain@1\"\nadapt = true\n[op.constraint]\ntype = \"Distance\"\n"
      "name = \"grip\"\nsegment = \"rightHand\"\noffset_m = [0.1, 0, 0]\npriority = 3\n"
      "accuracy_m = 0.002\nrange = 4\nstart = \"grasp\"\nstop_frame = 90\n"
      "start_duration_s = 0.3\nstop_duration_s = 0.4\ndistance_m = 0.05\n"
      "position_m = [0.4, 1.1, 0.6]\n");
  EXPECT_TRUE(op.adapt);
  ASSERT_TRUE(op.constraint);
  const Constraint& constraint = *op.constraint;
  EXPECT_EQ(constraint.id, "grip");
  EXPECT_EQ(constraint.point.segment, "rightHand");
  EXPECT_EQ(constraint.point.offset_in_t_pose, glm::dvec3(0.1, 0.0, 0.0));
  EXPECT_EQ(constraint.importance, 3.0);
  EXPECT_EQ(constraint.precision_m, 0.002);
  EXPECT_EQ(constraint.range, 4);
  EXPECT_EQ(op.from, Moment(AtAnnotation{"grasp", 0}));
  EXPECT_EQ(op.to, Moment(AtFrame{90.0}));
  EXPECT_EQ(constraint.activation.start_duration_s, 0.3);
  EXPECT_EQ(constraint.activation.stop_duration_s, 0.4);
  const auto& goal = std::get<DistanceToPoint>(constraint.goal);
  EXPECT_EQ(goal.distance_m, 0.05);
  EXPECT_EQ(goal.p_in_world, glm::dvec3(0.4, 1.1, 0.6));
}

TEST(EditRecipeFile, ReadsChangesOfConstraints) {
  const auto op = op_of<ConstrainOp>(
      "\"constrain@1\"\ndetect = \"supports\"\nchanges = [{name = \"found leftFoot flat "
      "2\", "
      "start_s = 1.25, stop = \"left.toe_off[1]\", stop_duration_s = 0.1}, "
      "{name = \"grip\", position_m = [0.5, 1, 0]}]\n");
  EXPECT_EQ(op.detect, DetectConstraints::kSupports);
  ASSERT_EQ(op.changes.size(), 2U);
  const ConstraintChange& first = op.changes[0];
  EXPECT_EQ(first.name, "found leftFoot flat 2");
  EXPECT_EQ(first.start, Moment(AtTime{1.25}));
  EXPECT_EQ(first.stop, Moment(AtAnnotation{"left.toe_off", 1}));
  EXPECT_FALSE(first.start_duration_s || first.p_in_world);
  EXPECT_EQ(first.stop_duration_s, 0.1);
  EXPECT_EQ(op.changes[1].p_in_world, glm::dvec3(0.5, 1.0, 0.0));
}

TEST(EditRecipeFile, ReadsEveryTypeOfConstraint) {
  const auto goal_of = [](const std::string& type, const std::string& keys) {
    const auto op = op_of<ConstrainOp>(
        "\"constrain@1\"\n[op.constraint]\nname = \"c\"\nsegment = \"leftFoot\"\n"
        "start_s = 1\nstop_s = 2\ntype = \"" +
        type + "\"\n" + keys);
    EXPECT_FALSE(op.from || op.to);
    EXPECT_EQ(op.constraint->activation.start_s, 1.0);
    EXPECT_EQ(op.constraint->activation.stop_s, 2.0);
    return op.constraint->goal;
  };
  const auto body = std::get<DistanceToBody>(goal_of(
      "BodyDistance", "other_segment = \"head\"\nother_offset_m = [0, 0.1, 0]\n"));
  EXPECT_EQ(body.other.segment, "head");
  EXPECT_EQ(body.other.offset_in_t_pose, glm::dvec3(0.0, 0.1, 0.0));
  EXPECT_EQ(std::get<DistanceToConstraint>(
                goal_of("ConstraintDistance", "other_constraint = \"d\"\n"))
                .other_id,
            "d");
  const std::string box = "min_m = [-1, 0, -1]\nmax_m = [1, 2, 1]\n";
  EXPECT_EQ(std::get<AllowedSpace>(goal_of("AllowedSpace", box)).min_in_world,
            glm::dvec3(-1.0, 0.0, -1.0));
  EXPECT_EQ(std::get<ForbiddenSpace>(goal_of("ForbiddenSpace", box)).max_in_world,
            glm::dvec3(1.0, 2.0, 1.0));
  const std::string turned = "orientation_wxyz = [0.6, 0, 0.8, 0]\n";
  EXPECT_EQ(
      std::get<SegmentOrientation>(goal_of("Orientation", turned)).world_from_t_pose,
      glm::dquat(0.6, 0.0, 0.8, 0.0));
  const auto support = std::get<Support>(
      goal_of("Support", turned + "position_m = [0, 0.1, 0]\nturns = true\n"));
  EXPECT_EQ(support.footprint_in_world, glm::dvec3(0.0, 0.1, 0.0));
  EXPECT_EQ(support.world_from_t_pose, glm::dquat(0.6, 0.0, 0.8, 0.0));
  EXPECT_TRUE(support.turns);
}

TEST(EditRecipeFile, ReadsDetectedConstraints) {
  const auto touches = op_of<ConstrainOp>(
      "\"constrain@1\"\ndetect = \"touches\"\n"
      "objects = [{name = \"table\", min_m = [0, 0, 0], max_m = [1, 0.7, 1]}]\n");
  EXPECT_EQ(touches.detect, DetectConstraints::kTouches);
  ASSERT_EQ(touches.objects.size(), 1U);
  EXPECT_EQ(touches.objects[0].name, "table");
  EXPECT_EQ(touches.objects[0].max_in_world, glm::dvec3(1.0, 0.7, 1.0));
  EXPECT_EQ(op_of<ConstrainOp>("\"constrain@1\"\ndetect = \"supports\"\n").detect,
            DetectConstraints::kSupports);
}

TEST(EditRecipeFile, IsWrittenAndReadAgain) {
  const testing::ScratchFolder folder;
  EditRecipe recipe;
  recipe.name = "walk";
  recipe.sources.push_back({"", "walk.bvh", "", 0});
  recipe.ops.push_back({CutOp{}, 1, false, {AtTime{1.0}, {}}, 0.0, {}, "start", 0});
  ASSERT_TRUE(write_edit_recipe(folder / "walk.edit.toml", recipe));
  const Result<EditRecipe> read = read_edit_recipe(folder / "walk.edit.toml");
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(edit_recipe_text(*read), edit_recipe_text(recipe));
  EXPECT_FALSE(read_edit_recipe(folder / "missing.edit.toml"));
}

TEST(EditRecipeFile, ARecipeThatCannotBeReadIsNotWritten) {
  const testing::ScratchFolder folder;
  EditRecipe recipe;
  recipe.sources.push_back({"", "walk.bvh", "", 0});
  ASSERT_TRUE(write_edit_recipe(folder / "a.edit.toml", recipe));
  const std::string before = testing::read_text(folder / "a.edit.toml");
  recipe.ops.push_back({SpliceOp{}, 1, false, {}, 0.0, {}, "", 0});
  const Status written = write_edit_recipe(folder / "a.edit.toml", recipe);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().cause, "\"source\" is empty");
  EXPECT_EQ(testing::read_text(folder / "a.edit.toml"), before);
}

}  // namespace
}  // namespace marey::recordings
