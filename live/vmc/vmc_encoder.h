// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/base/time.h"
#include "live/vmc/osc_writer.h"
#include "live/vmc/vmc_pose.h"

namespace marey::live {

/// Whether what is sent can be believed: /VMC/Ext/OK of VMC 2.7.
struct VmcStatus {
  bool loaded = true;    ///< The avatar is there.
  bool tracking = true;  ///< False: the body is lost, the pose is the last one known.
  int calibration = 3;   ///< 0 none, 1 asked for, 2 under way, 3 done.
  int mode = 0;          ///< Of calibration: 0 normal, 1 and 2 mixed reality.
};

/// Returns a packet with /VMC/Ext/OK alone: of a sender that has no new pose to send.
[[nodiscard]] std::vector<std::uint8_t> vmc_status_packet(const VmcStatus& status);

/// What is sent in every n-th frame only, as /VMC/Ext/Set/Period asks.
struct VmcPeriods {
  int status = 1;
  int root = 1;
  int bone = 1;
};

/// What is told at first, once a second, and on /VMC/Ext/Set/Req. Empty texts and absent
/// values are not sent.
struct VmcInfo {
  std::optional<int> listen_port =
      std::nullopt;          ///< Where commands are heard: /VMC/Ext/Rcv.
  std::string options = "";  ///< /VMC/Ext/Opt.
  /// /VMC/Ext/VRM: sender and receiver must have the same file. A path tells everybody
  /// who listens about folders; its last part says enough.
  std::string vrm_path = "";
  std::string vrm_title = "";
};

struct VmcEncoderOptions {
  /// The largest packet; nullopt: one bundle a frame, as receivers on this machine like
  /// it. A network without fragments takes 1472. [bytes]
  std::optional<int> mtu_bytes = std::nullopt;
  VmcInfo info = {};
  /// Since when T counts; nullopt: since the first frame.
  std::optional<Timestamp> begin = std::nullopt;
};

/// The frames of one body as VMC 3.1 packets, each an OSC bundle to be carried out
/// "immediately":
///
///     /VMC/Ext/OK ,iiii  /VMC/Ext/T ,f  /VMC/Ext/Root/Pos ,sfffffff
///     /VMC/Ext/Bone/Pos ,sfffffff for each bone, then what VmcInfo holds, when due
///
/// With mtu_bytes a frame is several bundles, OK and T in the first. Blend shapes are not
/// sent, and so no /VMC/Ext/Blend/Apply, which only commits them.
///
/// T is the frame's own time since the first encoded frame (or `begin`), a float: frames of 60 Hz are
/// told apart for 36 hours. Quaternions have length 1 to 1e-6 and w >= 0. Same calls,
/// same bytes; nothing is allocated after the first full frame (live/vmc/osc_writer.h).
class VmcEncoder {
 public:
  /// Errors (kBadInput): a limit too small for a bone, or out of UDP's range; a text too
  /// long for it.
  [[nodiscard]] static Result<VmcEncoder> make(const VmcEncoderOptions& options = {});

  /// The packets of one frame, in the order in which they must be sent; none when nothing
  /// is due in it. Valid until the next call.
  /// Precondition: finite transforms, rotations of length about 1.
  [[nodiscard]] std::span<const std::span<const std::uint8_t>> encode(
      Timestamp time, const VmcPose& pose, const VmcStatus& status = {});

  /// From the next frame on. Periods below 1 count as 1, above 600 as 600.
  void set_periods(const VmcPeriods& periods);
  /// The next frame has all that is sent at low rate.
  void request_info() { info_requested_ = true; }

 private:
  VmcEncoder(const VmcEncoderOptions& options, std::size_t limit_bytes);
  void write_transform(std::string_view address,
                       std::string_view name,
                       const UnityTransform& transform);
  void write_info();

  VmcInfo info_;
  OscWriter writer_;
  VmcPeriods periods_;
  std::int64_t frame_ = 0;
  std::optional<Timestamp> first_;
  Timestamp info_sent_{0};
  bool info_requested_ = true;
};

}  // namespace marey::live
