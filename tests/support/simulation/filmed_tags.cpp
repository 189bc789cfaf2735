// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/simulation/filmed_tags.h"

#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include <glm/geometric.hpp>

#include "tests/support/simulation/synthetic_rig.h"

namespace marey::testing {
namespace {

using ThingAt = std::function<RigidTransform(double)>;

RigidTransform board_from_tag(const AprilGrid& board, int tag) {
  const TagId id{tag};
  const glm::dvec3 centre =
      0.5 * (*board.corner_in_board(id, 0) + *board.corner_in_board(id, 2));
  return {rotation_from_vector({std::numbers::pi, 0.0, 0.0}), centre};
}

double side_of(const TagDetection& tag) {
  double sum = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    sum += glm::distance(tag.corners_px[i], tag.corners_px[(i + 1) % 4]);
  }
  return 0.25 * sum;
}

/// Projects a tag into a camera, each row at its own time.
std::optional<TagDetection> see(const SimulationDraw& draw,
                                const Camera& camera,
                                const FilmedTag& tag,
                                double time_s,
                                const ThingAt& thing_at) {
  auto seen = see_tag(camera, thing_at(time_s) * tag.thing_from_tag, tag.id, tag.size_m);
  if (!seen) return std::nullopt;
  const double middle = 0.5 * (camera.intrinsics.height_px - 1);
  for (int round = 0; round < 3 && draw.line_delay_s > 0.0; ++round) {
    for (std::size_t i = 0; i < 4; ++i) {
      const double row_s = time_s + draw.line_delay_s * (seen->corners_px[i].y - middle);
      const auto pixel = project(camera,
                                 thing_at(row_s) * tag.thing_from_tag *
                                     corner_in_tag(static_cast<int>(i), tag.size_m));
      if (!pixel) return std::nullopt;
      seen->corners_px[i] = *pixel;
    }
  }
  return seen;
}

/// The smooth part of an error that a lens model does not have.
glm::dvec2 field_px(const Camera& camera, const glm::dvec2& pixel_px) {
  const double u = 2.0 * std::numbers::pi * pixel_px.x / camera.intrinsics.width_px;
  const double v = 2.0 * std::numbers::pi * pixel_px.y / camera.intrinsics.height_px;
  const double phase = 40.0 * camera.intrinsics.distortion[0];
  return 0.02 * glm::dvec2(std::sin(u + 2.0 * v + phase), std::cos(2.0 * u - v + phase));
}

/// As a detector finds it; nullopt of a tag that it misses.
std::optional<TagDetection> found(SimulationDraw& draw,
                                  const Camera& camera,
                                  std::size_t c,
                                  const TagDetection& seen) {
  Dice& dice = draw.dice;
  const double side_px = side_of(seen);
  const bool is_missed =
      dice.between(0.0, 1.0) < 0.03 || side_px < dice.between(9.0, 14.0);
  const double sigma_px = 0.39 / std::sqrt(side_px);
  Disturbance law;
  law.noise_px = sigma_px;
  law.shrinkage = camera.tag_shrinkage;
  law.declared_px = sigma_px * dice.between(0.9, 1.2);
  TagDetection out = disturbed(seen, law, dice);
  for (glm::dvec2& corner : out.corners_px) corner += field_px(camera, corner);
  const bool strays = draw.out.fault == RigFault::kStrayTags && draw.out.camera == c;
  if (dice.between(0.0, 1.0) < (strays ? 1.0 / 12.0 : 1.0 / 200.0)) {
    const double angle_rad = dice.between(0.0, 2.0 * std::numbers::pi);
    const glm::dvec2 wrong =
        dice.between(5.0, 30.0) * glm::dvec2(std::cos(angle_rad), std::sin(angle_rad));
    for (glm::dvec2& corner : out.corners_px) corner += wrong;
  }
  if (draw.out.fault == RigFault::kMirrored && draw.out.camera == c) {
    for (glm::dvec2& corner : out.corners_px) {
      corner.x = camera.intrinsics.width_px - 1 - corner.x;
    }
  }
  if (draw.out.fault == RigFault::kFlipped && draw.out.camera == c) {
    const glm::dvec2 far(camera.intrinsics.width_px - 1, camera.intrinsics.height_px - 1);
    for (glm::dvec2& corner : out.corners_px) corner = far - corner;
  }
  if (is_missed) return std::nullopt;
  return out;
}

/// Returns whether the camera looks away in a frame.
bool looks_away(const SimulationDraw& draw, std::size_t c, Reel reel, int frame) {
  constexpr int kFewFrames = 6;
  const SimulatedCalibration& out = draw.out;
  return out.fault == RigFault::kRarelySeen && out.camera == c && reel == Reel::kWaved &&
         (frame < out.from_frame || frame >= out.from_frame + kFewFrames);
}

/// Returns thing_from_tag of a tag at a place that faces a direction.
RigidTransform facing(const glm::dvec3& place, double heading_rad, double rise_rad) {
  // A tag's z goes into its face (see_tag): its own faces look along -z.
  return {rotation_from_vector({0.0, heading_rad, 0.0}) *
              rotation_from_vector({-rise_rad, 0.0, 0.0}) *
              rotation_from_vector({std::numbers::pi, 0.0, 0.0}),
          place};
}

}  // namespace

Camera camera_in(const SimulationDraw& draw, std::size_t c, Reel reel, int frame) {
  const SimulatedCalibration& out = draw.out;
  Camera camera = out.truth[c];
  if (out.camera != c) return camera;
  const bool is_later = reel != Reel::kWaved || frame >= out.from_frame;
  if (out.fault == RigFault::kNudged && is_later) return draw.moved;
  if (out.fault == RigFault::kNudgedAfter && reel == Reel::kMotion) return draw.moved;
  if (out.fault == RigFault::kRefocused && is_later) {
    camera.intrinsics.focal_px *= 1.0 + out.focal_share;
  } else if (out.fault == RigFault::kFocalDrift) {
    const double share =
        reel == Reel::kWaved ? static_cast<double>(frame) / draw.frames : 1.0;
    camera.intrinsics.focal_px *= 1.0 + share * out.focal_share;
  }
  return camera;
}

void film(SimulationDraw& draw,
          const std::vector<FilmedTag>& tags,
          const ThingAt& thing_at,
          Reel reel,
          std::vector<CameraDetections>& out) {
  for (std::size_t c = 0; c < out.size(); ++c) {
    for (FrameDetections& frame : out[c].frames) {
      if (looks_away(draw, c, reel, frame.frame)) continue;
      const Camera camera = camera_in(draw, c, reel, frame.frame);
      const double time_s =
          frame.frame / draw.out.rate_hz +
          (reel == Reel::kMotion ? 0.0 : draw.out.late_s[c]);  // Motions start together.
      for (const FilmedTag& tag : tags) {
        const auto seen = see(draw, camera, tag, time_s, thing_at);
        if (!seen) continue;
        if (const auto tag_found = found(draw, camera, c, *seen)) {
          frame.tags.push_back(*tag_found);
        }
      }
    }
  }
}

std::vector<FilmedTag> tags_of(const AprilGrid& board) {
  std::vector<FilmedTag> out;
  for (int tag = 0; tag < board.tag_count(); ++tag) {
    out.push_back({TagId{tag}, board.tag_size_m, board_from_tag(board, tag)});
  }
  return out;
}

std::vector<FilmedTag> wand_tags(double size_m) {
  std::vector<FilmedTag> out;
  const double half_m = 0.6 * size_m;
  for (int i = 0; i < 6; ++i) {
    const double heading_rad = i < 4 ? 0.5 * std::numbers::pi * i : 0.0;
    const double rise_rad =
        i < 4 ? 0.0 : (i == 4 ? 0.5 * std::numbers::pi : -0.5 * std::numbers::pi);
    const glm::dvec3 way(std::cos(rise_rad) * std::sin(heading_rad),
                         std::sin(rise_rad),
                         std::cos(rise_rad) * std::cos(heading_rad));
    out.push_back({TagId{i}, size_m, facing(half_m * way, heading_rad, rise_rad)});
  }
  return out;
}

std::vector<FilmedTag> worn_tags(Dice& dice, double factor) {
  constexpr int kAround = 6;
  std::vector<FilmedTag> out;
  for (int row = 0; row < 3; ++row) {
    for (int i = 0; i < kAround; ++i) {
      const double heading_rad =
          2.0 * std::numbers::pi * i / kAround + dice.between(-0.3, 0.3);
      const double away_m = dice.between(0.1, 0.25);
      const glm::dvec3 place(away_m * std::sin(heading_rad),
                             0.35 + 0.5 * row + dice.between(-0.15, 0.15),
                             away_m * std::cos(heading_rad));
      out.push_back({TagId{100 + kAround * row + i},
                     dice.between(0.06, 0.09) * factor,
                     facing(place, heading_rad, dice.between(-0.3, 0.3))});
    }
  }
  return out;
}

}  // namespace marey::testing
