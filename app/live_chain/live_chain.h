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
#include "app/live_chain/live_preview.h"
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

/// Result of one instant. Refers to data of the chain: valid until its next step. With
/// LiveSettings::balance_preview, track, poses and uncertainty are those of the instant
/// 0.8 s before.
struct LiveResult {
  std::int64_t number = 0;
  Timestamp time{0};
  reconstruct::TrackReport track;
  /// Pose of the performer as measured; undefined while the track is waiting.
  const Pose* pose = nullptr;
  std::span<const JointUncertainty> uncertainty;
  std::span<const Pose> avatars;  ///< In the order of the settings; see `pose`.
  /// Handles of the first avatar; empty without avatars.
  std::span<const HandleState> handles;
  /// Packets of each stream, then those for VRChat if the settings request them.
  std::span<const std::vector<std::vector<std::uint8_t>>> packets;
  // Durations. [s]
  double solve_s = 0.0;
  double retarget_s = 0.0;
  double encode_s = 0.0;
};

/// Computes the packets of every stream from the detections of the cameras: tag corners
/// to the performer's pose, to the pose of every avatar, to packets. The first avatar is
/// adapted to its dragged handles (app/live_chain/live_handles.h), after the delay if the
/// settings request a preview of balance (app/live_chain/live_preview.h). The live run
/// and the replay use this class. All state is in this object, and the clock is read only
/// to measure durations, so the same instants and requests give the same bytes. Used by
/// one thread at a time.
class LiveChain {
 public:
  /// `avatars` are in the order of `settings.avatars`.
  /// Errors: those of BodyTracker::create(), of LiveRetarget::make(), LiveHandles::make()
  /// and VmcBody::make() (with the avatar's file), of VmcEncoder::make() and
  /// LivePreview::make().
  [[nodiscard]] static Result<LiveChain> make(const Body& body,
                                              std::span<const Camera> cameras,
                                              std::span<const OpenedAvatar> avatars,
                                              const LiveSettings& settings);

  /// Processes one instant. Until the body is found, the only packets are those with the
  /// state "not tracked"; their pose is the avatar at rest.
  /// Precondition: numbers grow from call to call.
  const LiveResult& step(const LiveInstant& instant, const LiveRequests& requests);

  [[nodiscard]] const Skeleton& performer() const { return tracker_.skeleton(); }

 private:
  struct Stream {
    VmcStream what;
    live::VmcBody body;
    live::VmcEncoder encoder;
    live::VmcPose vmc_pose;
  };

  LiveChain(reconstruct::BodyTracker tracker,
            std::span<const Camera> cameras,
            const LiveSettings& settings);
  void take_in(const LiveInstant& instant);
  void retarget_avatars(double since_last_s);
  void preview();
  void drag(const LiveRequests& requests, double since_last_s);
  void encode(Timestamp time, const LiveRequests& requests);

  std::vector<Camera> cameras_;
  FrameRate rate_;
  reconstruct::BodyTracker tracker_;
  std::vector<retarget::LiveRetarget> retargets_;
  std::optional<LiveHandles> handles_;  ///< Handles of the first avatar.
  std::optional<LivePreview> preview_;
  std::vector<Pose> newest_avatars_;  ///< Input of the preview; empty without it.
  Skeleton dragged_;                  ///< Body of the first avatar, for the preview.
  std::vector<RigidTransform> world_from_dragged_;
  std::vector<Stream> streams_;
  std::optional<live::VrchatTrackers> trackers_;
  std::vector<RigidTransform> world_from_joint_;  ///< Joints of the performer.

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
