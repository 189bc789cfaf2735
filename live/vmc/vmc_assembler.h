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

/// One instant of somebody's body as it was received.
struct VmcFrame {
  VmcPose pose;  ///< Fingers, eyes and jaw are in it where they were told.
  std::optional<double> time_s;  ///< The sender's T; nullopt if it sends none.
  VmcStatus status;              ///< The last one told.
};

/// What came, and what became of it.
struct VmcReceived {
  std::int64_t packets = 0;
  std::int64_t malformed = 0;    ///< Packets that are not OSC; nothing of them is used.
  std::int64_t bones = 0;        ///< Bone messages that were used, fingers included...
  std::int64_t not_of_ours = 0;  ///< ...of which marey has no such bone.
  std::int64_t declined = 0;     ///< VMC's messages with wrong arguments, unknown bones,
                              ///< numbers not finite, places beyond 10 km, no rotation.
  std::int64_t ignored = 0;     ///< Messages that say nothing of a body's pose.
  std::int64_t frames = 0;      ///< Complete ones.
  std::int64_t incomplete = 0;  ///< Frames that lacked bones of the one before: dropped.
};

/// Puts packets together to frames.
///
/// A frame is over when all bones of the frame before are there at the end of a packet;
/// failing that, when T has another value or a bone comes again. So a bundle a frame, a
/// frame in several packets and senders without bundles are all understood, and whoever
/// sends a bundle a frame waits for nothing but, once, the second one. Five frames in a
/// row without some bone mean that it is no longer sent. Wrong-typed or missing arguments
/// drop a message, surplus ones and unknown addresses are ignored (VMC specification).
/// Packets that overtake each other are not put back in order.
///
/// Memory is fixed; a packet costs time linear in its bytes. No allocation.
class VmcAssembler {
 public:
  void take(std::span<const std::uint8_t> packet);

  /// The newest complete frame, unless it was taken before; then `out` is left alone.
  [[nodiscard]] bool take_frame(VmcFrame& out);

  [[nodiscard]] const VmcReceived& received() const { return received_; }
  /// As told last, though no frame came with it.
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
  Bones expected_;           ///< Bones of a frame, as far as is known.
  bool just_ended_ = false;  ///< Nothing but bones came since a frame was complete.
  int incomplete_in_a_row_ = 0;
  VmcReceived received_;
};

}  // namespace marey::live
