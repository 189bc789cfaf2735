// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "app/live_chain/live_preview.h"
#include "core/human/average_proportions.h"
#include "core/human/centre_of_mass.h"
#include "core/humanoid.h"
#include "retarget/body/place_masses.h"
#include "retarget/contacts/detect_contacts.h"
#include "tests/support/program/count_allocations.h"
#include "tests/support/simulation/synthetic_walk.h"
#include "tests/support/truth/zmp_judge.h"

namespace marey::app {

using reconstruct::TrackReport;
using reconstruct::TrackState;

inline constexpr double kPreviewRate_hz = 60.0;
inline constexpr std::int64_t kPreviewDelay = 48;

const TrackReport kSeen{TrackState::kTracked, 20, 0, 0.5};
const TrackReport kUnseen{TrackState::kLost, 0, 0, 0.0};

/// A person who stands and sways in the hips, so that the feet stay where they are.
inline Motion swaying(int frames,
                      const glm::dvec3& axis,
                      double angle_rad,
                      double sway_hz) {
  Motion out{make_humanoid(average_proportions(1.75)), FrameRate{kPreviewRate_hz}, 0, {}};
  const auto spine = index(*out.skeleton.find(HumanBone::kSpine));
  for (int t = 0; t < frames; ++t) {
    Pose pose = rest_pose(out.skeleton);
    const double time_s = t / kPreviewRate_hz;
    const double grown = std::min(1.0, time_s);
    const double angle =
        grown * angle_rad * std::sin(2.0 * 3.141592653589793 * sway_hz * time_s);
    pose.parent_from_joint[spine] = glm::angleAxis(angle, axis);
    out.poses.push_back(std::move(pose));
  }
  return out;
}

/// One instant of a stream.
struct Sent {
  std::int64_t number = 0;
  TrackReport track = kSeen;
  Pose pose;
};

inline std::vector<Sent> stream_of(const Motion& motion) {
  std::vector<Sent> out;
  for (const Pose& pose : motion.poses) {
    out.push_back({static_cast<std::int64_t>(out.size()), kSeen, pose});
  }
  return out;
}

inline bool have_same_bits(const Pose& a, const Pose& b) {
  return a.root_in_world == b.root_in_world && a.parent_from_joint == b.parent_from_joint;
}

class PreviewOfAPerson : public ::testing::Test {
 protected:
  struct Shown {
    PreviewedFrame frame;
    glm::dvec2 shift_xz_m{0.0};
  };

  static LivePreview preview_of(const Skeleton& skeleton) {
    const std::array<const Skeleton*, 2> bodies{&skeleton, &skeleton};
    auto made = LivePreview::make(bodies, FrameRate{kPreviewRate_hz});
    EXPECT_TRUE(made);
    return *std::move(made);
  }

  /// The performer's poses are also the avatar's.
  static void step(LivePreview& preview, const Sent& sent) {
    preview.step(sent.number, sent.track, {}, sent.pose, {&sent.pose, 1});
  }

  static std::vector<Shown> run(const Skeleton& skeleton, const std::vector<Sent>& sent) {
    LivePreview preview = preview_of(skeleton);
    std::vector<Shown> out;
    for (const Sent& one : sent) {
      step(preview, one);
      out.push_back({preview.frame(), preview.shift_xz_m(1)});
    }
    return out;
  }

  /// The balanced motion without its delay, of the same frames as the source; the last
  /// frames are missing.
  static Motion balanced(const Motion& motion) {
    Motion out = motion;
    out.poses.clear();
    for (const Shown& shown : run(motion.skeleton, stream_of(motion))) {
      if (shown.frame.track.state == TrackState::kWaiting) continue;
      out.poses.push_back(shown.frame.avatars[0]);
    }
    return out;
  }
};

/// Judgement of a motion with the contacts of its source.
struct Judged {
  int supported = 0;
  int outside = 0;
  double sum_outside_m = 0.0;
};

inline Judged judge(const Motion& source, const Motion& motion) {
  Judged out;
  const auto map = retarget::map_body(source.skeleton);
  const auto masses = retarget::place_masses(source.skeleton, *map, {});
  const Contacts contacts = retarget::detect_contacts(source, *map);
  const auto judged = testing::judge_zmp(
      motion, testing::judged_feet(*map), *masses, contacts, 0.0, 0.16);
  // The ends have one-sided derivatives.
  for (std::size_t t = 10; t + 10 < judged.size(); ++t) {
    if (judged[t].vertical_force_g < 0.2 || !judged[t].outside_m) continue;
    ++out.supported;
    out.outside += *judged[t].outside_m > 0.0 ? 1 : 0;
    out.sum_outside_m += *judged[t].outside_m;
  }
  return out;
}

inline glm::dvec3 ankle_of(const Skeleton& skeleton, const Pose& pose, std::size_t side) {
  const HumanBone foot = side == 0 ? HumanBone::kLeftFoot : HumanBone::kRightFoot;
  return world_from_joints(skeleton, pose)[index(*skeleton.find(foot))].translation;
}

inline glm::dvec3 centre_of(const Skeleton& skeleton, const Pose& pose) {
  const auto map = retarget::map_body(skeleton);
  const auto masses = retarget::place_masses(skeleton, *map, {});
  return centre_of_mass(*masses, world_from_joints(skeleton, pose));
}

}  // namespace marey::app
