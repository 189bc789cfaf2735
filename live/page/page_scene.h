// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/base/frame_range.h"
#include "core/camera.h"
#include "core/skeleton.h"
#include "core/source.h"
#include "live/page/page_wizard.h"

namespace marey::live {

/// Skin of a skeleton: a glTF file that the page fetches, and its nodes per joint.
struct PageSkin {
  std::string media{};   ///< Path at which it is served: "/media/1".
  std::string format{};  ///< "glb" or "vrm".
  /// One entry per joint: the node's name, and its index in the file.
  std::vector<std::string> nodes{};
  std::vector<int> node_index{};
  double unit_from_m = 1.0;  ///< File units per metre.
  /// Rotation of the whole file into the scene's axes.
  glm::dquat scene_from_file{1.0, 0.0, 0.0, 0.0};
};

enum class PageSkeletonKind { kPerformer, kAvatar, kMotion };

struct PageSkeleton {
  std::string name{};
  PageSkeletonKind kind = PageSkeletonKind::kMotion;
  Skeleton skeleton{};
  std::optional<PageSkin> skin{};
  glm::dvec3 offset_m{0.0};  ///< Displacement at which it is drawn next to the others.
  bool estimate = false;     ///< Frames contain the uncertainty of its joints.
};

struct PageCamera {
  Camera camera{};
  std::optional<double> rms_px{};
};

enum class PageConstraintKind { kPosition, kDistance, kBox, kOrientation, kSupport };

/// Returns the word in messages: "position".
[[nodiscard]] const char* name(PageConstraintKind kind);

struct PageConstraint {
  std::string id{};
  std::size_t skeleton = 0;  ///< Index of the scene's skeleton.
  PageConstraintKind kind = PageConstraintKind::kPosition;
  bool active = true;
  glm::dvec3 p_in_world{0.0};
  bool draggable = false;
  /// Joint of its skeleton that the constraint follows frame by frame; p_in_world is then
  /// unused.
  std::optional<JointIndex> joint{};
};

struct PageGap {
  FrameRange span;
  Source source = Source::kInferred;
};

/// Frames in which a segment or a marker was not seen.
struct PageTrack {
  std::string name{};
  std::vector<PageGap> gaps{};
};

struct PageContact {
  std::string name{};
  std::vector<FrameRange> spans{};
};

/// A curve over all frames. Non-finite values are gaps.
struct PageGraph {
  std::string name{};
  std::string unit{};
  std::vector<double> values{};
};

struct PageNote {
  int frame = 0;
  std::string text{};
};

/// A complete recording. Spans and notes count frames from first_frame on.
struct PageFile {
  int frames = 0;
  int first_frame = 0;
  std::string block{};  ///< Media of live/page/page_frame.h's MotionBlock.
  std::optional<std::string> points_block{};  ///< Media of a PointBlock.
  std::vector<PageTrack> tracks{};
  std::vector<PageContact> contacts{};
  std::vector<PageGraph> graphs{};
  std::vector<PageNote> notes{};
  std::string trial{};                ///< Name of the trial, in `trials`; may be empty.
  std::vector<std::string> trials{};  ///< Trials that a page may request (TrialRequest).
  std::string report{};               ///< Path of the trial's report; empty: none.
};

/// Everything that does not change from frame to frame. A scene with `file` is a
/// recording; one without is live, or the page of marey edit.
struct PageScene {
  bool edit = false;  ///< The page of marey edit (docs/formats/edit_page.md).
  /// A scene that runs live (live/page/page_run.h); its constraints are the targets.
  bool run = false;
  int revision = 1;   ///< Incremented whenever another member changes.
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

/// Returns the scene message (docs/formats/page.md): JSON in one line, the same for the
/// same scene. Invalid UTF-8 in names is replaced.
/// Precondition: all numbers except those of graphs are finite.
[[nodiscard]] std::string scene_json(const PageScene& scene);

/// Returns the message that replaces a scene's constraints.
[[nodiscard]] std::string constraints_json(
    const std::vector<PageConstraint>& constraints);

}  // namespace marey::live
