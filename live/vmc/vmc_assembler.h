// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bitset>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "live/vmc/osc_parse.h"
#include "live/vmc/vmc_encoder.h"
#include "live/vmc/vmc_pose.h"

namespace marey::live {

/// One received frame of a body.
struct VmcFrame {
  VmcPose pose;                  ///< Includes fingers, eyes and jaw if they were sent.
  std::optional<double> time_s;  ///< The sender's T; nullopt if it sends none.
  VmcStatus status;              ///< The last received status.
};

/// Counts of received packets, messages and frames.
struct VmcReceived {
  std::int64_t packets = 0;
  std::int64_t malformed = 0;    ///< Packets that are not OSC; they are not used.
  std::int64_t bones = 0;        ///< Bone messages used, fingers included.
  std::int64_t not_of_ours = 0;  ///< Part of `bones`: marey has no such bone.
  std::int64_t declined = 0;     ///< VMC messages with wrong arguments, unknown bones,
                              ///< numbers not finite, places beyond 10 km, no rotation.
  std::int64_t ignored = 0;     ///< Messages that contain no part of a pose.
  std::int64_t frames = 0;      ///< Complete frames.
  std::int64_t incomplete = 0;  ///< Dropped: they lack bones of the frame before.
};

/// Assembles packets to frames.
///
/// A frame ends when all bones of the previous frame are present at the end of a packet;
/// otherwise when T changes or a bone is repeated. Senders of one bundle per frame, of
/// several packets per frame and without bundles are therefore all supported. With one
/// bundle per frame there is no delay, except that the first frame ends with the second.
/// A bone that is missing in five successive frames is no longer expected. A message with
/// missing arguments or arguments of a wrong type is dropped; surplus arguments and
/// unknown addresses are ignored (VMC specification). Reordered packets are not sorted.
///
/// Memory is fixed; a packet costs time linear in its bytes. No allocation.
class VmcAssembler {
 public:
  void take(std::span<const std::uint8_t> packet);

  /// Copies the newest complete frame to `out` and returns true; returns false and leaves
  /// `out` unchanged if that frame was already taken.
  [[nodiscard]] bool take_frame(VmcFrame& out);

  [[nodiscard]] const VmcReceived& received() const { return received_; }
  /// Returns the last received status, also if no frame was complete since.
  [[nodiscard]] const VmcStatus& status() const { return open_.status; }

 private:
  using Bones = std::bitset<kUnityBoneCount>;

  enum class Use { kTaken, kDeclined, kIgnored };
  [[nodiscard]] Use use(const OscMessage& message);
  [[nodiscard]] Use use_status(OscArguments arguments);
  [[nodiscard]] Use use_time(OscArguments arguments);
  [[nodiscard]] Use use_root(OscArguments arguments);
  [[nodiscard]] Use use_bone(OscArguments arguments);
  void add_bone(UnityBone bone, const UnityTransform& local);
  void end_frame();
  void commit();

  VmcFrame open_;
  VmcFrame newest_;
  bool is_new_ = false;
  Bones expected_;           ///< Bones of a frame, as learnt from the frames before.
  bool just_ended_ = false;  ///< Only bones were received since the last complete frame.
  int incomplete_in_a_row_ = 0;
  VmcReceived received_;
};

}  // namespace marey::live
