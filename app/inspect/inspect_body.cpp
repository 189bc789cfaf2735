// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/inspect/inspect_body.h"

#include <array>
#include <cstdio>
#include <string>
#include <utility>

#include "app/inspect/inspect_jumps.h"
#include "app/motion/jump_figures.h"
#include "app/motion/neutral.h"
#include "app/motion/read_body.h"
#include "app/motion/zmp_figures.h"
#include "core/base/extension.h"
#include "core/bone_map.h"
#include "recordings/base/atomic_file.h"
#include "recordings/body/bone_map_file.h"
#include "recordings/body/skeleton_picture.h"
#include "retarget/bones/identify_bones.h"

namespace marey::app {
namespace {

using Json = nlohmann::ordered_json;

Json bones_of(const ReadBody& body) {
  Json rows = Json::array();
  for (const HumanBone bone : human_bones()) {
    const auto& found = body.bones.bones[index(bone)];
    if (!found) continue;
    rows.push_back({{"bone", name(bone)},
                    {"joint", body.skeleton()[found->joint].name},
                    {"evidence", retarget::name(found->evidence)},
                    {"confidence", found->confidence}});
  }
  return rows;
}

Json describe(const ReadBody& body) {
  Json out{{"scheme", body.bones.scheme},
           {"unit_m", body.frame.unit_m},
           {"up", retarget::axis_word(body.frame.up_in_file)},
           {"front", retarget::axis_word(body.frame.front_in_file)},
           {"stature_m", body.frame.stature_m},
           {"neutral", name(body.neutral)},
           {"bone_map", body.bone_map ? Json(body.bone_map->string()) : Json()},
           {"bones", bones_of(body)},
           {"warnings", body.remarks()}};
  return out;
}

/// Returns the detected bone map, for manual correction and completion.
BoneMap map_of(const ReadBody& body) {
  BoneMap map;
  for (const HumanBone bone : human_bones()) {
    auto joint = body.bones.joint(bone);
    // A joint that is not in the file has no name in it.
    if (joint && !body.read_joint.empty() && !body.read_joint[index(*joint)])
      joint.reset();
    map.bones[index(bone)] = {true, joint};
  }
  map.unit_m = body.frame.unit_m;
  map.up = body.frame.up_in_file;
  map.front = body.frame.front_in_file;
  return map;
}

/// Returns a bone map of a declined body, for manual correction: the bones that were
/// found, and the others as comments. An entry "" would mean that the body lacks the
/// bone.
std::string begun_map_text(const Skeleton& skeleton) {
  const retarget::FoundBones found = retarget::guess_bones(skeleton);
  BoneMap map;
  for (const HumanBone bone : human_bones()) {
    const auto joint = found.joint(bone);
    if (joint) map.bones[index(bone)] = {true, joint};
  }
  std::string text = recordings::bone_map_text(map, skeleton);
  for (const HumanBone bone : human_bones()) {
    if (!found.joint(bone)) text += "# " + std::string(name(bone)) + " = \"\"\n";
  }
  text += "\n# The joints:\n";
  for (const Joint& joint : skeleton.joints) {
    text += "# ";
    // A name with a line of its own would be read as a key.
    for (const char c : joint.name) {
      const bool is_control = static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
      text += is_control ? '?' : c;
    }
    text += "\n";
  }
  return text;
}

Status write_map(const std::filesystem::path& file,
                 const Result<ReadBody>& body,
                 const Skeleton& raw,
                 Console& console) {
  const std::filesystem::path out = recordings::bone_map_path(file);
  std::error_code ignored;
  if (std::filesystem::exists(out, ignored)) {
    return bad_input(out.string(), "is there already", "rename it, or edit it by hand");
  }
  const Status ok = body
                        ? recordings::write_bone_map(out, map_of(*body), body->skeleton())
                        : recordings::write_file(out, begun_map_text(raw));
  if (ok) console.say("bone map: " + out.string());
  return ok;
}

}  // namespace

Result<Json> inspect_body(const std::filesystem::path& file,
                          const InspectBodyOptions& options,
                          Console& console) {
  auto raw = read_raw_body(file);
  if (!raw) return raw.error();
  Json out{{"kind", is_gltf(file) ? "character" : kind_by_extension(file).substr(1)}};
  const RawBody kept = *raw;
  BodyFile body_file(file, options.bone_map);
  if (!options.neutral.empty()) {
    const auto neutral = read_neutral(options.neutral);
    if (!neutral) return neutral.error();
    body_file.neutral = *neutral;
  }
  const Result<ReadBody> body = identify_body(*std::move(raw), body_file);
  Json bones = Json::array();
  for (const Joint& joint : (body ? body->raw : kept).motion.skeleton.joints) {
    if (joint.bone) bones.push_back(name(*joint.bone));
  }
  out["skeleton"] = {{"joints", kept.motion.skeleton.joints.size()},
                     {"human_bones", bones}};
  if (kept.mesh) out["vertices"] = kept.mesh->p_in_world.size();
  if (kept.has_motion) {
    const Motion& motion = kept.motion;
    out["motion"] = {
        {"frames", motion.poses.size()},
        {"rate_hz", motion.rate.hz},
        {"duration_s", static_cast<double>(motion.poses.size()) / motion.rate.hz},
        {"ignored_translation_m", kept.ignored_translation_m}};
  }
  if (body && kept.has_motion) {
    if (const auto jumps = find_motion_jumps(body->raw.motion)) {
      out["jumps"] = jumps_json(*jumps);
    }
    if (const auto zmp = find_motion_zmp(body->raw.motion)) {
      out["zmp"] = zmp_json(zmp->figures);
    }
  }
  out["body"] = body ? describe(*body) : Json{{"declined", body.error().message()}};
  if (options.write_map) {
    if (const Status ok = write_map(file, body, kept.motion.skeleton, console); !ok) {
      return ok.error();
    }
  }
  // A body that is declined is drawn too, as it was read: the user has to see it.
  if (!options.picture.empty()) {
    const Skeleton& skeleton = (body ? body->raw : kept).motion.skeleton;
    const Status ok = recordings::write_skeleton_picture(
        options.picture, skeleton, file.filename().string());
    if (!ok) return ok.error();
    console.say("picture: " + options.picture.string());
  }
  // A named map or neutral that does not fit is an error. Without one, the answer is the
  // incomplete body.
  const bool names_more = options.bone_map || !options.neutral.empty();
  if (!body && names_more) return body.error();
  return out;
}

Json bones_as_lines(Json inspected) {
  if (!inspected.contains("body") || !inspected["body"].contains("bones")) {
    return inspected;
  }
  Json lines = Json::object();
  for (const Json& row : inspected["body"]["bones"]) {
    std::array<char, 160> text{};
    std::snprintf(text.data(),
                  text.size(),
                  "%-28s %-5s %.2f",
                  row["joint"].get<std::string>().substr(0, 60).c_str(),
                  row["evidence"].get<std::string>().c_str(),
                  row["confidence"].get<double>());
    lines[row["bone"].get<std::string>()] = text.data();
  }
  inspected["body"]["bones"] = std::move(lines);
  return inspected;
}

}  // namespace marey::app
