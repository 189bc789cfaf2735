// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <cstring>
#include <utility>

#include <glm/gtc/quaternion.hpp>

#include "app/library/export/clip_sinks.h"
#include "app/library/export/clip_tables.h"
#include "core/base/in_quotes.h"
#include "core/pose.h"

namespace marey::app {
namespace {

using Json = nlohmann::ordered_json;

void append_float(std::string& bytes, double value) {
  const auto number = static_cast<float>(value);
  char raw[sizeof(number)];
  std::memcpy(raw, &number, sizeof(number));
  bytes.append(raw, sizeof(number));
}

bool has_same_joints(const Skeleton& a, const Skeleton& b) {
  return std::ranges::equal(a.joints, b.joints, [](const Joint& x, const Joint& y) {
    return x.name == y.name && x.parent == y.parent && x.bone == y.bone;
  });
}

bool has_same_rest(const Skeleton& a, const Skeleton& b) {
  return std::ranges::equal(a.joints, b.joints, [](const Joint& x, const Joint& y) {
    return x.parent_from_joint.translation == y.parent_from_joint.translation;
  });
}

std::string rows_of(const LibraryMotion& clip) {
  const Motion& motion = clip.motion;
  const std::size_t joints = motion.skeleton.joints.size();
  std::vector<glm::dquat> last(joints, glm::dquat(1.0, 0.0, 0.0, 0.0));
  std::vector<RigidTransform> world(joints);
  std::string bytes;
  for (std::size_t f = 0; f < motion.poses.size(); ++f) {
    const Pose& pose = motion.poses[f];
    world_from_joints(motion.skeleton, pose, world);
    for (int k = 0; k < 3; ++k) append_float(bytes, pose.root_in_world[k]);
    for (std::size_t j = 0; j < joints; ++j) {
      const glm::dquat unit = glm::normalize(pose.parent_from_joint[j]);
      last[j] = glm::dot(unit, last[j]) < 0.0 ? -unit : unit;
      for (const double part : {last[j].w, last[j].x, last[j].y, last[j].z}) {
        append_float(bytes, part);
      }
    }
    for (const RigidTransform& joint : world) {
      for (int k = 0; k < 3; ++k) append_float(bytes, joint.translation[k]);
    }
    for (const std::uint8_t part : clip.contacts[f]) append_float(bytes, part);
  }
  return bytes;
}

Json rest_of(const Skeleton& skeleton) {
  Json out = Json::array();
  for (const Joint& joint : skeleton.joints) {
    const glm::dvec3& place = joint.parent_from_joint.translation;
    out.push_back(Json::array({place.x, place.y, place.z}));
  }
  return Json{{"rest_translations_m", std::move(out)}};
}

/// Returns the arrays in a row by name, and sets the number of columns.
Json arrays_of_row(std::size_t joints, std::size_t& columns) {
  Json out;
  columns = 0;
  const auto add = [&](const char* array, std::vector<std::size_t> shape) {
    std::size_t count = 1;
    for (const std::size_t size : shape) count *= size;
    out[array] = {{"first_column", columns}, {"shape", shape}};
    columns += count;
  };
  add("root_m", {3});
  add("rotations_wxyz", {joints, 4});
  add("positions_m", {joints, 3});
  add("contacts", {4});
  return out;
}

Json skeleton_json(const std::vector<Skeleton>& skeletons, std::int64_t frames) {
  Json names = Json::array();
  Json bones = Json::array();
  Json parents = Json::array();
  const std::vector<Joint>& joints = skeletons.front().joints;
  for (const Joint& joint : joints) {
    names.push_back(joint.name);
    bones.push_back(joint.bone ? std::string(name(*joint.bone)) : "");
    parents.push_back(joint.parent ? static_cast<int>(index(*joint.parent)) : -1);
  }
  Json rests = Json::array();
  for (const Skeleton& skeleton : skeletons) rests.push_back(rest_of(skeleton));
  std::size_t columns = 0;
  Json arrays = arrays_of_row(joints.size(), columns);
  return {{"format", 1},
          {"type", "<f4"},
          {"frames", frames},
          {"columns", columns},
          {"arrays", std::move(arrays)},
          {"contact_names", {"left_heel", "left_ball", "right_heel", "right_ball"}},
          {"joint_names", std::move(names)},
          {"human_bones", std::move(bones)},
          {"parents", std::move(parents)},
          {"skeletons", std::move(rests)}};
}

}  // namespace

Status PackSink::check(const ExportedClip& /*clip*/) const {
  return Done{};
}

std::size_t PackSink::number_of(const Skeleton& skeleton) {
  const auto found = std::ranges::find_if(
      skeletons_, [&](const Skeleton& known) { return has_same_rest(known, skeleton); });
  const auto number = static_cast<std::size_t>(found - skeletons_.begin());
  if (found == skeletons_.end()) skeletons_.push_back(skeleton);
  return number;
}

Status PackSink::add(const ExportedClip& clip) {
  const Skeleton& skeleton = clip.motion.motion.skeleton;
  if (!skeletons_.empty() && !has_same_joints(skeletons_.front(), skeleton)) {
    return bad_input("clip " + clip.record.clip_id,
                     "its body has other joints than the clips before it, and a pack has "
                     "one list of joints",
                     "export with --skeleton marey, or select clips of one skeleton with "
                     "--query");
  }
  if (!file_) {
    auto file = recordings::AtomicFile::create(folder_ / "motion.f32");
    if (!file) return file.error();
    file_.emplace(*std::move(file));
  }
  file_->append(rows_of(clip.motion));
  const auto count = static_cast<std::int64_t>(clip.motion.motion.poses.size());
  table_ += clip_line(clip.record) + "," + std::to_string(frames_) + "," +
            std::to_string(count) + "," + std::to_string(number_of(skeleton)) + "\n";
  frames_ += count;
  return Done{};
}

Status PackSink::finish() {
  if (!file_) return Done{};
  if (const Status ok = file_->commit(); !ok) return ok;
  const Status ok = recordings::write_file(
      folder_ / "clips.csv", clip_columns() + ",start,frames,skeleton\n" + table_);
  if (!ok) return ok;
  return recordings::write_file(folder_ / "skeleton.json",
                                skeleton_json(skeletons_, frames_).dump(2) + "\n");
}

}  // namespace marey::app
