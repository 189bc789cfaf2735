// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/build/make_clips.h"

#include <algorithm>
#include <span>
#include <tuple>
#include <utility>

#include "library/clips/normal_form.h"
#include "library/features/body_features.h"
#include "library/features/feature_span.h"
#include "library/quality/measure_quality.h"

#include "core/base/frame_range.h"
#include "core/library/library_motion.h"
#include "recordings/library/clip_record_file.h"
#include "recordings/library/motion_object.h"
#include "recordings/library/rows_file.h"
#include "retarget/body/body_map.h"

namespace marey::app {
namespace {

/// Adds the figures, labels and events that only the source has.
void add_source_values(const ClipRecord& body, const FrameRange& poses, ClipRecord& out) {
  out.figures.insert(out.figures.end(), body.figures.begin(), body.figures.end());
  const double start_s = poses.first / out.rate_hz;
  const double end_s = poses.last / out.rate_hz;
  for (ClipLabel label : body.labels) {
    if (label.end_s < start_s || label.start_s > end_s) continue;
    label.start_s = std::max(label.start_s, start_s) - start_s;
    label.end_s = std::min(label.end_s, end_s) - start_s;
    out.labels.push_back(std::move(label));
  }
  for (const ClipEvent& event : body.events) {
    if (event.frame < poses.first || event.frame > poses.last) continue;
    out.events.push_back({event.frame - poses.first, event.name});
  }
  for (const ClipProblem& problem : body.problems) {
    if (problem.frames.last < poses.first || problem.frames.first > poses.last) continue;
    ClipProblem& part = out.problems.emplace_back(problem);
    part.frames = {std::max(problem.frames.first, poses.first) - poses.first,
                   std::min(problem.frames.last, poses.last) - poses.first};
  }
}

void sort_values(ClipRecord& record) {
  std::ranges::sort(record.figures, {}, &ClipFigure::name);
  std::ranges::sort(record.problems, [](const ClipProblem& a, const ClipProblem& b) {
    return std::tie(a.frames.first, a.kind, a.joint, a.frames.last) <
           std::tie(b.frames.first, b.kind, b.joint, b.frames.last);
  });
  std::ranges::sort(record.labels, [](const ClipLabel& a, const ClipLabel& b) {
    return std::tie(a.start_s, a.text, a.end_s, a.by) <
           std::tie(b.start_s, b.text, b.end_s, b.by);
  });
  std::ranges::sort(record.events, [](const ClipEvent& a, const ClipEvent& b) {
    return std::tie(a.frame, a.name) < std::tie(b.frame, b.name);
  });
}

ClipRecord record_of(const BuildInputs& inputs,
                     const ClipRecord& body,
                     const std::string& source_id,
                     const LibraryMotion& part,
                     const retarget::BodyMap& map,
                     const FrameRange& poses) {
  ClipRecord out;
  out.object_key = body.object_key;
  out.body = body.body;
  out.first_frame = body.first_frame + poses.first;
  out.last_frame = body.first_frame + poses.last;
  out.clip_id =
      recordings::clip_id_of(source_id, out.body, out.first_frame, out.last_frame);
  out.rate_hz = body.rate_hz;
  out.rate_by = body.rate_by;
  out.provenance.source_id = source_id;
  out.provenance.subject = body.provenance.subject;
  library::QualityResult quality =
      library::measure_quality(part, map, inputs.settings.limits);
  out.figures = std::move(quality.figures);
  out.problems = std::move(quality.problems);
  out.quality = quality.quality;
  add_source_values(body, poses, out);
  sort_values(out);
  return out;
}

}  // namespace

Result<SourceClips> make_clips(const BuildInputs& inputs,
                               const recordings::SourceStage& stage,
                               const std::string& source_id) {
  SourceClips out;
  std::vector<float> rows;
  for (const ClipRecord& body : stage.bodies) {
    // Read again, as float32 rounds: the same figures whether the object is new or not.
    const auto motion = recordings::read_motion_object(
        inputs.library / recordings::object_path(body.object_key, ".npz"));
    if (!motion) return motion.error();
    const auto map = retarget::map_body(motion->motion.skeleton);
    if (!map) return map.error();
    const library::BodyFeatures features = library::body_features(motion->motion, *map);
    const library::FeatureSpan whole =
        library::feature_span(body.first_frame, body.last_frame, body.rate_hz);
    const FrameRange all{0, static_cast<int>(motion->motion.poses.size()) - 1};
    for (const FrameRange& poses : {all}) {
      const LibraryMotion part = library::part_of(*motion, poses.first, poses.last);
      const ClipRecord& record =
          out.records.emplace_back(record_of(inputs, body, source_id, part, *map, poses));
      const auto clip_rows = library::rows_of_part(
          features.rows,
          whole,
          library::feature_span(record.first_frame, record.last_frame, record.rate_hz));
      rows.insert(rows.end(), clip_rows.begin(), clip_rows.end());
    }
  }
  out.features = recordings::rows_file_bytes(rows, library::kFeatureStride);
  return out;
}

}  // namespace marey::app
