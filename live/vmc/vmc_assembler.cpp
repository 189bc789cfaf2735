// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/vmc/vmc_assembler.h"

#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

namespace marey::live {
namespace {

constexpr double kMaxPosition_m = 10e3;  // [m]
// Senders round; a shorter quaternion is not a rotation.
constexpr double kMinQuaternionNorm = 1e-3;
constexpr int kIncompleteUntilAccepted = 5;

/// Reads position and rotation, normalised; nullopt if they are missing or invalid.
std::optional<UnityTransform> read_transform(OscArguments& arguments) {
  double numbers[7];
  for (double& number : numbers) {
    const auto read = arguments.read_number();
    if (!read) return std::nullopt;
    number = *read;
  }
  const auto [x, y, z, qx, qy, qz, qw] = numbers;
  const glm::dvec3 position(x, y, z);
  const double length = std::hypot(std::hypot(qx, qy), std::hypot(qz, qw));
  if (!(glm::length(position) <= kMaxPosition_m) || !(length >= kMinQuaternionNorm) ||
      !std::isfinite(length)) {
    return std::nullopt;
  }
  return UnityTransform{position,
                        glm::dquat(qw / length, qx / length, qy / length, qz / length)};
}

}  // namespace

void VmcAssembler::take(std::span<const std::uint8_t> packet) {
  ++received_.packets;
  const bool sound = parse_osc(packet, [this](const OscMessage& message) {
    const Use used = use(message);
    if (used == Use::kDeclined) ++received_.declined;
    if (used == Use::kIgnored) ++received_.ignored;
  });
  if (!sound) ++received_.malformed;
  const Bones& has = open_.pose.has;
  if (expected_.any() && (has & expected_) == expected_) commit();
}

bool VmcAssembler::take_frame(VmcFrame& out) {
  if (!std::exchange(is_new_, false)) return false;
  out = newest_;
  return true;
}

VmcAssembler::Use VmcAssembler::use(const OscMessage& message) {
  constexpr std::string_view kPrefix = "/VMC/Ext/";
  std::string_view what = message.address;
  if (!what.starts_with(kPrefix)) return Use::kIgnored;
  what.remove_prefix(kPrefix.size());
  if (what == "Bone/Pos") return use_bone(message.arguments());
  if (what == "Root/Pos") return use_root(message.arguments());
  if (what == "T") return use_time(message.arguments());
  if (what == "OK") return use_status(message.arguments());
  return Use::kIgnored;
}

VmcAssembler::Use VmcAssembler::use_status(OscArguments arguments) {
  const auto loaded = arguments.read_int();
  if (!loaded) return Use::kDeclined;
  VmcStatus& status = open_.status;
  status.loaded = *loaded != 0;
  status.calibration = arguments.read_int().value_or(status.calibration);
  status.mode = arguments.read_int().value_or(status.mode);
  status.tracking = arguments.read_int().value_or(1) != 0;
  return Use::kTaken;
}

VmcAssembler::Use VmcAssembler::use_time(OscArguments arguments) {
  const auto time_s = arguments.read_number();
  if (!time_s) return Use::kDeclined;
  if (open_.pose.has.any() && open_.time_s && open_.time_s != time_s) end_frame();
  open_.time_s = time_s;
  just_ended_ = false;
  return Use::kTaken;
}

VmcAssembler::Use VmcAssembler::use_root(OscArguments arguments) {
  if (!arguments.read_text()) return Use::kDeclined;
  const auto root = read_transform(arguments);
  if (!root) return Use::kDeclined;
  open_.pose.root = *root;
  return Use::kTaken;
}

VmcAssembler::Use VmcAssembler::use_bone(OscArguments arguments) {
  const auto name = arguments.read_text();
  const auto bone = name ? unity_bone(*name) : std::nullopt;
  const auto local = bone ? read_transform(arguments) : std::nullopt;
  if (!local) return Use::kDeclined;
  ++received_.bones;
  if (!human_bone(*bone)) ++received_.not_of_ours;
  add_bone(*bone, *local);
  return Use::kTaken;
}

void VmcAssembler::add_bone(UnityBone bone, const UnityTransform& local) {
  if (open_.pose.contains(bone)) end_frame();
  // A bone of a frame that already counted as complete. It is expected from now on.
  if (just_ended_ && !expected_[index(bone)]) {
    expected_.set(index(bone));
    return;
  }
  just_ended_ = false;
  open_.pose.set(bone, local);
}

/// Ends the open frame, with or without all its bones.
void VmcAssembler::end_frame() {
  const Bones has = open_.pose.has;
  const bool complete = (has & expected_) == expected_;
  if (complete || ++incomplete_in_a_row_ >= kIncompleteUntilAccepted) {
    expected_ = has;
    commit();
    just_ended_ = false;
    return;
  }
  ++received_.incomplete;
  open_.pose.has.reset();
  open_.time_s.reset();
}

void VmcAssembler::commit() {
  newest_ = open_;
  is_new_ = true;
  ++received_.frames;
  incomplete_in_a_row_ = 0;
  expected_ |= open_.pose.has;
  just_ended_ = true;
  open_.pose.has.reset();
  open_.time_s.reset();
}

}  // namespace marey::live
