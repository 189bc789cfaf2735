// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/vmc/vmc_encoder.h"

#include <algorithm>

namespace marey::live {
namespace {

// Overhead of a text message: bundle, size, address, types, padding. [bytes]
constexpr int kAroundText = 64;

constexpr Timestamp kInfoInterval = std::chrono::seconds(1);

bool is_due(std::int64_t frame, int period) {
  return frame % period == 0;
}

int sound(int period) {
  return std::clamp(period, 1, 600);
}

void write_status(const VmcStatus& status, OscWriter& writer) {
  writer.begin("/VMC/Ext/OK", "iiii")
      .add(std::int32_t{status.loaded})
      .add(std::int32_t{status.calibration})
      .add(std::int32_t{status.mode})
      .add(std::int32_t{status.tracking});
}

}  // namespace

std::vector<std::uint8_t> vmc_status_packet(const VmcStatus& status) {
  OscWriter writer;
  write_status(status, writer);
  const auto packet = writer.packets().front();
  return {packet.begin(), packet.end()};
}

VmcEncoder::VmcEncoder(const VmcEncoderOptions& options, std::size_t limit_bytes)
    : info_(options.info), writer_(limit_bytes), first_(options.begin) {}

Result<VmcEncoder> VmcEncoder::make(const VmcEncoderOptions& options) {
  const int limit = options.mtu_bytes.value_or(kMaxPacketBytes);
  if (limit < kMinPacketBytes || limit > kMaxPacketBytes) {
    return bad_input("VMC",
                     "packets of " + std::to_string(limit) + " bytes are not possible",
                     "choose " + std::to_string(kMinPacketBytes) + " to " +
                         std::to_string(kMaxPacketBytes) + " bytes; networks take 1472");
  }
  const VmcInfo& info = options.info;
  const std::size_t longest =
      std::max(info.options.size(), info.vrm_path.size() + info.vrm_title.size());
  if (longest + kAroundText > static_cast<std::size_t>(limit)) {
    return bad_input("VMC",
                     "the avatar's file name and title do not fit into packets of " +
                         std::to_string(limit) + " bytes",
                     "use a shorter name");
  }
  return VmcEncoder(options, static_cast<std::size_t>(limit));
}

void VmcEncoder::set_periods(const VmcPeriods& periods) {
  periods_ = {sound(periods.status), sound(periods.root), sound(periods.bone)};
}

void VmcEncoder::write_transform(std::string_view address,
                                 std::string_view name,
                                 const UnityTransform& transform) {
  glm::dquat q = glm::normalize(transform.rotation);
  if (q.w < 0.0) q = -q;
  const glm::dvec3& p = transform.position;
  writer_.begin(address, "sfffffff").add(name);
  for (const double number : {p.x, p.y, p.z, q.x, q.y, q.z, q.w}) {
    writer_.add(static_cast<float>(number));
  }
}

void VmcEncoder::write_info() {
  if (info_.listen_port) {
    writer_.begin("/VMC/Ext/Rcv", "ii").add(1).add(std::int32_t{*info_.listen_port});
  }
  if (!info_.options.empty()) writer_.begin("/VMC/Ext/Opt", "s").add(info_.options);
  if (!info_.vrm_path.empty() || !info_.vrm_title.empty()) {
    writer_.begin("/VMC/Ext/VRM", "ss").add(info_.vrm_path).add(info_.vrm_title);
  }
}

std::span<const std::span<const std::uint8_t>> VmcEncoder::encode(
    Timestamp time, const VmcPose& pose, const VmcStatus& status) {
  if (!first_) first_ = time;
  const bool status_due = is_due(frame_, periods_.status);
  const bool root_due = is_due(frame_, periods_.root);
  const bool bones_due = is_due(frame_, periods_.bone);
  ++frame_;
  // A time before the last one means that the clock was reset: send low-rate messages
  // again.
  const bool info_due =
      info_requested_ || time < info_sent_ || time - info_sent_ >= kInfoInterval;
  writer_.clear();
  if (!status_due && !root_due && !bones_due && !info_due) return writer_.packets();

  if (status_due) write_status(status, writer_);
  writer_.begin("/VMC/Ext/T", "f").add(static_cast<float>(seconds(time - *first_)));
  if (root_due) write_transform("/VMC/Ext/Root/Pos", "root", pose.root);
  for (int i = 0; bones_due && i < kUnityBoneCount; ++i) {
    const auto bone = static_cast<UnityBone>(i);
    if (!pose.contains(bone)) continue;
    write_transform("/VMC/Ext/Bone/Pos", name(bone), pose.local[index(bone)]);
  }
  if (info_due) {
    write_info();
    info_sent_ = time;
    info_requested_ = false;
  }
  return writer_.packets();
}

}  // namespace marey::live
