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

/// Smallest limit of a packet: a bundle of one bone with the longest name,
/// RightMiddleIntermediate. [bytes]
inline constexpr int kMinPacketBytes = 16 + 4 + 20 + 12 + 24 + 7 * 4;
inline constexpr int kMaxPacketBytes = 65507;  ///< Limit of UDP over IPv4.

/// State of the sender: /VMC/Ext/OK of VMC 2.7.
struct VmcStatus {
  bool loaded = true;    ///< The avatar is loaded.
  bool tracking = true;  ///< False: the body is lost, the pose is the last one known.
  int calibration = 3;   ///< 0 none, 1 requested, 2 in progress, 3 done.
  int mode = 0;          ///< Calibration mode: 0 normal, 1 and 2 mixed reality.
};

/// Returns a packet with /VMC/Ext/OK only, for a sender without a new pose.
[[nodiscard]] std::vector<std::uint8_t> vmc_status_packet(const VmcStatus& status);

/// Send periods of /VMC/Ext/Set/Period: n means every n-th frame.
struct VmcPeriods {
  int status = 1;
  int root = 1;
  int bone = 1;
};

/// Low-rate messages, sent in the first frame, once a second, and on /VMC/Ext/Set/Req.
/// Empty texts and absent values are not sent.
struct VmcInfo {
  std::optional<int> listen_port = std::nullopt;  ///< Port for commands: /VMC/Ext/Rcv.
  std::string options = "";                       ///< /VMC/Ext/Opt.
  /// /VMC/Ext/VRM: sender and receiver must have the same file. A full path reveals
  /// folder names to every receiver; the file name is sufficient.
  std::string vrm_path = "";
  std::string vrm_title = "";
};

struct VmcEncoderOptions {
  /// Maximum packet size [bytes]; nullopt: one bundle per frame, for receivers on this
  /// machine. 1472 avoids fragmentation on a network.
  std::optional<int> mtu_bytes = std::nullopt;
  VmcInfo info = {};
  /// Zero of T; nullopt: the time of the first frame.
  std::optional<Timestamp> begin = std::nullopt;
};

/// Encodes the frames of one body as VMC 3.1 packets, each an OSC bundle with the time
/// tag "immediately":
///
///     /VMC/Ext/OK ,iiii  /VMC/Ext/T ,f  /VMC/Ext/Root/Pos ,sfffffff
///     /VMC/Ext/Bone/Pos ,sfffffff for each bone, then VmcInfo's messages, when due
///
/// With mtu_bytes a frame is several bundles, with OK and T in the first. Blend shapes
/// are not sent; therefore /VMC/Ext/Blend/Apply, which only commits them, is not sent
/// either.
///
/// T is the frame's own time since the first encoded frame (or `begin`), a float: frames
/// of 60 Hz have distinct T for 36 hours. Quaternions have length 1 to 1e-6 and w >= 0.
/// The same calls give the same bytes; nothing is allocated after the first full frame
/// (live/vmc/osc_writer.h).
class VmcEncoder {
 public:
  /// Checks the options. Errors (kBadInput): the limit is too small for a bone or out of
  /// UDP's range; a text does not fit into it.
  [[nodiscard]] static Result<VmcEncoder> make(const VmcEncoderOptions& options = {});

  /// Returns the packets of one frame, in the order in which they must be sent; none if
  /// nothing is due in this frame. Valid until the next call.
  /// Precondition: finite transforms, rotations of length about 1.
  [[nodiscard]] std::span<const std::span<const std::uint8_t>> encode(
      Timestamp time, const VmcPose& pose, const VmcStatus& status = {});

  /// Sets the periods from the next frame on. Values are clamped to 1 to 600.
  void set_periods(const VmcPeriods& periods);
  /// Adds all low-rate messages to the next frame.
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
