// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// The live chain, from the cameras' tags to an avatar that is dragged.
#include "app/live_chain/live_chain.h"

#include <optional>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "core/humanoid.h"
#include "tests/support/bodies/synthetic_person.h"

namespace marey::app {
namespace {

constexpr int kFrames = 60;
constexpr int kHeld = 20;      // The first frame with a target for the hand.
constexpr int kReleased = 40;  // The frame that releases the hand.
constexpr double kChainRate_hz = 30.0;

/// A person who walks before four cameras, with an avatar as tall.
class DraggedLive : public ::testing::Test {
 protected:
  struct Frame {
    Pose avatar;
    glm::dvec3 hand{0.0};
    bool active = false;
  };

  void SetUp() override {
    avatar_.file = "man.glb";
    avatar_.skeleton = make_humanoid(average_proportions(1.75));
    body_ = testing::tagged_person();
    cameras_ = testing::ring_of_cameras();
    film_ = testing::film(body_,
                          testing::walking(body_),
                          cameras_,
                          {kFrames, kChainRate_hz, "walk", {}, {}, {}});
  }

  [[nodiscard]] LiveInstant instant(int frame) const {
    LiveInstant out;
    out.number = frame;
    out.time = Timestamp(static_cast<std::int64_t>(1e9 * frame / kChainRate_hz));
    for (std::size_t c = 0; c < cameras_.size(); ++c) {
      out.views.push_back({CameraId{static_cast<int>(c)},
                           out.time,
                           film_[c].frames[static_cast<std::size_t>(frame)].tags});
    }
    return out;
  }

  [[nodiscard]] glm::dvec3 hand_of(const Pose& pose) const {
    const JointIndex hand = *avatar_.skeleton.find(HumanBone::kLeftHand);
    return world_from_joints(avatar_.skeleton, pose)[index(hand)].translation;
  }

  /// With a hand dragged to this place and released, or with nothing asked.
  [[nodiscard]] std::vector<Frame> run(const std::optional<glm::dvec3>& to) const {
    LiveSettings settings;
    settings.rate = FrameRate{kChainRate_hz};
    settings.avatars = {"man.glb"};
    auto chain = LiveChain::make(body_, cameras_, {&avatar_, 1}, settings);
    EXPECT_TRUE(chain) << chain.error().message();
    std::vector<Frame> out;
    for (int i = 0; chain && i < kFrames; ++i) {
      LiveRequests requests;
      if (to && i >= kHeld && i < kReleased) {
        requests.handles.push_back({"left hand", HandleAction::kMove, *to});
      }
      if (to && i == kReleased) {
        requests.handles.push_back({"left hand", HandleAction::kStop, {}});
      }
      const LiveResult& result = chain->step(instant(i), requests);
      Frame& frame = out.emplace_back();
      frame.avatar = result.avatars[0];
      frame.hand = hand_of(frame.avatar);
      for (const HandleState& handle : result.handles) {
        if (handle.id == "left hand") frame.active = handle.active;
      }
    }
    return out;
  }

  OpenedAvatar avatar_;
  Body body_;
  std::vector<Camera> cameras_;
  std::vector<CameraDetections> film_;
};

bool are_same_poses(const Pose& a, const Pose& b) {
  return a.root_in_world == b.root_in_world && a.parent_from_joint == b.parent_from_joint;
}

TEST_F(DraggedLive, GoesWhereItIsDraggedAndItsOwnWayAgain) {
  const std::vector<Frame> free = run(std::nullopt);
  ASSERT_EQ(free.size(), static_cast<std::size_t>(kFrames));
  const auto at = [](int frame) { return static_cast<std::size_t>(frame); };
  // Half a forearm up, from where it is in the middle of it all.
  const glm::dvec3 to = free[at(30)].hand + glm::dvec3(0.0, 0.12, 0.0);
  const std::vector<Frame> dragged = run(to);
  for (int i = 0; i < kHeld; ++i) {
    EXPECT_TRUE(are_same_poses(dragged[at(i)].avatar, free[at(i)].avatar)) << i;
  }
  // In, within its fade, and there.
  EXPECT_TRUE(dragged[at(kHeld)].active);
  for (int i = 28; i < kReleased; ++i) {
    EXPECT_LT(glm::distance(dragged[at(i)].hand, to), 0.02) << i;
  }
  // Out, without a jump, and its own again to the bit.
  EXPECT_FALSE(dragged[at(kReleased)].active);
  const double before_m =
      glm::distance(dragged[at(kReleased - 1)].hand, free[at(kReleased - 1)].hand);
  const double first_m =
      glm::distance(dragged[at(kReleased)].hand, free[at(kReleased)].hand);
  EXPECT_GT(first_m, 0.5 * before_m);
  for (int i = kReleased + 10; i < kFrames; ++i) {
    EXPECT_TRUE(are_same_poses(dragged[at(i)].avatar, free[at(i)].avatar)) << i;
  }
}

TEST_F(DraggedLive, IsTheSameToTheBitWhenItIsDraggedTheSame) {
  const glm::dvec3 to(0.3, 1.3, 0.4);
  const auto once = run(to);
  const auto again = run(to);
  ASSERT_EQ(once.size(), again.size());
  for (std::size_t i = 0; i < once.size(); ++i) {
    EXPECT_TRUE(are_same_poses(once[i].avatar, again[i].avatar)) << i;
  }
}

}  // namespace
}  // namespace marey::app
