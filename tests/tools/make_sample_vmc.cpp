// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes wild motions as VMC packets for other programs to read. Each NAME.vmc has a
// NAME.csv of the joint places that they must reproduce, and a NAME.json that maps bones
// to nodes: make_sample_vmc FOLDER [AVATAR.vrm BODY.glb].
//   raw          by the nodes of turned.glb, whose rest rotations are anything
//   normalised   the same as VRM 0.x would have it
//   vrm0         of AVATAR.vrm, a VRM 0.x; vrm0_raw: by its nodes
//   body         by the nodes of BODY.glb
// A .vmc has, for every packet, its size in four bytes (big-endian) and its bytes.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <string>

#include "core/pose.h"
#include "live/vmc/vmc_body.h"
#include "live/vmc/vmc_encoder.h"
#include "recordings/body/mannequin.h"
#include "recordings/gltf/gltf.h"
#include "retarget/bones/identify_bones.h"
#include "tests/recordings/wild_motion.h"

namespace {

using namespace marey;
using Path = std::filesystem::path;

constexpr int kFrames = 40;

void write_packet(std::ofstream& file, std::span<const std::uint8_t> packet) {
  for (const int shift : {24, 16, 8, 0}) {
    file.put(static_cast<char>(packet.size() >> shift));
  }
  for (const std::uint8_t byte : packet) file.put(static_cast<char>(byte));
}

bool write_packets(const Path& path,
                   const Motion& motion,
                   const live::VmcBodyOptions& options) {
  const auto body = live::VmcBody::make(motion.skeleton, options);
  if (!body) std::cerr << path << ": " << body.error().message() << "\n";
  if (!body) return false;
  auto encoder = *live::VmcEncoder::make();
  std::ofstream file(path, std::ios::binary);
  live::VmcPose sent;
  for (std::size_t frame = 0; frame < motion.poses.size(); ++frame) {
    body->to_vmc(motion.poses[frame], sent);
    const Timestamp time = frame_time(static_cast<int>(frame), motion.rate);
    for (const auto packet : encoder.encode(time, sent)) write_packet(file, packet);
  }
  return file.good();
}

/// joints.csv of the bones, with more decimals.
bool write_places(const Path& path, const Motion& motion) {
  std::ofstream file(path);
  file << "frame,time,joint,x,y,z,sigma\n" << std::fixed << std::setprecision(7);
  for (std::size_t frame = 0; frame < motion.poses.size(); ++frame) {
    const auto joints = world_from_joints(motion.skeleton, motion.poses[frame]);
    for (std::size_t i = 0; i < joints.size(); ++i) {
      const auto& bone = motion.skeleton.joints[i].bone;
      if (!bone) continue;
      const glm::dvec3& p = joints[i].translation;
      file << frame << ',' << seconds(frame_time(static_cast<int>(frame), motion.rate))
           << ',' << name(*bone) << ',' << p.x << ',' << p.y << ',' << p.z << ",0\n";
    }
  }
  return file.good();
}

bool write_bones(const Path& path, const Skeleton& skeleton) {
  std::ofstream file(path);
  const char* before = "{";
  for (const Joint& joint : skeleton.joints) {
    if (!joint.bone) continue;
    file << before << '"' << name(*joint.bone) << "\": \"" << joint.name << '"';
    before = ",\n ";
  }
  file << "}\n";
  return file.good();
}

bool write_all(const Path& folder,
               const std::string& name,
               const Skeleton& skeleton,
               const live::VmcBodyOptions& options) {
  Motion motion = recordings::wild_motion(skeleton, kFrames);
  motion.rate.hz = 60.0;
  return write_packets(folder / (name + ".vmc"), motion, options) &&
         write_places(folder / (name + ".csv"), motion) &&
         write_bones(folder / (name + ".json"), skeleton);
}

/// A child whose nodes are turned anyhow, as the body of a VRM 1.0 may be.
bool write_turned(const Path& folder) {
  const Proportions child =
      recordings::mannequin_proportions({.stature_m = 1.1, .leg = 0.9});
  const Skeleton skeleton = recordings::with_turned_axes(make_humanoid(child));
  const auto written = recordings::write_character(
      folder / "turned.glb", skeleton, recordings::make_mannequin_mesh(child));
  return written.has_value() &&
         write_all(folder, "raw", skeleton, {.rest = live::VmcRest::kRaw}) &&
         write_all(folder, "normalised", skeleton, {.rest = live::VmcRest::kVrm0});
}

/// Writes the samples of a file's body. Identifies its bones when the file has none.
bool write_avatar(const Path& folder,
                  const std::string& name,
                  const Path& avatar,
                  live::VmcRest rest) {
  auto body = recordings::read_character(avatar);
  if (!body) std::cerr << body.error().message() << "\n";
  if (!body) return false;
  const auto bones = retarget::identify_bones(body->skeleton);
  if (!bones) std::cerr << bones.error().message() << "\n";
  if (!bones) return false;
  retarget::mark(*bones, body->skeleton);
  return write_all(
      folder, name, body->skeleton, {.rest = rest, .file_faces_back = body->faces_back});
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2 && argc != 4) {
    std::cerr << "usage: make_sample_vmc FOLDER [AVATAR.vrm BODY.glb]\n";
    return 2;
  }
  const Path folder = argv[1];
  std::filesystem::create_directories(folder);
  bool ok = write_turned(folder);
  if (argc == 4) {
    ok = write_avatar(folder, "vrm0", argv[2], live::VmcRest::kVrm0) && ok;
    ok = write_avatar(folder, "vrm0_raw", argv[2], live::VmcRest::kRaw) && ok;
    ok = write_avatar(folder, "body", argv[3], live::VmcRest::kRaw) && ok;
  }
  return ok ? 0 : 1;
}
