// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
// fit_subject() on tags that only the fitted body can place.
#include <algorithm>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "reconstruct/subject/fit_subject.h"
#include "tests/support/bodies/synthetic_person.h"

namespace marey::reconstruct {
namespace {

using marey::testing::Film;

Result<SubjectFit> fit_placed(const Body& truth, Film standing, Film moving) {
  const auto cameras = marey::testing::ring_of_cameras();
  standing.trial = "static";
  moving.trial = "rom";
  return fit_subject(
      {"someone", truth.stature_m, {}, marey::testing::tags_of(truth)},
      cameras,
      marey::testing::film(truth, marey::testing::standing(truth), cameras, standing),
      marey::testing::film(
          truth, marey::testing::range_of_motion(truth), cameras, moving));
}

const PlacedTag* find_tag(const Body& body, TagId id) {
  const auto found = std::find_if(body.tags.begin(),
                                  body.tags.end(),
                                  [&](const PlacedTag& t) { return t.tag.id == id; });
  return found == body.tags.end() ? nullptr : &*found;
}

double off_m(const Body& found, const Body& truth, TagId id) {
  const PlacedTag* a = find_tag(found, id);
  const PlacedTag* b = find_tag(truth, id);
  EXPECT_TRUE(a && b);
  return a && b ? glm::distance(a->segment_from_tag.translation,
                                b->segment_from_tag.translation)
                : 1.0;
}

std::vector<TagId> on_segment(const Body& body, HumanBone bone) {
  std::vector<TagId> ids;
  for (const PlacedTag& tag : body.tags) {
    if (tag.tag.segment == bone) ids.push_back(tag.tag.id);
  }
  return ids;
}

TEST(FitSubject, PlacesTagsThatAreNeverSeenTogether) {
  // One of them faces forward, the other backward.
  const Body truth = marey::testing::tagged_person();
  const auto pair = on_segment(truth, HumanBone::kLeftUpperArm);
  ASSERT_EQ(pair.size(), 2U);
  const auto in_turn = [&](const TagOnSegment& tag, int frame) {
    return (tag.id == pair[0] && frame % 2 == 0) || (tag.id == pair[1] && frame % 2 == 1);
  };
  const auto found = fit_placed(truth,
                                {6, 10.0, {}, {0.1, {}, 0.0}, {}, in_turn},
                                {40, 10.0, {}, {0.1, {}, 0.0}, {}, in_turn});
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_TRUE(found->unplaced.empty());
  EXPECT_LT(off_m(found->body, truth, pair[0]), 5e-3);
  EXPECT_LT(off_m(found->body, truth, pair[1]), 5e-3);
}

TEST(FitSubject, PlacesATagOnASegmentThatTheBodyCouldDoWithout) {
  Body truth = marey::testing::tagged_person();
  // On the nape, facing back, and on the left collar bone, facing forward.
  PlacedTag nape{{TagId{90}, HumanBone::kNeck, 0.06}, {}, 0.0, 0.0, 0};
  nape.segment_from_tag = {rotation_from_vector({0.0, 0.0, glm::radians(180.0)}),
                           {0.0, 0.03, -0.07}};
  PlacedTag collar{{TagId{91}, HumanBone::kLeftShoulder, 0.06}, {}, 0.0, 0.0, 0};
  collar.segment_from_tag = {rotation_from_vector({glm::radians(180.0), 0.0, 0.0}),
                             {0.08, 0.0, 0.06}};
  truth.tags.push_back(nape);
  truth.tags.push_back(collar);
  const auto found = fit_placed(truth,
                                {6, 10.0, {}, {0.1, {}, 0.0}, {}, {}},
                                {40, 10.0, {}, {0.1, {}, 0.0}, {}, {}});
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_TRUE(found->unplaced.empty());
  // None of their joint centres is measured: priors determine their place along the bone.
  EXPECT_LT(off_m(found->body, truth, TagId{90}), 0.03);
  EXPECT_LT(off_m(found->body, truth, TagId{91}), 0.03);
}

TEST(FitSubject, IsNotLedAstrayByATagThatOneFrameShows) {
  const Body truth = marey::testing::tagged_person();
  const TagId rare = on_segment(truth, HumanBone::kLeftLowerLeg).front();
  const auto found = fit_placed(
      truth,
      {6,
       10.0,
       {},
       {0.1, {}, 0.0},
       {},
       [&](const TagOnSegment& tag, int) { return tag.id == rare; }},
      {41, 10.0, {}, {0.1, {}, 0.0}, {}, [&](const TagOnSegment& tag, int frame) {
         return tag.id == rare && frame != 17;
       }});
  ASSERT_TRUE(found) << found.error().message();
  const PlacedTag* tag = find_tag(found->body, rare);
  if (!tag) {
    EXPECT_EQ(found->unplaced, std::vector<TagId>{rare});
    return;
  }
  EXPECT_LT(tag->sigma_m, 0.05);
  EXPECT_LT(off_m(found->body, truth, rare), 0.02);
}

}  // namespace
}  // namespace marey::reconstruct
