// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "app/live_chain/preview_body.h"
#include "core/base/result.h"
#include "core/motion.h"
#include "core/pose.h"
#include "core/skeleton.h"
#include "reconstruct/tags/track_body.h"
#include "retarget/feet/live_stance.h"

namespace marey::app {

/// Frame of a delayed stream.
struct PreviewedFrame {
  reconstruct::TrackReport track;  ///< Waiting: there is no frame yet.
  Pose performer;                  ///< As measured.
  Pose balanced_performer;
  std::vector<Pose> avatars;  ///< Balanced.
  std::vector<JointUncertainty> uncertainty;
  std::array<retarget::StandingFoot, 2> standing{};  ///< Body of the performer.
};

/// Delays the poses of a live run by kDelay_s and displaces each body horizontally so
/// that its zero moment point stays nearer to the support area (PreviewBody). Standing
/// feet keep their places; they are detected in the performer's poses and shared by all
/// bodies.
///
/// Frames that the run skipped are interpolated, so the delay is constant. The
/// displacement starts at 0, and it fades to 0 while the body is lost, and after gaps: it
/// has no jumps. Heights and rotations of trunk, head and arms do not change, except that
/// a body sinks where a standing leg is too short.
///
/// The same calls give the same bytes. Cost: some ten microseconds per body; after the
/// first second of tracking no call allocates.
class LivePreview {
 public:
  static constexpr double kDelay_s = 0.8;
  static constexpr double kMinRate_hz = 10.0;
  static constexpr double kMaxRate_hz = 500.0;

  /// `bodies` is the performer, then the avatars. Errors (kBadInput): the rate is outside
  /// of the limits above.
  [[nodiscard]] static Result<LivePreview> make(std::span<const Skeleton* const> bodies,
                                                FrameRate rate);

  /// Returns the delay: kDelay_s, rounded to frames.
  [[nodiscard]] std::int64_t delay_frames() const { return times_.delay; }

  /// Adds the instant `number` and updates frame() to the one delay_frames() before.
  /// Poses are not used while the track is waiting. Preconditions: numbers grow from call
  /// to call; one pose per avatar, all with the joints of their skeletons.
  void step(std::int64_t number,
            const reconstruct::TrackReport& track,
            std::span<const JointUncertainty> uncertainty,
            const Pose& performer,
            std::span<const Pose> avatars);

  /// Returns the delayed frame. Until its track is no longer waiting, its poses are the
  /// bodies at rest.
  [[nodiscard]] const PreviewedFrame& frame() const { return frame_; }
  /// Returns the displacement of a body's centre of mass in frame(), X and Z. [m]
  [[nodiscard]] const glm::dvec2& shift_xz_m(std::size_t body) const {
    return bodies_[body]->shift_xz_m();
  }

 private:
  struct Kept {
    reconstruct::TrackReport track;
    std::vector<JointUncertainty> uncertainty;
    std::array<retarget::StandingFoot, 2> standing{};
  };

  LivePreview(std::span<const Skeleton* const> bodies, const PreviewTimes& times);
  void detect_standing(const Pose& performer,
                       const reconstruct::TrackReport& track,
                       double since_last_s);
  void push(const Pose& performer, std::span<const Pose> avatars, double share);
  void fill_gap(std::int64_t missing,
                const reconstruct::TrackReport& track,
                std::span<const JointUncertainty> uncertainty,
                const Pose& performer,
                std::span<const Pose> avatars);
  void plan(bool is_steady);
  void show();
  [[nodiscard]] double hold(std::int64_t frame, std::size_t side) const;
  [[nodiscard]] Kept& kept(std::int64_t frame) { return kept_[times_.slot(frame)]; }

  PreviewTimes times_;
  std::vector<std::unique_ptr<PreviewBody>> bodies_;
  Skeleton skeleton_;  // The performer's.
  std::optional<retarget::BodyMap> map_;
  std::vector<RigidTransform> world_from_joint_;
  retarget::LiveStance stance_;
  std::array<retarget::StandingFoot, 2> standing_{};  // Newest.
  std::vector<Kept> kept_;                            // Ring.
  std::int64_t newest_ = -1;
  std::int64_t steady_ = 0;  // Number of the newest frames that are one movement.
  std::int64_t last_number_ = 0;
  PreviewedFrame frame_;
};

}  // namespace marey::app
