// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "edit/markers/apply_marker_op.h"
#include "edit/markers/mirror_markers.h"
#include "edit/markers/render_markers.h"
#include "edit/markers/resample_markers.h"
#include <gtest/gtest.h>

#include "tests/edit/markers/marker_scene.h"

namespace marey::edit {
namespace {

MarkerState made_state(int frames = 360) {
  return *make_marker_state(made_tracks(frames));
}

TEST(MarkerState, RefusesMarkersThatCannotBeEdited) {
  EXPECT_FALSE(make_marker_state({}));
  MarkerTracks no_rate = made_tracks(10);
  no_rate.rate.hz = 0.0;
  EXPECT_FALSE(make_marker_state(no_rate));
  MarkerTracks not_finite = made_tracks(10);
  not_finite.at(7, 2)->p_in_world.z = std::numeric_limits<double>::quiet_NaN();
  const auto out = make_marker_state(not_finite);
  ASSERT_FALSE(out);
  EXPECT_NE(out.error().message().find("frame 7"), std::string::npos);
  EXPECT_NE(out.error().message().find("LKNE"), std::string::npos);
}

TEST(CutMarkers, KeepsSamplesNumbersAndTimesOfItsFrames) {
  MarkerState state = made_state();
  make_gap(state.tracks, 0, 50, 60);
  MarkerScene scene{CutOp{}};
  scene.op.span = {AtFrame{40}, AtFrame{99}};
  const auto out = scene.run(state);
  ASSERT_TRUE(out);
  ASSERT_EQ(out->frame_count(), 60);
  EXPECT_EQ(out->tracks.first_frame, 31 + 40);
  EXPECT_DOUBLE_EQ(out->tracks.start_s, state.tracks.time_s(40));
  for (std::size_t t = 0; t < 60; ++t) {
    EXPECT_EQ(out->lineage.frames[t].source_frame, 40.0 + static_cast<double>(t));
    for (std::size_t m = 0; m < 6; ++m) {
      const auto& before = state.tracks.at(t + 40, m);
      const auto& after = out->tracks.at(t, m);
      ASSERT_EQ(before.has_value(), after.has_value());
      EXPECT_TRUE(!before || before->p_in_world == after->p_in_world);
    }
  }
}

TEST(CutMarkers, KeepAndSplitGiveSeveralRecordings) {
  const MarkerState state = made_state();
  KeepOp keep;
  keep.spans = {{AtFrame{0}, AtFrame{9}}, {AtFrame{100}, AtFrame{119}}};
  const auto kept = MarkerScene{keep}.run_all(state);
  ASSERT_TRUE(kept);
  ASSERT_EQ(kept->size(), 2U);
  EXPECT_EQ((*kept)[0].frame_count(), 10);
  EXPECT_EQ((*kept)[1].tracks.first_frame, 131);
  SplitOp split;
  split.at = {AtFrame{120}};
  const auto parts = MarkerScene{split}.run_all(state);
  ASSERT_TRUE(parts);
  ASSERT_EQ(parts->size(), 2U);
  EXPECT_EQ((*parts)[0].frame_count() + (*parts)[1].frame_count(), 360);
}

TEST(CutMarkers, KeepsAnnotationsOnTheirFrames) {
  MarkerState state = made_state();
  state.annotations.notes = {{"left.strike", 0.5, 0.5}, {"late", 2.5, 2.5}};
  MarkerScene scene{CutOp{}};
  scene.op.span = {AtAnnotation{"left.strike", 0}, AtTime{1.5}};
  const auto out = scene.run(state);
  ASSERT_TRUE(out);
  ASSERT_EQ(out->annotations.notes.size(), 1U);
  EXPECT_NEAR(out->annotations.notes[0].start_s, 0.0, 1e-12);
  EXPECT_EQ(out->frame_count(), 121);
}

TEST(RetimeMarkers, ShowsTheTruePlacesBetweenFrames) {
  const MarkerState state = made_state();
  RetimeOp op;
  op.rate_hz = 250.0;
  const auto out = MarkerScene{op}.run(state);
  ASSERT_TRUE(out);
  EXPECT_EQ(out->tracks.first_frame, 1);
  EXPECT_EQ(out->tracks.start_s, 0.0);
  EXPECT_EQ(out->tracks.rate.hz, 250.0);
  // Natural splines are less exact within some frames of the ends.
  for (std::size_t t = 25; t + 25 < out->tracks.frames(); ++t) {
    for (std::size_t m = 0; m < 6; ++m) {
      const glm::dvec3 truth = made_place(m, static_cast<double>(t) / 250.0);
      EXPECT_LT(glm::distance(out->tracks.at(t, m)->p_in_world, truth), 2e-5);
    }
  }
}

TEST(RetimeMarkers, DoesNotFillGaps) {
  MarkerState state = made_state();
  make_gap(state.tracks, 2, 100, 119);
  make_gap(state.tracks, 3, 0, 49);
  ScaleTimeOp half;
  half.speed = 0.5;
  const auto out = MarkerScene{half}.run(state);
  ASSERT_TRUE(out);
  ASSERT_EQ(out->frame_count(), 719);
  for (std::size_t t = 0; t < 719; ++t) {
    // Frame t shows frame t / 2; between 99 and 100 nothing was seen.
    const bool is_in_gap = t > 198 && t < 240;
    EXPECT_EQ(out->tracks.at(t, 2).has_value(), !is_in_gap) << t;
    EXPECT_EQ(out->tracks.at(t, 3).has_value(), t >= 100) << t;
  }
  EXPECT_EQ(out->tracks.at(198, 2)->p_in_world, state.tracks.at(99, 2)->p_in_world);
}

TEST(RetimeMarkers, MeetsKnotsAndDuration) {
  const MarkerState state = made_state();
  RetimeOp op;
  op.knots = {{AtTime{1.0}, 0.5}};
  const auto out = MarkerScene{op}.run(state);
  ASSERT_TRUE(out);
  EXPECT_LT(glm::distance(out->tracks.at(60, 1)->p_in_world, made_place(1, 1.0)), 1e-9);
  RetimeOp slow;
  slow.duration_s = 6.0;
  const auto longer = MarkerScene{slow}.run(state);
  ASSERT_TRUE(longer);
  EXPECT_NEAR(longer->duration_s(), 6.0, 0.01);
}

TEST(RetimeMarkers, InterpolatedSamplesHaveTheWorseProperties) {
  MarkerState state = made_state(40);
  state.tracks.at(10, 0)->source = Source::kRepaired;
  state.tracks.at(11, 0)->sigma_m = 0.002F;
  state.tracks.at(11, 0)->cameras = 0x11;
  const std::vector<double> at_frame{10.5, 11.5};
  const MarkerState out = resample_markers(state, at_frame, 120.0);
  EXPECT_EQ(out.tracks.at(0, 0)->source, Source::kRepaired);
  EXPECT_EQ(out.tracks.at(0, 0)->sigma_m, 0.002F);
  EXPECT_EQ(out.tracks.at(0, 0)->cameras, 0x11);
  EXPECT_EQ(out.tracks.at(1, 0)->source, Source::kMeasured);
}

TEST(PlaceMarkers, TurnsTravelAndMovesTheMean) {
  const MarkerState state = made_state();
  PlaceOp op;
  op.position_xz_m = glm::dvec2(2.0, -1.0);
  op.heading_rad = 0.5 * std::numbers::pi;
  const auto out = MarkerScene{op}.run(state);
  ASSERT_TRUE(out) << out.error().message();
  EXPECT_TRUE(out->is_moved);
  glm::dvec3 first(0.0);
  glm::dvec3 last(0.0);
  for (std::size_t m = 0; m < 6; ++m) {
    first += out->tracks.at(0, m)->p_in_world / 6.0;
    last += out->tracks.at(359, m)->p_in_world / 6.0;
  }
  EXPECT_NEAR(first.x, 2.0, 1e-9);
  EXPECT_NEAR(first.z, -1.0, 1e-9);
  EXPECT_GT(last.x - first.x, 3.0);
  EXPECT_NEAR(last.z - first.z, 0.0, 1e-9);
  // Distances between markers and heights stay.
  for (std::size_t t = 0; t < 360; t += 50) {
    EXPECT_NEAR(
        glm::distance(out->tracks.at(t, 0)->p_in_world, out->tracks.at(t, 4)->p_in_world),
        glm::distance(state.tracks.at(t, 0)->p_in_world,
                      state.tracks.at(t, 4)->p_in_world),
        1e-12);
  }
}

TEST(PlaceMarkers, RefusesAHeadingThatIsNotDefined) {
  PlaceOp heading;
  heading.heading_rad = 0.0;
  MarkerState still = made_state();
  for (auto& sample : still.tracks.samples) sample->p_in_world.z = 0.0;
  const auto out = MarkerScene{heading}.run(still);
  ASSERT_FALSE(out);
  EXPECT_NE(out.error().message().find("travel only"), std::string::npos)
      << out.error().message();
  MarkerState unseen = made_state();
  for (std::size_t m = 0; m < 4; ++m) make_gap(unseen.tracks, m, 300, 359);
  EXPECT_FALSE(MarkerScene{heading}.run(unseen));
  PlaceOp position;
  position.position_xz_m = glm::dvec2(0.0);
  EXPECT_TRUE(MarkerScene{position}.run(unseen));
  for (std::size_t m = 0; m < 6; ++m) make_gap(unseen.tracks, m, 0, 0);
  EXPECT_FALSE(MarkerScene{position}.run(unseen));
}

TEST(MirrorMarkers, ExchangesSidesAndComesBackToTheBit) {
  MarkerState state = made_state();
  make_gap(state.tracks, 0, 10, 20);
  state.annotations.notes = {{"left.strike", 0.5, 0.5}};
  MarkerScene scene{MirrorOp{}};
  const auto out = scene.run(state);
  ASSERT_TRUE(out) << out.error().message();
  EXPECT_EQ(scene.figure("pairs"), 2.0);
  EXPECT_TRUE(scene.has_finding("no_counterpart"));
  EXPECT_FALSE(out->tracks.at(15, 1).has_value());
  const glm::dvec3 before = state.tracks.at(0, 0)->p_in_world;
  EXPECT_EQ(out->tracks.at(0, 1)->p_in_world, glm::dvec3(-before.x, before.y, before.z));
  EXPECT_EQ(out->annotations.notes[0].text, "right.strike");
  const auto twice = scene.run(*out);
  ASSERT_TRUE(twice);
  EXPECT_TRUE(same_samples(twice->tracks, state.tracks));
}

TEST(MirrorMarkers, RecognisesSidesOfCommonLabels) {
  const std::vector<std::string> labels{"Ann:LASI",
                                        "Ann:RASI",
                                        "Bob:LASI",
                                        "left_knee",
                                        "right_knee",
                                        "KneeL",
                                        "KneeR",
                                        "R.Heel",
                                        "L.Heel",
                                        "lank",
                                        "rank",
                                        "STRN",
                                        "RBAK",
                                        "LUMBAR"};
  const auto found = marker_counterparts(labels);
  const std::vector<std::pair<std::size_t, std::size_t>> pairs{
      {0, 1}, {3, 4}, {5, 6}, {7, 8}, {9, 10}};
  for (const auto& [a, b] : pairs) {
    EXPECT_EQ(found[a], b) << labels[a];
    EXPECT_EQ(found[b], a) << labels[b];
  }
  for (const std::size_t alone : {2, 11, 12, 13}) {
    EXPECT_FALSE(found[alone]) << labels[alone];
  }
}

TEST(MirrorMarkers, RefusesLabelsWithoutSides) {
  MarkerState state = made_state();
  state.tracks.labels = {"M1", "M2", "M3", "M4", "M5", "M6"};
  const auto out = MarkerScene{MirrorOp{}}.run(state);
  ASSERT_FALSE(out);
  EXPECT_NE(out.error().message().find("marey fit"), std::string::npos);
}

TEST(MarkerAnnotations, TagsEventsAndCurvesAreAdded) {
  const MarkerState state = made_state();
  MarkerScene tag{TagOp{"walk"}};
  tag.op.span = {AtTime{0.5}, AtTime{1.0}};
  EventOp event{"clap", AtTime{1.5}};
  CurveOp curve{"weight", {{AtFrame{0}, 0.0}, {AtFrame{359}, 1.0}}};
  auto out = tag.run(state);
  ASSERT_TRUE(out);
  out = MarkerScene{event}.run(*out);
  ASSERT_TRUE(out);
  out = MarkerScene{curve}.run(*out);
  ASSERT_TRUE(out);
  ASSERT_EQ(out->annotations.notes.size(), 2U);
  EXPECT_EQ(out->annotations.notes[1].text, "clap");
  ASSERT_EQ(out->annotations.curves.size(), 1U);
  EXPECT_EQ(out->annotations.curves[0].values.size(), 360U);
  EXPECT_TRUE(same_samples(out->tracks, state.tracks));
}

TEST(RefusedMarkerOps, NameTheOperationTheReasonAndTheNextStep) {
  const MarkerState state = made_state(40);
  const std::vector<EditOpParameters> refused{SpliceOp{},
                                              LevelOp{},
                                              PathOp{},
                                              CyclifyOp{},
                                              PlantOp{},
                                              ContactsOp{},
                                              ConstrainOp{},
                                              PoseOp{},
                                              OffsetOp{},
                                              ExaggerateOp{},
                                              JumpOp{},
                                              BalanceOp{},
                                              RetargetOp{}};
  for (const EditOpParameters& parameters : refused) {
    const auto out = MarkerScene{parameters}.run(state);
    ASSERT_FALSE(out) << name(parameters);
    const std::string message = out.error().message();
    EXPECT_NE(message.find(std::string(name(parameters)) + "@1"), std::string::npos);
    EXPECT_NE(message.find("cannot be applied to labelled markers: it"),
              std::string::npos)
        << message;
    EXPECT_NE(message.find("Next: solve the markers first (marey fit)"),
              std::string::npos);
  }
}

TEST(RenderMarkers, AppliesAllOrTheFirstOperations) {
  EditRecipe recipe;
  recipe.sources.emplace_back();
  SplitOp split;
  split.at = {AtFrame{100}};
  for (const EditOpParameters& one : {EditOpParameters(split),
                                      EditOpParameters(PlantOp{}),
                                      EditOpParameters(FilterOp{})}) {
    recipe.ops.push_back({one});
  }
  recipe.ops[1].off = true;
  const MarkerState state = made_state();
  const auto all = render_markers(recipe, state);
  ASSERT_TRUE(all) << all.error().message();
  EXPECT_EQ(all->outputs.size(), 2U);
  EXPECT_EQ(all->reports.size(), 3U);
  RenderMarkersOptions none;
  none.until = 0;
  const auto source = render_markers(recipe, state, none);
  ASSERT_TRUE(source);
  EXPECT_TRUE(same_samples(source->outputs.front().tracks, state.tracks));
  recipe.ops[1].off = false;
  recipe.ops[1].line = 12;
  RenderMarkersOptions named;
  named.recipe_file = "a.edit.toml";
  const auto failed = render_markers(recipe, state, named);
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().where, "a.edit.toml:12: plant@1");
  recipe.limits.slide_mm = 1.0;
  const auto limits = render_markers(recipe, state, named);
  ASSERT_FALSE(limits);
  EXPECT_NE(limits.error().message().find("slide_mm"), std::string::npos);
}

}  // namespace
}  // namespace marey::edit
