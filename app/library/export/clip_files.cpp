// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <string>
#include <utility>

#include "library/clips/normal_form.h"

#include "app/library/export/clip_sinks.h"
#include "app/motion/motion_files.h"
#include "core/humanoid.h"
#include "recordings/base/atomic_file.h"
#include "recordings/gltf/gltf.h"
#include "recordings/library/export_arrays.h"
#include "recordings/motion/bvh.h"
#include "recordings/motion/npz.h"
#include "retarget/body/body_map.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

/// Returns a name that every file system takes: other characters than letters, digits,
/// '-' and '_' become '_'.
std::string as_folder_name(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const bool is_plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') ||
                          (c >= 'A' && c <= 'Z') || c == '-' || c == '_';
    out += is_plain ? c : '_';
  }
  constexpr std::size_t kMaxName = 100;
  if (out.size() > kMaxName) out.resize(kMaxName);
  return out.empty() ? "unknown" : out;
}

/// Writes one file for each clip.
class FileSink : public ClipSink {
 public:
  FileSink(const ExportOptions& options, const ExportBody& body, fs::path folder)
      : format_(options.format), look_(body.look()), folder_(std::move(folder)) {
    if (options.skeleton == "lafan22") bvh_.order = recordings::BvhOrder::kZyx;
  }

  Status check(const ExportedClip& clip) const override {
    const Skeleton& skeleton = clip.motion.motion.skeleton;
    if (format_ == ExportFormat::kVrma) {
      return can_hold(MotionFormat::kVrma, skeleton, look_);
    }
    if (format_ != ExportFormat::kAmass && format_ != ExportFormat::kJoints22) {
      return Done{};
    }
    for (const HumanBone bone : human_bones()) {
      if (skeleton.find(bone)) continue;
      return bad_input(
          "", "the body has no bone " + in_quotes(bone), "export with --skeleton smpl22");
    }
    return Done{};
  }

  Status add(const ExportedClip& clip) override {
    const fs::path stem = folder_ / clip.record.clip_id;
    const Motion& motion = clip.motion.motion;
    switch (format_) {
      case ExportFormat::kBvh:
        return recordings::write_bvh(stem.string() + ".bvh", motion, bvh_);
      case ExportFormat::kGlb:
        return write_glb(stem.string() + ".glb", clip);
      case ExportFormat::kVrma:
        return write_bytes(stem.string() + ".vrma", vrma_of(motion, clip.record.name));
      case ExportFormat::kAmass: {
        const std::string file = clip.record.clip_id + "_poses.npz";
        return write_bytes(
            folder_ / as_folder_name(clip.record.provenance.subject) / file,
            in_t_pose(motion, recordings::amass_bytes));
      }
      case ExportFormat::kJoints22:
        return write_bytes(stem.string() + ".npy", recordings::joints22_bytes(motion));
      default:
        return write_bytes(stem.string() + ".npz", clip_npz(clip));
    }
  }

  Status finish() override { return Done{}; }

 private:
  static Status write_bytes(const fs::path& path, const Result<std::string>& bytes) {
    if (bytes) return recordings::write_file(path, *bytes);
    Error error = bytes.error();
    error.where = path.filename().string();
    return error;
  }

  /// Calls `bytes_of` with the motion on a body that rests in marey's T-pose.
  template <class BytesOf>
  static Result<std::string> in_t_pose(const Motion& motion, const BytesOf& bytes_of) {
    const auto map = retarget::map_body(motion.skeleton);
    if (!map) return map.error();
    return bytes_of(library::in_normal_form(motion, *map));
  }

  [[nodiscard]] Status write_glb(const fs::path& path, const ExportedClip& clip) const {
    const Motion& motion = clip.motion.motion;
    if (!look_.file.empty()) {
      return write_motion_file(
          path, MotionFormat::kGlb, motion, look_, {bvh_, clip.record.name});
    }
    return recordings::write_character(
        path, motion.skeleton, {}, &motion, clip.record.name);
  }

  ExportFormat format_;
  BodyLook look_;
  recordings::BvhWriteOptions bvh_;
  fs::path folder_;
};

/// Writes no file for a clip: the tables are those of all records.
class NoFileSink : public ClipSink {
 public:
  Status check(const ExportedClip& /*clip*/) const override { return Done{}; }
  Status add(const ExportedClip& /*clip*/) override { return Done{}; }
  Status finish() override { return Done{}; }
};

}  // namespace

Result<std::string> clip_npz(const ExportedClip& clip) {
  recordings::NpzExtras extras;
  extras.uncertainty = clip.motion.uncertainty;
  for (const HumanBone part : {HumanBone::kLeftFoot,
                               HumanBone::kLeftToes,
                               HumanBone::kRightFoot,
                               HumanBone::kRightToes}) {
    extras.contacts.names.emplace_back(name(part));
  }
  for (const FootParts& parts : clip.motion.contacts) {
    extras.contacts.bears.insert(extras.contacts.bears.end(), parts.begin(), parts.end());
  }
  extras.clip = &clip.record;
  return recordings::npz_bytes(clip.motion.motion, extras);
}

std::unique_ptr<ClipSink> make_clip_sink(const ExportOptions& options,
                                         const ExportBody& body,
                                         const fs::path& folder) {
  switch (options.format) {
    case ExportFormat::kShards:
      return std::make_unique<ShardSink>(folder);
    case ExportFormat::kPack:
      return std::make_unique<PackSink>(folder);
    case ExportFormat::kMatching:
      return std::make_unique<MatchingSink>(folder);
    case ExportFormat::kTable:
      return std::make_unique<NoFileSink>();
    default:
      return std::make_unique<FileSink>(options, body, folder);
  }
}

}  // namespace marey::app
