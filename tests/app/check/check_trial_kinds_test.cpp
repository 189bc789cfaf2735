// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/check/check_trial_kinds.h"

#include <gtest/gtest.h>

#include "tests/support/bodies/synthetic_person.h"

namespace marey::app {
namespace {

using recordings::Session;
using recordings::Trial;
using recordings::TrialKind;
using testing::Movement;

/// A session of a person in a room of cameras, with the detections.
struct Recorded {
  Body body = testing::tagged_person();
  std::vector<Camera> cameras = testing::ring_of_cameras();
  Session session;
  std::map<std::string, std::vector<CameraDetections>> found;

  Recorded() {
    session.file = "session.toml";
    session.tags = testing::tags_of(body);
  }

  void add(const std::string& name, TrialKind kind, const Movement& movement) {
    Trial trial;
    trial.name = name;
    trial.kind = kind;
    session.trials.push_back(trial);
    testing::Film film;
    film.trial = name;
    film.frames = 40;
    film.hz = 10.0;
    found[name] = testing::film(body, movement, cameras, film);
  }
};

TEST(AssessExercise, ReportsATrialThatStaysInOnePlace) {
  Recorded recorded;
  recorded.add("rom", TrialKind::kRangeOfMotion, testing::walking(recorded.body));
  recorded.add("walk", TrialKind::kMotion, testing::range_of_motion(recorded.body));
  const auto found = assess_range_of_motion(recorded.session, recorded.found);
  ASSERT_TRUE(found);
  EXPECT_NE(found->cause.find("in trial rom"), std::string::npos) << found->message();
  EXPECT_NE(found->next.find("the videos of rom and walk"), std::string::npos)
      << found->message();
}

TEST(AssessExercise, PassesACorrectSession) {
  Recorded recorded;
  recorded.add("rom", TrialKind::kRangeOfMotion, testing::range_of_motion(recorded.body));
  recorded.add("walk", TrialKind::kMotion, testing::walking(recorded.body));
  recorded.add("stand", TrialKind::kMotion, testing::standing(recorded.body));
  EXPECT_FALSE(assess_range_of_motion(recorded.session, recorded.found));
}

TEST(AssessExercise, PassesIfTheSubjectWalksInAllTrials) {
  Recorded recorded;
  recorded.add("rom", TrialKind::kRangeOfMotion, testing::walking(recorded.body));
  recorded.add("walk", TrialKind::kMotion, testing::walking(recorded.body));
  EXPECT_FALSE(assess_range_of_motion(recorded.session, recorded.found));
}

TEST(CheckStanding, NamesTheTrialInWhichTheSubjectDoesStandStill) {
  Recorded recorded;
  recorded.add("static", TrialKind::kStatic, testing::walking(recorded.body));
  recorded.add("walk", TrialKind::kMotion, testing::standing(recorded.body));
  const Status checked = check_standing(recorded.session, recorded.found);
  ASSERT_FALSE(checked);
  EXPECT_NE(checked.error().message().find("exchange the videos of static and walk"),
            std::string::npos)
      << checked.error().message();
}

}  // namespace
}  // namespace marey::app
