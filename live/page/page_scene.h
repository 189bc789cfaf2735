// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/camera.h"
#include "core/provenance.h"
#include "core/skeleton.h"
#include "live/page/page_wizard.h"

namespace marey::live {

/// How a skeleton's joints move the nodes of a glTF file that the page fetches.
struct PageSkin {
  std::string media{};   ///< Where it is served: "/media/1".
  std::string format{};  ///< "glb" or "vrm".
  /// One for each joint: the node's name, and its place in the file's list.
  std::vector<std::string> nodes{};
  std::vector<int> node_index{};
  double unit_from_m = 1.0;  ///< The file's unit in a metre.
  /// How the whole file is turned to stand as the scene does.
  glm::dquat scene_from_file{1.0, 0.0, 0.0, 0.0};
};

enum class PageSkeletonKind { kPerformer, kAvatar, kMotion };

struct PageSkeleton {
  std::string name{};
  PageSkeletonKind kind = PageSkeletonKind::kMotion;
  Skeleton skeleton{};
  std::optional<PageSkin> skin{};
  glm::dvec3 offset_m{0.0};  ///< Where it is drawn, beside the others.
  bool estimate = false;     ///< Frames say how well its joints are known.
};

struct PageCamera {
  Camera camera{};
  std::optional<double> rms_px{};
};

enum class PageConstraintKind { kPosition, kDistance, kBox, kOrientation, kSupport };

struct PageConstraint {
  std::string id{};
  std::size_t skeleton = 0;  ///< Which of the scene's.
  PageConstraintKind kind = PageConstraintKind::kPosition;
  bool active = true;
  glm::dvec3 p_in_world{0.0};
  bool draggable = false;
  /// It is where this joint of its skeleton is, frame by frame, and p_in_world is void.
  std::optional<JointIndex> joint{};
};

/// Frames from first to last, both included.
struct PageSpan {
  int first = 0;
  int last = 0;
};

struct PageGap {
  PageSpan span;
  Source source = Source::kInferred;
};

/// When a segment or a marker was not seen.
struct PageTrack {
  std::string name{};
  std::vector<PageGap> gaps{};
};

struct PageContact {
  std::string name{};
  std::vector<PageSpan> spans{};
};

/// A curve over all frames. Values that are not finite are gaps in it.
struct PageGraph {
  std::string name{};
  std::string unit{};
  std::vector<double> values{};
};

struct PageNote {
  int frame = 0;
  std::string text{};
};

/// A recording that is all there. Spans and notes count frames from first_frame on.
struct PageFile {
  int frames = 0;
  int first_frame = 0;
  std::string block{};  ///< Media of live/page/page_frame.h's MotionBlock.
  std::optional<std::string> points_block{};  ///< Media of a PointBlock.
  std::vector<PageTrack> tracks{};
  std::vector<PageContact> contacts{};
  std::vector<PageGraph> graphs{};
  std::vector<PageNote> notes{};
  std::string trial{};                ///< Which of `trials` it is; may be empty.
  std::vector<std::string> trials{};  ///< That a page may ask for (TrialRequest).
  std::string report{};               ///< Where the report of it is served; empty: nowhere.
};

/// Everything that does not change from frame to frame. With `file` it is a recording,
/// without it is live.
struct PageScene {
  int revision = 1;  ///< Counts up whenever anything else here changes.
  std::string title{};
  double rate_hz = 30.0;
  std::vector<PageSkeleton> skeletons{};
  std::vector<PageCamera> cameras{};
  std::optional<std::vector<std::string>> point_labels{};
  double floor_height_m = 0.0;
  std::vector<PageConstraint> constraints{};
  std::optional<PageFile> file{};
  std::optional<PageWizard> wizard{};
};

/// The scene as the page reads it (docs/formats/page.md): JSON in one line, the
/// same for the same scene. Names that are not UTF-8 have their broken bytes replaced.
/// Precondition: all numbers finite but those of graphs.
[[nodiscard]] std::string scene_json(const PageScene& scene);

/// The message that replaces a scene's constraints.
[[nodiscard]] std::string constraints_json(
    const std::vector<PageConstraint>& constraints);

}  // namespace marey::live
