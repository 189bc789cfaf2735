// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Faults in front of the cameras of a live run, from tags to packets: no visible person,
// people who come and go, two people, a chain that takes over from another.
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "app/live_chain/live_chain.h"
#include "app/live_chain/live_health.h"
#include "core/human/average_proportions.h"
#include "live/vmc/osc_parse.h"
#include "tests/support/bodies/synthetic_person.h"

namespace marey::app {
namespace {

using marey::testing::Movement;
using reconstruct::TrackState;

constexpr double kFaultsRate_hz = 30.0;

/// A person with tags before four cameras, and an avatar and trackers that follow.
class LiveFaults : public ::testing::Test {
 protected:
  struct Frame {
    TrackState state = TrackState::kWaiting;
    double worst_mm = 0.0;  ///< Largest distance of a limb's joint from the truth.
    int tracking = -1;      ///< Tracking state in /VMC/Ext/OK; -1: absent.
    double time_s = 0.0;    ///< VMC's T.
    Pose pose;
  };

  /// Returns the cameras' detections, instant by instant.
  [[nodiscard]] std::vector<LiveInstant> film(int frames) const {
    marey::testing::Film how;
    how.frames = frames;
    how.hz = kFaultsRate_hz;
    how.disturbance.noise_px = 0.2;
    how.offsets_s = lags_s_;
    how.hidden = hidden_;
    const auto seen = marey::testing::film(body_, movement_, cameras_, how);
    std::vector<LiveInstant> instants(static_cast<std::size_t>(frames));
    for (std::size_t f = 0; f < instants.size(); ++f) {
      instants[f].number = static_cast<std::int64_t>(f);
      instants[f].time = to_timestamp(static_cast<double>(f) / kFaultsRate_hz);
      for (std::size_t c = 0; c < cameras_.size(); ++c) {
        instants[f].views.push_back(
            {CameraId{static_cast<int>(c)}, instants[f].time, seen[c].frames[f].tags});
      }
    }
    return instants;
  }

  static Timestamp to_timestamp(double time_s) {
    return Timestamp{1'000'000'000 + std::llround(1e9 * time_s)};
  }

  [[nodiscard]] LiveChain make_chain() const {
    LiveSettings settings;
    settings.rate = {kFaultsRate_hz};
    settings.lag_known.assign(cameras_.size(), false);
    settings.avatars = {"giant.glb"};
    settings.streams = {{std::nullopt, live::VmcRest::kVrm0, {}, {}},
                        {0U, live::VmcRest::kVrm0, {}, {}}};
    settings.vrchat = true;
    settings.vmc_begin = to_timestamp(0.0);
    OpenedAvatar giant;
    giant.file = "giant.glb";
    giant.skeleton = make_humanoid(average_proportions(2.2));
    auto chain = LiveChain::make(body_, cameras_, std::vector{giant}, settings);
    EXPECT_TRUE(chain) << chain.error().message();
    return *std::move(chain);
  }

  /// Every number of every packet is finite, or this fails.
  void look_at(const LiveResult& result, Frame& frame) const {
    for (const auto& stream : result.packets) {
      for (const auto& packet : stream) {
        const bool is_sound = live::parse_osc(packet, [&](const live::OscMessage& said) {
          live::OscArguments arguments = said.arguments();
          for (const char type : said.types) {
            // read_number() has none that is not finite.
            const bool is_read = type == 's'   ? arguments.read_text().has_value()
                                 : type == 'i' ? arguments.read_int().has_value()
                                               : arguments.read_number().has_value();
            EXPECT_TRUE(is_read) << said.address;
          }
          live::OscArguments again = said.arguments();
          if (said.address == "/VMC/Ext/OK") {
            for (int i = 0; i < 3; ++i) (void)again.read_int();
            frame.tracking = again.read_int().value_or(-1);
          }
          if (said.address == "/VMC/Ext/T") frame.time_s = *again.read_number();
        });
        EXPECT_TRUE(is_sound);
      }
    }
  }

  Frame step(LiveChain& chain,
             const LiveInstant& instant,
             const LiveRequests& requests = {}) const {
    const LiveResult& result = chain.step(instant, requests);
    Frame frame;
    frame.state = result.track.state;
    look_at(result, frame);
    frame.pose = *result.pose;
    const auto truth = movement_(seconds(instant.time - to_timestamp(0.0)));
    frame.worst_mm = farthest_mm(frame.pose, truth);
    return frame;
  }

  [[nodiscard]] double farthest_mm(const Pose& a, const Pose& b) const {
    const Skeleton skeleton = make_humanoid(body_.proportions);
    const auto one = world_from_joints(skeleton, a);
    const auto other = world_from_joints(skeleton, b);
    double worst_m = 0.0;
    for (const HumanBone bone : marey::testing::limb_joints()) {
      worst_m = std::max(
          worst_m,
          glm::distance(one[index(bone)].translation, other[index(bone)].translation));
    }
    return 1e3 * worst_m;
  }

  [[nodiscard]] std::vector<Frame> follow(
      const std::vector<LiveInstant>& instants) const {
    LiveChain chain = make_chain();
    std::vector<Frame> frames;
    frames.reserve(instants.size());
    for (const LiveInstant& instant : instants) frames.push_back(step(chain, instant));
    return frames;
  }

  void hide_all(int first, int last) {
    hidden_ = [=](const TagOnSegment&, int frame) {
      return frame >= first && frame <= last;
    };
  }

  /// Returns the time from `frame` until the subject is tracked and stays within 2 cm of
  /// the result without a fault. [s]
  [[nodiscard]] double recovery_s(const std::vector<Frame>& frames,
                                  const std::vector<Frame>& unharmed,
                                  std::size_t frame) const {
    std::size_t good = frames.size();
    while (good > frame && frames[good - 1].state == TrackState::kTracked &&
           farthest_mm(frames[good - 1].pose, unharmed[good - 1].pose) < 20.0) {
      --good;
    }
    return static_cast<double>(good - frame) / kFaultsRate_hz;
  }

  void tell(const std::string& name, double value) {
    RecordProperty(name, std::to_string(value));
    std::printf("%s: %.3f\n", name.c_str(), value);
  }

  Body body_ = marey::testing::tagged_person();
  std::vector<Camera> cameras_ = marey::testing::ring_of_cameras();
  Movement movement_ = marey::testing::range_of_motion(body_);
  std::vector<double> lags_s_;
  std::function<bool(const TagOnSegment&, int)> hidden_;
};

TEST_F(LiveFaults, PosesThatDoNotKeepUpAreNotTrackedToReceivers) {
  const auto instants = film(40);
  LiveChain chain = make_chain();
  for (std::size_t f = 0; f < instants.size(); ++f) {
    LiveRequests requests;
    requests.behind = f >= 20 && f < 30;
    const Frame frame = step(chain, instants[f], requests);
    EXPECT_EQ(frame.state, TrackState::kTracked) << f;
    EXPECT_EQ(frame.tracking, requests.behind ? 0 : 1) << f;
  }
}

TEST_F(LiveFaults, TwoSecondsHiddenAreOverWithinOne) {
  const auto unharmed = follow(film(165));
  hide_all(60, 119);
  const auto frames = follow(film(165));
  EXPECT_EQ(frames[59].tracking, 1);
  EXPECT_EQ(frames[119].state, TrackState::kLost);
  EXPECT_EQ(frames[119].tracking, 0);
  EXPECT_EQ(frames.back().tracking, 1);
  const double took_s = recovery_s(frames, unharmed, 120);
  tell("back_after_s", took_s);
  EXPECT_LE(took_s, 1.0);
}

TEST_F(LiveFaults, ASubjectReturningElsewhereIsFollowedWithinASecond) {
  const Movement before = movement_;
  const RigidTransform moved{rotation_from_vector({0.0, 2.5, 0.0}), {0.4, 0.0, 0.5}};
  const Movement elsewhere = [=](double time_s) {
    Pose pose = before(time_s);
    pose.root_in_world = moved * pose.root_in_world;
    pose.parent_from_joint[0] = moved.rotation * pose.parent_from_joint[0];
    return pose;
  };
  movement_ = elsewhere;
  const auto unharmed = follow(film(165));
  movement_ = [=](double time_s) { return (time_s < 2.5 ? before : elsewhere)(time_s); };
  hide_all(30, 119);
  const auto frames = follow(film(165));
  EXPECT_EQ(frames[119].tracking, 0);
  const double took_s = recovery_s(frames, unharmed, 120);
  tell("followed_after_s", took_s);
  EXPECT_LE(took_s, 1.0);
}

// Removes the first camera, whose clock times the frames, or the camera that sees most.
TEST_F(LiveFaults, ACameraThatIsGoneForThreeSecondsIsDoneWithout) {
  const auto instants = film(180);
  const auto unharmed = follow(instants);
  for (const std::size_t gone : {std::size_t{0}, std::size_t{2}}) {
    auto lacking = instants;
    for (std::size_t f = 30; f < 120; ++f) {
      auto& views = lacking[f].views;
      views.erase(views.begin() + static_cast<std::ptrdiff_t>(gone));
    }
    const auto frames = follow(lacking);
    double worst_mm = 0.0;
    for (std::size_t f = 30; f < 120; ++f) {
      EXPECT_EQ(frames[f].tracking, 1) << f;
      worst_mm = std::max(worst_mm, farthest_mm(frames[f].pose, unharmed[f].pose));
    }
    tell("off_mm_without_camera_" + std::to_string(gone), worst_mm);
    const double took_s = recovery_s(frames, unharmed, 120);
    tell("as_before_after_s", took_s);
    EXPECT_LE(took_s, 1.0);
  }
}

TEST_F(LiveFaults, CamerasInAnotherOrderAreDetected) {
  auto instants = film(120);
  LiveChain right = make_chain();
  UnmatchedTagsDetector never(body_);
  for (const LiveInstant& instant : instants) {
    never.add(instant, right.step(instant, {}).track);
    EXPECT_FALSE(never.has_unmatched()) << instant.number;
  }
  LiveChain chain = make_chain();
  UnmatchedTagsDetector seen(body_);
  for (LiveInstant& instant : instants) {
    std::swap(instant.views[0].tags, instant.views[2].tags);
    seen.add(instant, chain.step(instant, {}).track);
  }
  EXPECT_TRUE(seen.has_unmatched());
  // An empty scene has no unmatched tags.
  UnmatchedTagsDetector nobody(body_);
  for (LiveInstant& instant : instants) {
    for (CameraTags& view : instant.views) view.tags.clear();
    nobody.add(instant, {});
  }
  EXPECT_FALSE(nobody.has_unmatched());
}

// Adds another person in a suit of other tags. A second run has, for one second, a person
// whose suit has the same numbers. This person's tag replaces a fifth of the tags that
// show on both, a different fifth in every picture.
TEST_F(LiveFaults, AnotherPersonBeforeTheCamerasIsNotFollowed) {
  const auto alone = follow(film(75));
  auto instants = film(75);
  const Movement mine = movement_;
  movement_ = [mine](double time_s) {
    Pose pose = mine(time_s + 1.0);
    pose.root_in_world += glm::dvec3(0.6, 0.0, -0.5);
    return pose;
  };
  const auto others = film(75);
  movement_ = mine;
  auto crowded = instants;
  for (std::size_t f = 0; f < instants.size(); ++f) {
    for (std::size_t c = 0; c < cameras_.size(); ++c) {
      for (TagDetection tag : others[f].views[c].tags) {
        auto& foreign = instants[f].views[c].tags;
        auto& doubled = crowded[f].views[c].tags;
        const auto same = std::ranges::find(doubled, tag.id, &TagDetection::id);
        const auto number = static_cast<std::size_t>(tag.id);
        const bool is_there = f >= 15 && f < 45;
        if (is_there && same != doubled.end() && (number + f + c) % 5 == 0) *same = tag;
        tag.id = TagId{static_cast<int>(number) + 200};
        foreign.push_back(tag);
      }
    }
  }
  const auto with_foreign = follow(instants);
  for (std::size_t f = 0; f < alone.size(); ++f) {
    EXPECT_EQ(with_foreign[f].pose.root_in_world, alone[f].pose.root_in_world) << f;
  }
  const auto with_doubled = follow(crowded);
  std::vector<double> off_mm;
  for (std::size_t f = 15; f < 45; ++f) {
    EXPECT_EQ(with_doubled[f].state, TrackState::kTracked) << f;
    off_mm.push_back(farthest_mm(with_doubled[f].pose, alone[f].pose));
  }
  std::ranges::sort(off_mm);
  tell("median_mm_while_numbers_are_doubled", off_mm[off_mm.size() / 2]);
  tell("worst_mm_while_numbers_are_doubled", off_mm.back());
  EXPECT_LT(off_mm.back(), 20.0);
  const double took_s = recovery_s(with_doubled, alone, 45);
  tell("as_before_after_s", took_s);
  EXPECT_LE(took_s, 1.0);
}

// A take that begins in the middle of a run has a chain of its own, which takes over.
TEST_F(LiveFaults, AChainThatTakesOverAfterASecondIsWhereTheOtherWas) {
  lags_s_ = {0.0, 0.012, -0.009, 0.015};
  const auto instants = film(150);
  LiveChain run = make_chain();
  LiveChain next = make_chain();
  std::vector<double> off_mm;
  for (std::size_t f = 0; f < instants.size(); ++f) {
    const Frame one = step(run, instants[f]);
    if (f < 60) continue;
    const Frame other = step(next, instants[f]);
    EXPECT_EQ(other.state, TrackState::kTracked) << f;
    EXPECT_EQ(other.time_s, one.time_s) << "one clock for both";
    off_mm.push_back(farthest_mm(one.pose, other.pose));
  }
  tell("mm_at_first", off_mm.front());
  tell("mm_after_one_second", off_mm[30]);
  tell("mm_after_two_seconds", off_mm[60]);
  EXPECT_LT(off_mm[30], 20.0);
}

}  // namespace
}  // namespace marey::app
