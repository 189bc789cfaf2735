// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live_chain/subject_wizard.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/bodies/synthetic_person.h"

namespace marey::app {
namespace {

using live::WizardAction;
using live::WizardCamera;
using live::WizardStep;
using marey::testing::Film;

constexpr double kRate_hz = 30.0;

std::vector<Camera> shrinking_cameras() {
  std::vector<Camera> cameras = marey::testing::ring_of_cameras();
  for (Camera& camera : cameras) camera.tag_shrinkage = {0.3, 0.01};
  return cameras;
}

/// A person before a ring of cameras, who is measured by the wizard.
class Wizard : public ::testing::Test {
 protected:
  WizardSetup setup() const {
    reconstruct::SubjectPrior prior{"someone", truth_.stature_m, {}, {}};
    for (const PlacedTag& tag : truth_.tags) prior.tags.push_back(tag.tag);
    return {cameras_, std::vector<double>(cameras_.size(), 0.4), prior, {kRate_hz}};
  }

  std::vector<CameraDetections> filmed(const marey::testing::Movement& movement,
                                       double lasts_s) const {
    Film film;
    film.hz = kRate_hz;
    film.frames = static_cast<int>(lasts_s * kRate_hz);
    film.disturbance.noise_px = 0.2;
    return marey::testing::film(truth_, movement, cameras_, film);
  }

  /// Hands in everything, one instant after the other.
  void show(const std::vector<CameraDetections>& seen) {
    for (std::size_t f = 0; f < seen.front().frames.size(); ++f) {
      LiveInstant instant = next();
      for (std::size_t c = 0; c < seen.size(); ++c) {
        instant.views.push_back(
            {CameraId{static_cast<int>(c)}, instant.time, seen[c].frames[f].tags});
      }
      wizard_.process(instant);
    }
  }

  void show_nobody(double lasts_s) {
    for (int f = 0; f < static_cast<int>(lasts_s * kRate_hz); ++f)
      wizard_.process(next());
  }

  LiveInstant next() {
    LiveInstant instant;
    instant.number = number_++;
    instant.time =
        Timestamp(std::llround(1e9 * static_cast<double>(instant.number) / kRate_hz));
    return instant;
  }

  /// Up to the step of moving.
  void stand() {
    ASSERT_FALSE(wizard_.act(WizardAction::kStart));
    show(filmed(marey::testing::standing(truth_), 3.0));
    ASSERT_EQ(wizard_.step(), WizardStep::kMove);
  }

  Body truth_ = marey::testing::tagged_person();
  std::vector<Camera> cameras_ = shrinking_cameras();
  SubjectWizard wizard_{setup(), {2.5, 6.0}};
  std::int64_t number_ = 0;
};

/// Expects that the first 50 frames kept are the first 50 shown, without shrinkage.
void expect_shown(const std::vector<Camera>& cameras,
                  const std::vector<CameraDetections>& kept,
                  const std::vector<CameraDetections>& shown) {
  ASSERT_EQ(kept.size(), shown.size());
  for (std::size_t c = 0; c < kept.size(); ++c) {
    ASSERT_GE(kept[c].frames.size(), 50U);
    for (std::size_t f = 0; f < 50; ++f) {
      const auto& tags = kept[c].frames[f].tags;
      const auto& truth = shown[c].frames[f].tags;
      ASSERT_EQ(kept[c].frames[f].frame, static_cast<int>(f));
      ASSERT_EQ(tags.size(), truth.size());
      for (std::size_t t = 0; t < tags.size(); ++t) {
        EXPECT_EQ(tags[t].id, truth[t].id);
        EXPECT_EQ(tags[t].corners_px,
                  unshrunk(truth[t].corners_px, cameras[c].tag_shrinkage));
      }
    }
  }
}

// That a subject is found from such detections is claimed of fit_subject() itself.
TEST_F(Wizard, PassesTheShownDetectionsToTheSolver) {
  ASSERT_FALSE(wizard_.act(WizardAction::kStart));
  const auto stood = filmed(marey::testing::standing(truth_), 77.0 / kRate_hz);
  show(stood);
  ASSERT_EQ(wizard_.step(), WizardStep::kMove);
  const auto moved = filmed(marey::testing::range_of_motion(truth_), 7.0);
  show(moved);
  ASSERT_EQ(wizard_.step(), WizardStep::kSolve) << wizard_.ui_state().text;
  const auto material = wizard_.take_material();
  ASSERT_TRUE(material);
  EXPECT_FALSE(wizard_.take_material());
  expect_shown(cameras_, material->standing, stood);
  expect_shown(cameras_, material->moving, moved);
  for (const WizardCamera& camera : wizard_.ui_state().cameras) {
    EXPECT_GT(camera.coverage(), 0.05) << camera.name;
    EXPECT_EQ(camera.rms_px, 0.4);
  }
}

TEST_F(Wizard, AcceptsAGoodFitAndFlagsAPoorOne) {
  stand();
  show(filmed(marey::testing::range_of_motion(truth_), 7.0));
  reconstruct::SubjectFit fit{truth_, 0.5, 1.02, {}, {}, {}};
  fit.body.joint_centre_sigma_m.fill(0.002);
  SubjectWizard other = wizard_;
  wizard_.finish(fit);
  ASSERT_EQ(wizard_.step(), WizardStep::kDone);
  EXPECT_TRUE(wizard_.is_good());
  // Two bones of four limbs, residual, size, tags.
  EXPECT_EQ(wizard_.ui_state().quality.size(), 11U);
  EXPECT_FALSE(wizard_.act(WizardAction::kAccept));
  EXPECT_EQ(wizard_.step(), WizardStep::kIdle);
  wizard_.refuse_acceptance("the disk is full.");
  EXPECT_EQ(wizard_.step(), WizardStep::kDone);
  EXPECT_EQ(wizard_.ui_state().error, "the disk is full.");

  fit.body.joint_centre_sigma_m[index(HumanBone::kLeftHand)] = 0.02;
  SubjectWizard third = other;
  other.finish(fit);
  EXPECT_EQ(other.step(), WizardStep::kDone);
  EXPECT_FALSE(other.is_good());
  const auto poor =
      std::find_if(other.ui_state().quality.begin(),
                   other.ui_state().quality.end(),
                   [](const auto& one) { return one.severity != Severity::kNote; });
  EXPECT_EQ(poor->where, "left lower arm");

  fit.body.joint_centre_sigma_m.fill(0.002);
  fit.body.proportions[HumanBone::kRightFoot] *= 0.85;
  third.finish(fit);
  EXPECT_EQ(third.step(), WizardStep::kDone);
  EXPECT_FALSE(third.is_good()) << "legs of different lengths";
}

TEST_F(Wizard, RejectsStandingWhileTheSubjectMoves) {
  ASSERT_FALSE(wizard_.act(WizardAction::kStart));
  show(filmed(marey::testing::walking(truth_), 4.0));
  EXPECT_EQ(wizard_.step(), WizardStep::kStand);
  EXPECT_LT(wizard_.ui_state().progress, 0.5);
  EXPECT_NE(wizard_.ui_state().text.find("you moved"), std::string::npos);
  show(filmed(marey::testing::standing(truth_), 3.0));
  EXPECT_EQ(wizard_.step(), WizardStep::kMove);
}

TEST_F(Wizard, CountsNoProgressWhileTheSubjectIsUnseen) {
  ASSERT_FALSE(wizard_.act(WizardAction::kStart));
  show_nobody(10.0);
  EXPECT_EQ(wizard_.step(), WizardStep::kStand);
  EXPECT_EQ(wizard_.ui_state().progress, 0.0);
  EXPECT_NE(wizard_.ui_state().text.find("Missing: hips"), std::string::npos);
  EXPECT_TRUE(wizard_.act(WizardAction::kNext));
  show(filmed(marey::testing::standing(truth_), 3.0));
  ASSERT_EQ(wizard_.step(), WizardStep::kMove);
  const double progress = wizard_.ui_state().progress;
  show_nobody(30.0);
  EXPECT_EQ(wizard_.step(), WizardStep::kMove);
  EXPECT_EQ(wizard_.ui_state().progress, progress);
}

TEST_F(Wizard, APartThatIsNeverSeenIsWaitedForButNotForEver) {
  const auto without = [](std::vector<CameraDetections> seen, const Body& body) {
    for (CameraDetections& camera : seen) {
      for (FrameDetections& frame : camera.frames) {
        std::erase_if(frame.tags, [&](const TagDetection& one) {
          return std::any_of(body.tags.begin(), body.tags.end(), [&](const auto& tag) {
            return tag.tag.id == one.id && tag.tag.segment == HumanBone::kLeftFoot;
          });
        });
      }
    }
    return seen;
  };
  ASSERT_FALSE(wizard_.act(WizardAction::kStart));
  show(without(filmed(marey::testing::standing(truth_), 3.0), truth_));
  show(without(filmed(marey::testing::range_of_motion(truth_), 9.0), truth_));
  EXPECT_EQ(wizard_.step(), WizardStep::kMove);
  EXPECT_LT(wizard_.ui_state().progress, 1.0);
  EXPECT_NE(wizard_.ui_state().text.find("Missing: left foot."), std::string::npos)
      << wizard_.ui_state().text;
  show(without(filmed(marey::testing::range_of_motion(truth_), 4.0), truth_));
  EXPECT_EQ(wizard_.step(), WizardStep::kSolve);
}

TEST_F(Wizard, AllowsNextOnceThereIsEnoughMaterial) {
  stand();
  show(filmed(marey::testing::range_of_motion(truth_), 3.0));
  EXPECT_TRUE(wizard_.act(WizardAction::kNext));
  show(filmed(marey::testing::range_of_motion(truth_), 2.5));
  EXPECT_FALSE(wizard_.act(WizardAction::kNext));
  EXPECT_EQ(wizard_.step(), WizardStep::kSolve);
}

TEST_F(Wizard, FailsWithAdviceWhenEndedEarly) {
  wizard_.end();
  EXPECT_EQ(wizard_.step(), WizardStep::kIdle);
  ASSERT_FALSE(wizard_.act(WizardAction::kStart));
  wizard_.end();
  EXPECT_EQ(wizard_.step(), WizardStep::kFailed);
  EXPECT_NE(wizard_.ui_state().error.find("Next: "), std::string::npos);
  stand();
  wizard_.end();
  EXPECT_EQ(wizard_.step(), WizardStep::kFailed);
  EXPECT_FALSE(wizard_.take_material());
}

TEST_F(Wizard, ReportsAFailedFitAndRestarts) {
  stand();
  show(filmed(marey::testing::range_of_motion(truth_), 7.0));
  ASSERT_TRUE(wizard_.take_material());
  wizard_.finish(bad_input("", "the limbs are absurd", "measure the tags"));
  EXPECT_EQ(wizard_.step(), WizardStep::kFailed);
  EXPECT_NE(wizard_.ui_state().error.find("measure the tags"), std::string::npos);
  EXPECT_TRUE(wizard_.act(WizardAction::kAccept));
  EXPECT_FALSE(wizard_.act(WizardAction::kStart));
  EXPECT_EQ(wizard_.step(), WizardStep::kStand);
  EXPECT_TRUE(wizard_.ui_state().error.empty());
}

TEST_F(Wizard, DiscardsTheMaterialOnCancel) {
  stand();
  show(filmed(marey::testing::range_of_motion(truth_), 7.0));
  EXPECT_TRUE(wizard_.act(WizardAction::kStart));
  EXPECT_FALSE(wizard_.act(WizardAction::kCancel));
  EXPECT_EQ(wizard_.step(), WizardStep::kIdle);
  EXPECT_FALSE(wizard_.take_material());
  wizard_.finish(bad_input("", "too late", ""));
  EXPECT_EQ(wizard_.step(), WizardStep::kIdle);
}

}  // namespace
}  // namespace marey::app
