// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/app/library/page/page_library.h"

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "library/clips/normal_form.h"
#include "library/features/body_features.h"
#include "library/features/feature_basis.h"
#include "library/quality/measure_quality.h"
#include "library/search/relations.h"
#include <glm/gtc/quaternion.hpp>

#include "recordings/base/atomic_file.h"
#include "recordings/base/sha256.h"
#include "recordings/library/clip_record_file.h"
#include "recordings/library/library_file.h"
#include "recordings/library/library_index.h"
#include "recordings/library/motion_object.h"
#include "recordings/library/rows_file.h"
#include "retarget/body/body_map.h"
#include "retarget/contacts/detect_contacts.h"
#include "tests/support/simulation/injected_defects.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;
using recordings::RowsFileWriter;

template <class T>
T need(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message());
  return *std::move(result);
}

void add_labels(const PageClip& clip, const LibraryMotion& motion, ClipRecord& record) {
  const double seconds = record.duration_s();
  for (const std::string& text : clip.labels) {
    record.labels.push_back({0.0, seconds, text, "table", 1.0});
  }
  const auto map = need(retarget::map_body(motion.motion.skeleton));
  for (const auto& run : library::find_relations(
           motion.motion, map, retarget::detect_contacts(motion.motion, map))) {
    record.labels.push_back({run.frames.first / record.rate_hz,
                             run.frames.last / record.rate_hz,
                             std::string(name(run.relation)),
                             "marey",
                             1.0});
  }
  record.events.push_back({record.frame_count() / 2, "left.strike"});
}

ClipRecord record_of(const PageClip& clip,
                     const LibraryMotion& motion,
                     const retarget::BodyMap& map) {
  ClipRecord out;
  out.name = clip.name;
  out.provenance.source_id = recordings::sha256(clip.name);
  out.provenance.path = "sources/" + clip.name + ".bvh";
  out.provenance.kind = "bvh";
  out.provenance.licence = clip.licence;
  out.provenance.origin = "written by a test";
  out.provenance.subject = "actor " + std::to_string(1 + clip.name.size() % 3);
  out.first_frame = motion.motion.first_frame;
  out.last_frame = out.first_frame + static_cast<int>(motion.motion.poses.size()) - 1;
  out.rate_hz = motion.motion.rate.hz;
  out.clip_id = recordings::clip_id_of(
      out.provenance.source_id, "", out.first_frame, out.last_frame);
  out.object_key = recordings::stage_key(out.provenance.source_id, "test", 1, "", "");
  const auto quality = library::measure_quality(motion, map, {});
  out.figures = quality.figures;
  out.problems = quality.problems;
  out.quality = quality.quality;
  out.split = out.clip_id.front() < 'c' ? "train" : "val";
  add_labels(clip, motion, out);
  return out;
}

/// Lowers the arms of the T-pose and swings them against the legs.
void swing_arms(Motion& motion) {
  constexpr double kLowered_rad = 1.3;
  constexpr double kSwing_rad = 0.45;
  constexpr double kCycle_s = 1.1;  // As in synthetic_walk().
  const auto left = motion.skeleton.find(HumanBone::kLeftUpperArm);
  const auto right = motion.skeleton.find(HumanBone::kRightUpperArm);
  for (std::size_t i = 0; i < motion.poses.size(); ++i) {
    const double time_s = static_cast<double>(i) / motion.rate.hz;
    const double swing =
        kSwing_rad * std::cos(2.0 * std::numbers::pi * time_s / kCycle_s);
    const auto turn = [&](double side) {
      return glm::angleAxis(side * swing, glm::dvec3(1.0, 0.0, 0.0)) *
             glm::angleAxis(-side * kLowered_rad, glm::dvec3(0.0, 0.0, 1.0));
    };
    motion.poses[i].parent_from_joint[index(*left)] = turn(1.0);
    motion.poses[i].parent_from_joint[index(*right)] = turn(-1.0);
  }
}

/// The search files of a library.
class SearchWriter {
 public:
  explicit SearchWriter(const fs::path& folder)
      : features_(need(
            RowsFileWriter::create(folder / "features.f32", library::kFeatureStride))),
        windows_(
            need(RowsFileWriter::create(folder / "windows.f32", library::kWindowFloats))),
        wholes_(
            need(RowsFileWriter::create(folder / "wholes.f32", library::kWholeFloats))) {}

  void add(const Motion& motion, const retarget::BodyMap& map) {
    const std::vector<float> rows = library::body_features(motion, map).rows;
    features_.add_clip(rows);
    windows_.add_clip(library::feature_windows(rows));
    wholes_.add_clip(library::whole_clip_row(rows));
  }
  void commit() {
    need(features_.commit());
    need(windows_.commit());
    need(wholes_.commit());
  }

 private:
  RowsFileWriter features_;
  RowsFileWriter windows_;
  RowsFileWriter wholes_;
};

}  // namespace

void write_page_library(const fs::path& folder, std::span<const PageClip> clips) {
  need(recordings::write_file(folder / "library.toml",
                              recordings::new_library_text("Test motions")));
  SearchWriter search(folder / "search" / "rows");
  std::vector<ClipRecord> records;
  for (const PageClip& clip : clips) {
    const LibraryMotion motion = need(library::make_library_motion(clip.motion));
    const auto map = need(retarget::map_body(motion.motion.skeleton));
    const ClipRecord& record = records.emplace_back(record_of(clip, motion, map));
    need(recordings::write_file(
        folder / recordings::object_path(record.object_key, ".npz"),
        need(recordings::motion_object_bytes(motion))));
    search.add(motion.motion, map);
  }
  search.commit();
  recordings::IndexHead head;
  head.search = "rows";
  need(recordings::write_library_index(folder / "library.sqlite", records, head));
}

std::vector<PageClip> sample_page_clips(int count) {
  constexpr std::array kDefects{
      Defect::kSpike10cm, Defect::kFrozenArm, Defect::kLegsCrossed, Defect::kFloor3cm};
  std::vector<PageClip> out;
  for (int i = 0; i < count; ++i) {
    PageClip clip;
    clip.name = "walk_" + std::to_string(100 + i);
    clip.motion = synthetic_walk(60 + 7 * (i % 9), 30.0).motion;
    swing_arms(clip.motion);
    clip.labels = {i % 3 == 0 ? "walk" : "stroll"};
    if (i % 5 == 4) clip.licence = "CC-BY-NC-4.0";
    if (i % 2 == 1) {
      const auto defect = kDefects[static_cast<std::size_t>(i / 2) % kDefects.size()];
      const auto injected = inject(clip.motion, defect, static_cast<unsigned>(i));
      if (injected) clip.motion = injected->motion;
    }
    out.push_back(std::move(clip));
  }
  return out;
}

}  // namespace marey::testing
