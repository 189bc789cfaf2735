// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/process/draw_frames.h"

#include <algorithm>
#include <map>

#include <glm/common.hpp>

#include "capture/video/frame_picture.h"

namespace marey::app {
namespace {

constexpr int kPictures = 6;

/// Returns a pixel of the frame in the scaled picture. Pixel centres are at integers in
/// both.
glm::dvec2 in_picture(const glm::dvec2& pixel_px, double scale) {
  return (pixel_px + 0.5) * scale - 0.5;
}

std::vector<ReportPicture::Bone> draw_bones(const EstimatedMotion& estimate,
                                            std::size_t pose,
                                            const Camera& camera,
                                            double scale) {
  const Skeleton& skeleton = estimate.motion.skeleton;
  const auto world = world_from_joints(skeleton, estimate.motion.poses[pose]);
  std::vector<ReportPicture::Bone> bones;
  const auto add = [&](const glm::dvec3& from, const glm::dvec3& to, std::size_t joint) {
    const auto a = project(camera, from);
    const auto b = project(camera, to);
    if (!a || !b) return;
    bones.push_back({in_picture(*a, scale),
                     in_picture(*b, scale),
                     estimate.uncertainty[pose][joint].source});
  };
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    const Joint& joint = skeleton.joints[j];
    if (joint.parent) {
      // The source of a bone is that of the joint at its proximal end.
      const std::size_t parent = index(*joint.parent);
      add(world[parent].translation, world[j].translation, parent);
    }
    if (joint.tip_in_joint) add(world[j].translation, world[j] * *joint.tip_in_joint, j);
  }
  return bones;
}

std::vector<ReportPicture::Tag> draw_tags(const CameraDetections& camera,
                                          int frame,
                                          double scale) {
  std::vector<ReportPicture::Tag> tags;
  const int place = frame - camera.frames.front().frame;
  for (const TagDetection& tag : camera.frames[static_cast<std::size_t>(place)].tags) {
    ReportPicture::Tag outline{number(tag.id), {}};
    for (const glm::dvec2& corner : tag.corners_px) {
      outline.corners_px.push_back(in_picture(corner, scale));
    }
    tags.push_back(std::move(outline));
  }
  return tags;
}

/// Returns the number of a frame in the video of the camera; nullopt if the video lacks
/// it.
std::optional<int> in_video(const CameraDetections& camera, int frame) {
  const int place = frame - camera.frames.front().frame;
  if (place < 0 || frame > camera.frames.back().frame) return std::nullopt;
  if (camera.in_recording.empty()) return frame;
  return camera.in_recording[static_cast<std::size_t>(place)];
}

}  // namespace

Result<std::vector<ReportPicture>> draw_frames(
    const recordings::Trial& trial,
    std::span<const Camera> cameras,
    std::span<const CameraDetections> detections,
    const EstimatedMotion& estimate) {
  const int frames = static_cast<int>(estimate.motion.poses.size());
  std::map<std::size_t, std::vector<int>> wanted;  // by position in trial.videos
  for (int i = 0; i < kPictures; ++i) {
    const auto video = static_cast<std::size_t>(i) % trial.videos.size();
    const int frame =
        estimate.motion.first_frame + (2 * i + 1) * frames / (2 * kPictures);
    const CameraDetections& camera = detections[index(trial.videos[video].camera)];
    if (camera.frames.empty() || !in_video(camera, frame)) continue;
    wanted[video].push_back(frame);
  }
  std::vector<ReportPicture> pictures;
  for (const auto& [video, list] : wanted) {
    const auto& source = trial.videos[video];
    std::vector<int> in_file;
    for (const int frame : list) {
      in_file.push_back(*in_video(detections[index(source.camera)], frame));
    }
    auto read = capture::read_pictures(source.path, in_file);
    // The damage was reported by find_tags().
    if (!read && detections[index(source.camera)].damaged_frames > 0) continue;
    if (!read) return read.error();
    const Camera& camera = cameras[index(source.camera)];
    for (std::size_t i = 0; i < read->size(); ++i) {
      capture::FramePicture& picture = (*read)[i];
      picture.frame = list[i];
      ReportPicture out;
      out.camera = camera.name;
      out.frame = picture.frame;
      out.width_px = picture.width_px;
      out.height_px = picture.height_px;
      out.jpeg.assign(reinterpret_cast<const char*>(picture.jpeg.data()),
                      picture.jpeg.size());
      const auto pose =
          static_cast<std::size_t>(picture.frame - estimate.motion.first_frame);
      out.bones = draw_bones(estimate, pose, camera, picture.scale);
      out.tags =
          draw_tags(detections[index(source.camera)], picture.frame, picture.scale);
      pictures.push_back(std::move(out));
    }
  }
  std::sort(pictures.begin(), pictures.end(), [](const auto& a, const auto& b) {
    return a.frame < b.frame;
  });
  return pictures;
}

std::vector<ReportTag> tags_over_time(std::span<const TagOnSegment> tags,
                                      std::span<const CameraDetections> detections,
                                      const Motion& motion) {
  std::vector<ReportTag> rows;
  std::map<TagId, std::size_t> place;
  for (const TagOnSegment& tag : tags) {
    place[tag.id] = rows.size();
    rows.push_back({number(tag.id),
                    std::string(name(tag.segment)),
                    std::vector<int>(motion.poses.size(), 0)});
  }
  for (const CameraDetections& camera : detections) {
    for (const FrameDetections& frame : camera.frames) {
      const auto column = static_cast<std::size_t>(frame.frame - motion.first_frame);
      for (const TagDetection& tag : frame.tags) {
        const auto row = place.find(tag.id);
        if (row != place.end()) ++rows[row->second].cameras_seeing[column];
      }
    }
  }
  return rows;
}

}  // namespace marey::app
