// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/live_chain/live_handles.h"
#include "app/live_chain/live_settings.h"
#include "app/motion/retarget_files.h"
#include "core/base/result.h"
#include "core/body.h"
#include "core/camera.h"
#include "core/live_instant.h"
#include "core/motion.h"
#include "live/vmc/vmc_encoder.h"
#include "live/vmc/vrchat_trackers.h"
#include "reconstruct/tags/track_body.h"
#include "retarget/motion/live_retarget.h"

namespace marey::app {

/// What came of one instant. Borrowed from the chain: valid until its next step.
struct LiveResult {
  std::int64_t number = 0;
  Timestamp time{0};
  reconstruct::TrackReport track;
  /// Of the performer; meaningless while the track is waiting.
  const Pose* pose = nullptr;
  std::span<const JointUncertainty> uncertainty;
  std::span<const Pose> avatars;  ///< In the order of the settings; likewise.
  /// Of the first avatar; empty without avatars.
  std::span<const HandleState> handles;
  /// Of each stream, the packets to be sent; then VRChat's, if they are wanted.
  std::span<const std::vector<std::vector<std::uint8_t>>> packets;
  // What it took. [s]
  double solve_s = 0.0;
  double retarget_s = 0.0;
  double encode_s = 0.0;
};

/// Everything between what cameras saw and what goes out, as one function of it: corners
/// to the performer's posture, to every avatar's, the first one's brought to what is
/// dragged (app/live_chain/live_handles.h), to the packets of every stream. Live
/// and replay run this same code: the past is in this object and nowhere else, no clock is
/// read but to measure. Same instants and requests, same bytes. One thread at a time.
class LiveChain {
 public:
  /// Avatars in the order of `settings.avatars`.
  /// Errors: BodyTracker::create()'s, LiveRetarget::make()'s, LiveHandles::make()'s and
  /// VmcBody::make()'s (naming the avatar's file), VmcEncoder::make()'s.
  [[nodiscard]] static Result<LiveChain> make(const Body& body,
                                              std::span<const Camera> cameras,
                                              std::span<const OpenedAvatar> avatars,
                                              const LiveSettings& settings);

  /// One instant on. Until the body was found there are no packets but those that say so:
  /// the pose that they hold is the avatar at rest.
  /// Precondition: numbers grow from call to call.
  const LiveResult& step(const LiveInstant& instant, const LiveRequests& requests);

  [[nodiscard]] const Skeleton& performer() const { return tracker_.skeleton(); }

 private:
  struct Stream {
    VmcStream what;
    live::VmcBody body;
    live::VmcEncoder encoder;
    live::VmcPose told;
  };

  LiveChain(reconstruct::BodyTracker tracker,
            std::span<const Camera> cameras,
            const LiveSettings& settings);
  void take_in(const LiveInstant& instant);
  void put_on_avatars(double since_last_s);
  void drag(const LiveRequests& requests, double since_last_s);
  void encode(Timestamp time, const LiveRequests& requests);

  std::vector<Camera> cameras_;
  FrameRate rate_;
  reconstruct::BodyTracker tracker_;
  std::vector<retarget::LiveRetarget> retargets_;
  std::optional<LiveHandles> handles_;  ///< Of the first avatar.
  std::vector<Stream> streams_;
  std::optional<live::VrchatTrackers> trackers_;
  std::vector<RigidTransform> world_from_joint_;  ///< Of the performer.

  std::optional<std::int64_t> last_number_;
  bool was_lost_ = false;
  std::vector<std::vector<TagDetection>> unshrunk_;  ///< By camera.
  std::vector<reconstruct::CameraView> views_;       ///< By camera.
  Pose pose_;
  std::vector<JointUncertainty> uncertainty_;
  std::vector<Pose> avatar_poses_;
  std::vector<std::vector<std::vector<std::uint8_t>>> packets_;
  LiveResult result_;
};

}  // namespace marey::app
