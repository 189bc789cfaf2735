// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/page/page_scene.h"

#include "core/base/frame_range.h"
#include "core/transform.h"
#include "live/page/page_json.h"
#include "live/page/wizard_object.h"

namespace marey::live {
namespace {

const char* name(PageSkeletonKind kind) {
  switch (kind) {
    case PageSkeletonKind::kPerformer:
      return "performer";
    case PageSkeletonKind::kAvatar:
      return "avatar";
    case PageSkeletonKind::kMotion:
      return "motion";
  }
  return "motion";
}

PageJson joint_object(const Joint& joint) {
  return {{"name", joint.name},
          {"parent", joint.parent ? static_cast<int>(*joint.parent) : -1},
          {"bone", joint.bone ? std::string(name(*joint.bone)) : std::string()},
          {"rest", to_json(joint.parent_from_joint)}};
}

PageJson skin_object(const std::optional<PageSkin>& skin) {
  if (!skin) return {};
  return {{"media", skin->media},
          {"format", skin->format},
          {"nodes", skin->nodes},
          {"node_index", skin->node_index},
          {"unit_from_m", skin->unit_from_m},
          {"scene_from_file", to_json(skin->scene_from_file)}};
}

PageJson skeleton_object(const PageSkeleton& skeleton) {
  return {{"name", skeleton.name},
          {"kind", name(skeleton.kind)},
          {"joints", array_of(skeleton.skeleton.joints, joint_object)},
          {"skin", skin_object(skeleton.skin)},
          {"offset_m", to_json(skeleton.offset_m)},
          {"estimate", skeleton.estimate}};
}

PageJson camera_object(const PageCamera& camera) {
  const Intrinsics& k = camera.camera.intrinsics;
  return {{"name", camera.camera.name},
          {"width_px", k.width_px},
          {"height_px", k.height_px},
          {"fx", k.focal_px.x},
          {"fy", k.focal_px.y},
          {"cx", k.centre_px.x},
          {"cy", k.centre_px.y},
          {"world_from_camera", to_json(inverse(camera.camera.camera_from_world))},
          {"rms_px", or_null(camera.rms_px)}};
}

PageJson constraint_object(const PageConstraint& constraint) {
  PageJson object{{"id", constraint.id},
                  {"skeleton", constraint.skeleton},
                  {"kind", name(constraint.kind)},
                  {"active", constraint.active},
                  {"p_in_world", to_json(constraint.p_in_world)},
                  {"draggable", constraint.draggable}};
  if (constraint.joint) object["joint"] = index(*constraint.joint);
  return object;
}

PageJson span_array(const FrameRange& span) {
  return PageJson::array({span.first, span.last});
}

PageJson gap_array(const PageGap& gap) {
  return PageJson::array({gap.span.first, gap.span.last, std::string(name(gap.source))});
}

PageJson track_object(const PageTrack& track) {
  return {{"name", track.name}, {"gaps", array_of(track.gaps, gap_array)}};
}

PageJson contact_object(const PageContact& contact) {
  return {{"name", contact.name}, {"spans", array_of(contact.spans, span_array)}};
}

PageJson graph_object(const PageGraph& graph) {
  return {{"name", graph.name}, {"unit", graph.unit}, {"values", graph.values}};
}

PageJson note_object(const PageNote& note) {
  return {{"frame", note.frame}, {"text", note.text}};
}

PageJson file_object(const std::optional<PageFile>& file) {
  if (!file) return {};
  return {{"frames", file->frames},
          {"first_frame", file->first_frame},
          {"block", file->block},
          {"points_block", or_null(file->points_block)},
          {"tracks", array_of(file->tracks, track_object)},
          {"contacts", array_of(file->contacts, contact_object)},
          {"graphs", array_of(file->graphs, graph_object)},
          {"notes", array_of(file->notes, note_object)},
          {"trial", file->trial},
          {"trials", file->trials},
          {"report", file->report}};
}

const char* mode_of(const PageScene& scene) {
  if (scene.edit) return "edit";
  return scene.file ? "file" : "live";
}

}  // namespace

const char* name(PageConstraintKind kind) {
  switch (kind) {
    case PageConstraintKind::kPosition:
      return "position";
    case PageConstraintKind::kDistance:
      return "distance";
    case PageConstraintKind::kBox:
      return "box";
    case PageConstraintKind::kOrientation:
      return "orientation";
    case PageConstraintKind::kSupport:
      return "support";
  }
  return "position";
}

std::string scene_json(const PageScene& scene) {
  PageJson points;
  if (scene.point_labels) points = {{"labels", *scene.point_labels}};
  PageJson out = {{"type", "scene"},
                  {"version", 1},
                  {"revision", scene.revision},
                  {"title", scene.title},
                  {"mode", mode_of(scene)},
                  {"rate_hz", scene.rate_hz},
                  {"skeletons", array_of(scene.skeletons, skeleton_object)},
                  {"cameras", array_of(scene.cameras, camera_object)},
                  {"points", points},
                  {"floor", {{"height_m", scene.floor_height_m}}},
                  {"constraints", array_of(scene.constraints, constraint_object)},
                  {"file", file_object(scene.file)},
                  {"wizard", scene.wizard ? wizard_object(*scene.wizard) : PageJson()}};
  if (scene.run) out["run"] = true;
  return in_one_line(out);
}

std::string constraints_json(const std::vector<PageConstraint>& constraints) {
  return in_one_line({{"type", "constraints"},
                      {"constraints", array_of(constraints, constraint_object)}});
}

}  // namespace marey::live
