// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/build/make_clips.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <tuple>
#include <utility>

#include "library/clips/normal_form.h"
#include "library/features/body_features.h"
#include "library/features/feature_span.h"
#include "library/labels/found_labels.h"
#include "library/quality/found_figure.h"
#include "library/quality/measure_quality.h"
#include "library/quality/quality_limits.h"
#include "library/segments/find_segments.h"
#include "library/segments/trim_idle.h"

#include "app/library/labels/apply_labels.h"
#include "core/base/frame_range.h"
#include "core/library/library_motion.h"
#include "recordings/library/clip_record_file.h"
#include "recordings/library/motion_object.h"
#include "recordings/library/rows_file.h"
#include "retarget/body/body_map.h"

namespace marey::app {
namespace {

/// Returns the figures of a source that the quality gate judges.
std::vector<library::FoundFigure> outside_figures(const ClipRecord& body) {
  std::vector<library::FoundFigure> out;
  for (const library::FigureRule& rule : library::figure_rules()) {
    const auto found = std::ranges::find(body.figures, rule.figure, &ClipFigure::name);
    if (!rule.is_outside || found == body.figures.end()) continue;
    library::FoundFigure figure;
    figure.name = rule.figure;
    figure.value = found->value;
    out.push_back(std::move(figure));
  }
  return out;
}

/// Adds the figures, labels and events that only the source has.
void add_source_values(const ClipRecord& body, const FrameRange& poses, ClipRecord& out) {
  for (const ClipFigure& figure : body.figures) {
    const bool is_judged =
        std::ranges::find(out.figures, figure.name, &ClipFigure::name) !=
        out.figures.end();
    if (!is_judged) out.figures.push_back(figure);
  }
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

/// A clip before its measurement.
struct ClipRange {
  FrameRange poses;               ///< In the motion.
  std::vector<ClipEvent> events;  ///< Idle frames that were cut next to it.
};

/// Returns the labels of the whole motion, to divide it by: those of the source, and
/// those by people (name_label_sources()).
std::vector<ClipLabel> labels_of_motion(const BuildInputs& inputs,
                                        const SourceFile& file,
                                        const ClipRecord& body) {
  if (!inputs.segment_labels) return {};
  const LibraryLabels labels{{{"labels", inputs.labels_of(file)}}, {}};
  std::vector<ClipRecord> whole = {body};
  whole[0].provenance.path = file.name;
  (void)apply_labels(labels, whole);
  return whole[0].labels;
}

/// Returns the clips of a motion, in the order of their first poses.
std::vector<ClipRange> find_clips(const BuildInputs& inputs,
                                  const SourceFile& file,
                                  const ClipRecord& body,
                                  const LibraryMotion& motion,
                                  const retarget::BodyMap& map) {
  const library::TrimmedIdle idle = library::trim_idle(motion.motion, map);
  const int first = idle.kept.first;
  std::vector<ClipLabel> labels = labels_of_motion(inputs, file, body);
  for (ClipLabel& label : labels) {
    label.start_s -= first / body.rate_hz;
    label.end_s -= first / body.rate_hz;
  }
  std::vector<ClipRange> out;
  for (const FrameRange& part :
       library::find_segments(library::part_of(motion, first, idle.kept.last),
                              map,
                              inputs.settings.segment,
                              labels)) {
    ClipRange& clip = out.emplace_back();
    clip.poses = {first + part.first, first + part.last};
    for (std::size_t i = 0; i < idle.cut.size(); ++i) {
      const bool is_before = idle.cut[i].frames.last < first;
      const bool is_next =
          is_before ? clip.poses.first == first : clip.poses.last == idle.kept.last;
      if (!is_next) continue;
      const int frame = is_before ? 0 : clip.poses.last - clip.poses.first;
      clip.events.push_back({frame, idle.events[i].name});
    }
  }
  return out;
}

/// Adds the labels and events that the motion shows.
void add_found_labels(const LibraryMotion& part,
                      const retarget::BodyMap& map,
                      ClipRecord& out) {
  library::FoundLabels found = library::find_labels(part, map);
  for (ClipLabel& label : found.labels) out.labels.push_back(std::move(label));
  for (ClipEvent& event : found.events) out.events.push_back(std::move(event));
}

ClipRecord record_of(const BuildInputs& inputs,
                     const ClipRecord& body,
                     const std::string& source_id,
                     const LibraryMotion& part,
                     const retarget::BodyMap& map,
                     const ClipRange& range) {
  const FrameRange& poses = range.poses;
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
      library::measure_quality(part, map, inputs.settings.limits, outside_figures(body));
  out.figures = std::move(quality.figures);
  out.problems = std::move(quality.problems);
  out.quality = quality.quality;
  const int left_out = body.frame_count() - out.frame_count();
  if (left_out > 0) {
    out.figures.push_back({"left_out_frames", static_cast<double>(left_out), {}, "", {}});
  }
  out.events = range.events;
  add_found_labels(part, map, out);
  add_source_values(body, poses, out);
  sort_values(out);
  return out;
}

}  // namespace

Result<SourceClips> make_clips(const BuildInputs& inputs,
                               const SourceFile& file,
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
    for (const ClipRange& range : find_clips(inputs, file, body, *motion, *map)) {
      const LibraryMotion part =
          library::part_of(*motion, range.poses.first, range.poses.last);
      const ClipRecord& record =
          out.records.emplace_back(record_of(inputs, body, source_id, part, *map, range));
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
