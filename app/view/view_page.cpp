// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/view/view_page.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/extension.h"
#include "live/page/page_frame.h"
#include "recordings/base/atomic_file.h"

namespace marey::app {
namespace {

/// Returns the distance between two bodies side by side with extended arms.
double breadth_m(const Skeleton& skeleton) {
  constexpr double kMinWidth_m = 1.0;
  double low = 0.0;
  double high = 0.0;
  for (const RigidTransform& joint : world_from_joints(skeleton, rest_pose(skeleton))) {
    low = std::min(low, joint.translation.y);
    high = std::max(high, joint.translation.y);
  }
  return std::max(kMinWidth_m, 0.8 * (high - low));
}

/// Returns the mean position of a body on the floor. Bodies of different size move on
/// different paths and must not intersect.
glm::dvec3 middle_of_way(const Motion& motion) {
  glm::dvec3 sum(0.0);
  for (const Pose& pose : motion.poses) sum += pose.root_in_world;
  sum.y = 0.0;
  return sum / std::max(1.0, static_cast<double>(motion.poses.size()));
}

std::vector<glm::dvec3> side_by_side(const std::vector<ViewedFigure>& figures) {
  std::vector<glm::dvec3> offsets_m;
  double x = 0.0;
  for (std::size_t i = 0; i < figures.size(); ++i) {
    const double here = breadth_m(figures[i].motion.skeleton);
    if (i > 0) x += 0.5 * here;
    offsets_m.push_back(glm::dvec3(x, 0.0, 0.0) + middle_of_way(figures[0].motion) -
                        middle_of_way(figures[i].motion));
    x += 0.5 * here;
  }
  return offsets_m;
}

live::WebContent bytes_content(std::string path, std::string bytes) {
  return {std::move(path),
          "application/octet-stream",
          std::make_shared<const std::string>(std::move(bytes)),
          false,
          {}};
}

live::PageFigure figure_at(const ViewedFigure& figure, std::size_t frame) {
  live::PageFigure out;
  out.joints = figure.motion.skeleton.joints.size();
  if (frame < figure.motion.poses.size()) out.pose = &figure.motion.poses[frame];
  if (frame < figure.uncertainty.size()) out.uncertainty = figure.uncertainty[frame];
  if (frame < figure.balance.size()) {
    const retarget::BalanceFrame& balance = figure.balance[frame];
    out.balance = live::PageBalance{
        balance.centre_of_mass_in_world, balance.support_xz_m, balance.zmp_xz_m};
  }
  return out;
}

void append_frame(const ViewedRecording& recording,
                  std::uint32_t i,
                  std::span<const live::PageFigure> figures,
                  std::string& out) {
  live::append_frame(
      {.frame = i + static_cast<std::uint32_t>(std::max(0, recording.first_frame)),
       // Signed sum, because markers may start before frame 0.
       .time_s = (recording.first_frame + static_cast<int>(i)) / recording.rate.hz,
       .sent_s = 0.0,
       .figures = figures},
      out);
}

std::string motion_block(const ViewedRecording& recording) {
  std::string out;
  const auto frames = static_cast<std::uint32_t>(recording.frames);
  live::append_motion_block_head(
      frames, static_cast<std::uint32_t>(recording.figures.size()), out);
  std::vector<live::PageFigure> figures;
  for (std::uint32_t i = 0; i < frames; ++i) {
    figures.clear();
    for (const ViewedFigure& figure : recording.figures) {
      figures.push_back(figure_at(figure, i));
    }
    append_frame(recording, i, figures, out);
  }
  return out;
}

live::PageFile page_file(const ViewedRecording& recording) {
  live::PageFile file;
  file.frames = recording.frames;
  file.first_frame = recording.first_frame;
  file.tracks = recording.tracks;
  file.contacts = recording.contacts;
  file.graphs = recording.graphs;
  file.notes = recording.notes;
  return file;
}

}  // namespace

std::string frame_with(const ViewedRecording& recording,
                       int frame,
                       std::size_t figure,
                       const Pose& pose) {
  std::vector<live::PageFigure> figures;
  for (const ViewedFigure& one : recording.figures) {
    figures.push_back(figure_at(one, static_cast<std::size_t>(frame)));
  }
  figures[figure].pose = &pose;
  figures[figure].balance.reset();  // It belongs to the recorded pose.
  std::string out;
  append_frame(recording, static_cast<std::uint32_t>(frame), figures, out);
  return out;
}

live::PageSkeleton page_skeleton(const ViewedFigure& figure,
                                 const std::string& media,
                                 const glm::dvec3& offset_m) {
  live::PageSkeleton out;
  out.name = figure.name;
  out.kind = figure.kind;
  out.skeleton = figure.motion.skeleton;
  out.offset_m = offset_m;
  out.estimate = !figure.uncertainty.empty();
  if (!figure.skin) return out;
  live::PageSkin skin;
  skin.media = media;
  skin.format = kind_by_extension(figure.skin->file).substr(1);
  for (const Joint& joint : out.skeleton.joints) skin.nodes.push_back(joint.name);
  skin.node_index = figure.skin->node_of_joint;
  skin.unit_from_m = figure.skin->unit_from_m;
  skin.scene_from_file = figure.skin->marey_from_file;
  out.skin = std::move(skin);
  return out;
}

Result<live::WebContent> file_content(const std::filesystem::path& file,
                                      std::string path,
                                      std::string content_type) {
  auto bytes = recordings::read_file(file);
  if (!bytes) return bytes.error();
  return live::WebContent{std::move(path),
                          std::move(content_type),
                          std::make_shared<const std::string>(*std::move(bytes)),
                          false,
                          {}};
}

Result<PageOfRecording> page_of_recording(const ViewedRecording& recording,
                                          std::size_t first_media) {
  PageOfRecording out;
  const auto next_path = [&out, first_media] {
    return "/media/" + std::to_string(out.media.size() + first_media);
  };
  live::PageScene& scene = out.scene;
  scene.title = recording.title;
  scene.rate_hz = recording.rate.hz;
  scene.cameras = recording.cameras;
  scene.file = page_file(recording);
  const std::vector<glm::dvec3> offsets_m = side_by_side(recording.figures);
  for (std::size_t i = 0; i < recording.figures.size(); ++i) {
    const ViewedFigure& figure = recording.figures[i];
    const std::string path = next_path();
    if (figure.skin) {
      auto skin = file_content(figure.skin->file, path, "model/gltf-binary");
      if (!skin) return skin.error();
      out.media.push_back(*std::move(skin));
    }
    scene.skeletons.push_back(page_skeleton(figure, path, offsets_m[i]));
  }
  scene.file->block = next_path();
  out.media.push_back(bytes_content(scene.file->block, motion_block(recording)));
  if (recording.points) {
    scene.point_labels = recording.points->labels;
    scene.file->points_block = next_path();
    std::string points;
    live::append_point_block(*recording.points, points);
    out.media.push_back(bytes_content(*scene.file->points_block, std::move(points)));
  }
  return out;
}

}  // namespace marey::app
